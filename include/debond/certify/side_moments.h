// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_side_moments_h
#define debond_certify_side_moments_h

#include <debond/elasticity/unknowns.h>

namespace Debond
{
  /// Barycentric coordinates of a side with weights, whose sum is 1.
  template <int dim>
  using SideRule = std::vector<std::pair<std::array<double, dim>, double>>;

  /// A traction on a side, as far as linear displacements see it.
  template <int dim>
  struct SideTraction
  {
    /// The linear one with the same moments, in the order of the corners.
    std::array<dealii::Tensor<1, dim>, dim> at_corners;

    /// The mean square of what is not linear, 0 if that is rounding.
    double rest;
  };

  /// @p traction: force per area (per length in 2D) at a point, integrated as
  /// load_vector() does it; @p corners: of the side.
  template <int dim>
  SideTraction<dim>
  side_traction(
    const std::function<dealii::Tensor<1, dim>(const dealii::Point<dim> &)>
                                              &traction,
    const std::array<dealii::Point<dim>, dim> &corners);

  /// A displacement on a side of a cell.
  template <int dim>
  class SideDisplacement
  {
  public:
    /// @p displacement: the Cartesian values at the nodes of @p unknowns;
    /// @p vertices: of the side, in the order of the barycentric coordinates.
    SideDisplacement(
      const ElasticUnknowns<dim>                               &unknowns,
      const DofVector                                          &displacement,
      const typename dealii::Triangulation<dim>::cell_iterator &cell,
      const std::array<unsigned int, dim>                      &vertices);

    dealii::Tensor<1, dim>
    operator()(const std::array<double, dim> &barycentric) const;

  private:
    const dealii::FiniteElement<dim>   &fe;
    dealii::Vector<double>              values;  ///< of the cell's nodes
    std::array<dealii::Point<dim>, dim> corners; ///< on the reference cell
  };



  /// The rule that integrates over a side exactly up to degree 5.
  template <int dim>
  const SideRule<dim> &
  side_rule();

  /// The means of a displacement with the weights dim lambda_k, lambda the
  /// barycentric coordinates of the side.
  template <int dim>
  std::array<dealii::Tensor<1, dim>, dim>
  side_unknowns(const SideDisplacement<dim> &u);
} // namespace Debond

#endif
