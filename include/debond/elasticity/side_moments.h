// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_side_moments_h
#define debond_elasticity_side_moments_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <debond/elasticity/cell_displacement.h>

#include <array>
#include <functional>

namespace Debond
{
  /// A traction on a side, as far as linear displacements see it.
  template <int dim>
  struct SideTraction
  {
    /// The work-conjugates of the side's unknowns relative to its length or
    /// area, vector by vector, see EquilibriumElement.
    std::array<dealii::Tensor<1, dim>, dim> conjugates;

    /// The mean square of what is not linear, 0 if that is rounding.
    double rest;
  };

  /// @p traction: force per area (per length in 2D) at a point, integrated as
  /// load_vector() does it; @p corners: of the side, in the order of its
  /// unknowns.
  template <int dim>
  SideTraction<dim>
  side_traction(
    const std::function<dealii::Tensor<1, dim>(const dealii::Point<dim> &)>
                                              &traction,
    const std::array<dealii::Point<dim>, dim> &corners);

  /// The unknowns of a side of a displacement, vector by vector, see
  /// EquilibriumElement.
  std::array<dealii::Tensor<1, 2>, 2>
  side_unknowns(const CellDisplacement<2>::OnSide &u);

  std::array<dealii::Tensor<1, 3>, 3>
  side_unknowns(const CellDisplacement<3>::OnSide &u);
} // namespace Debond

#endif
