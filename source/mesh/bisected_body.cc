// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/mesh/bisected_body.h>

namespace Debond
{
  template <int dim>
  BisectedBody<dim>::BisectedBody(const std::shared_ptr<const Body<dim>> &whole)
    : whole(whole)
    , bisection(bisection_of(*whole, names))
  {}



  template <int dim>
  BisectedBody<dim>::BisectedBody(const BisectedBody              &coarse,
                                  const std::vector<unsigned int> &times)
    : whole(coarse.whole)
    , names(coarse.names)
    , bisection(coarse.bisection)
  {
    bisection.refine(times);
  }



  template <int dim>
  Bisection<dim>
  BisectedBody<dim>::bisection_of(const Body<dim> &whole, PieceNames &names)
  {
    dealii::Triangulation<dim> mesh;
    names = whole.make_mesh(mesh);
    return Bisection<dim>(mesh);
  }



  DEBOND_INSTANTIATE_CLASS(BisectedBody);
} // namespace Debond
