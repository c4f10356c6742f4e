// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/mesh/body_piece.h>

namespace Debond
{
  template <int dim>
  BodyPiece<dim>::BodyPiece(const std::shared_ptr<const Body<dim>> &whole,
                            const unsigned int                      n_slabs,
                            const unsigned int                      rank,
                            const unsigned int                      n_ranks)
    : n_ranks(n_ranks)
    , first(static_cast<unsigned int>(std::size_t(n_slabs) * rank / n_ranks))
    , end(
        static_cast<unsigned int>(std::size_t(n_slabs) * (rank + 1) / n_ranks))
    , whole(whole)
    , n_of_slabs(n_slabs)
  {}



  template <int dim>
  std::set<std::string>
  BodyPiece<dim>::whole_boundaries() const
  {
    return whole->boundaries();
  }



  template <int dim>
  std::set<std::string>
  BodyPiece<dim>::whole_regions() const
  {
    return whole->regions();
  }



  template <int dim>
  double
  BodyPiece<dim>::n_cells() const
  {
    return whole->n_cells();
  }



  template <int dim>
  double
  BodyPiece<dim>::n_vertices() const
  {
    return whole->n_vertices();
  }



  template <int dim>
  BodyShape
  BodyPiece<dim>::shape() const
  {
    return whole->shape();
  }



  template <int dim>
  bool
  BodyPiece<dim>::has_coarse_levels() const
  {
    return whole->has_coarse_levels();
  }



  template <int dim>
  std::unique_ptr<Body<dim>>
  BodyPiece<dim>::coarser_whole() const
  {
    return whole->coarser();
  }



  template <int dim>
  std::vector<dealii::Tensor<1, dim>>
  BodyPiece<dim>::interpolate(
    const dealii::Triangulation<dim>          &mesh,
    const std::vector<dealii::Tensor<1, dim>> &values,
    const std::vector<dealii::Point<dim>>     &points) const
  {
    return whole->interpolate(mesh, values, points);
  }



  template <int dim>
  unsigned int
  BodyPiece<dim>::n_slabs() const
  {
    return n_of_slabs;
  }



  template <int dim>
  bool
  BodyPiece<dim>::owns_slab(const unsigned int slab) const
  {
    return first <= slab && slab < end;
  }



  template class BodyPiece<2>;
  template class BodyPiece<3>;
} // namespace Debond
