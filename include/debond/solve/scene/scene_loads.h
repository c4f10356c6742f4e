// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_scene_scene_loads_h
#define debond_solve_scene_scene_loads_h

#include <debond/elasticity/load_vector.h>
#include <debond/input/load_parameters.h>

namespace Debond
{
  /// The dead loads or the others of a scene, on the faces of a mesh whose
  /// boundaries have these names. A total force is spread over those that the
  /// mesh has.
  template <int dim>
  Loads<dim>
  make_loads(const LoadParameters             &parameters,
             const std::set<std::string>      &dead_loads,
             const bool                        wants_dead,
             const Symmetry                    symmetry,
             const BoundaryNames              &boundaries,
             const dealii::Triangulation<dim> &mesh);
} // namespace Debond

#endif
