// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_meshes_first_scene_h
#define debond_solve_meshes_first_scene_h

#include <debond/input/accuracy_parameters.h>
#include <debond/solve/scene/scene.h>

namespace Debond
{
  /// The scene on the first mesh, which can be refined if @p accuracy asks for
  /// it, with @p start as of Scene, or after the @p divisions of an earlier
  /// run. Throws as Scene does, and BadInput if the mesh cannot be refined or
  /// is not that of the divisions.
  template <int dim>
  std::shared_ptr<const Scene<dim>>
  make_first_scene(
    const ProblemParameters                      &problem,
    const AccuracyParameters                     &accuracy,
    const std::string                            &start     = "",
    const std::vector<std::vector<unsigned int>> &divisions = {});
} // namespace Debond

#endif
