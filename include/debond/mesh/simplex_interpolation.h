// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_simplex_interpolation_h
#define debond_mesh_simplex_interpolation_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/grid/tria.h>

#include <vector>

namespace Debond
{
  /// The P1 field with @p values at the vertices of any mesh of simplices, at
  /// @p points. Points beside the mesh, as on the curved side of a finer one,
  /// belong to a cell next to them.
  template <int dim>
  std::vector<dealii::Tensor<1, dim>>
  interpolate_on_simplices(const dealii::Triangulation<dim>          &mesh,
                           const std::vector<dealii::Tensor<1, dim>> &values,
                           const std::vector<dealii::Point<dim>>     &points);
} // namespace Debond

#endif
