// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_side_moments_h
#define debond_elasticity_side_moments_h

#include <deal.II/base/function.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <debond/contact/field_value.h>
#include <debond/elasticity/cell_displacement.h>

#include <array>

namespace Debond
{
  /// A field with dim components. Throws std::invalid_argument with the place
  /// if it is not finite there.
  template <int dim>
  dealii::Tensor<1, dim>
  field_vector(const dealii::Function<dim> &field,
               const dealii::Point<dim>    &point)
  {
    dealii::Tensor<1, dim> result;
    for (unsigned int d = 0; d < dim; ++d)
      result[d] = field_value(field, point, d);
    return result;
  }



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

  /// @p traction: force per area (per length in 2D); @p corners: of the side,
  /// in the order of its unknowns; @p n_faces: on its boundary.
  template <int dim>
  SideTraction<dim>
  side_traction(const dealii::Function<dim>               &traction,
                const std::array<dealii::Point<dim>, dim> &corners,
                const unsigned int                         n_faces);

  /// The unknowns of a side of a displacement, vector by vector, see
  /// EquilibriumElement.
  std::array<dealii::Tensor<1, 2>, 2>
  side_unknowns(const CellDisplacement<2>::OnSide &u);

  std::array<dealii::Tensor<1, 3>, 3>
  side_unknowns(const CellDisplacement<3>::OnSide &u);
} // namespace Debond

#endif
