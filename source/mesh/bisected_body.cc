// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/mesh/bisected_body.h>

namespace Debond
{
  template <int dim>
  BisectedBody<dim>::BisectedBody(const std::shared_ptr<const Body<dim>> &whole)
    : whole(whole)
    // The order of the members matters: `names` is declared before `bisection`,
    // whose initialiser fills it.
    , bisection(bisection_of(*whole, names))
  {}



  template <int dim>
  BisectedBody<dim>::BisectedBody(const BisectedBody              &coarse,
                                  const std::vector<unsigned int> &times)
    : whole(coarse.whole)
    , names(coarse.names)
    , bisection(coarse.bisection)
  {
    // The orders and tags of the simplices are copied with the bisection. A
    // triangulation of the refined mesh would not have them.
    bisection.refine(times);
  }



  template <int dim>
  Bisection<dim>
  BisectedBody<dim>::bisection_of(const Body<dim> &whole, PieceNames &names)
  {
    // The triangulation is needed only as long as vertices, cells and ids are
    // read from it.
    dealii::Triangulation<dim> mesh;
    names = whole.make_mesh(mesh);
    return Bisection<dim>(mesh);
  }



  DEBOND_INSTANTIATE_CLASS(BisectedBody);
} // namespace Debond
