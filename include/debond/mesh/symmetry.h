// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_symmetry_h
#define debond_mesh_symmetry_h

#include <deal.II/base/numbers.h>
#include <deal.II/base/point.h>

namespace Debond
{
  /// What the mesh of a plane body stands for.
  enum class Symmetry
  {
    none, ///< itself
    axis  ///< half of a section of a body of revolution, x being the radius
  };



  /// The factor of lengths and areas of the mesh at a point in integrals: the
  /// way 2 pi r around the axis that the point stands for, so that all
  /// measures, forces and energies are those of the whole circle.
  template <int dim>
  double
  circumference(const Symmetry symmetry, const dealii::Point<dim> &point)
  {
    return symmetry == Symmetry::axis ? 2. * dealii::numbers::PI * point[0] :
                                        1.;
  }
} // namespace Debond

#endif
