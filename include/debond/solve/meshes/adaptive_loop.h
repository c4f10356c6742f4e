// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_meshes_adaptive_loop_h
#define debond_solve_meshes_adaptive_loop_h

#include <debond/solve/meshes/mesh_growth.h>
#include <debond/solve/meshes/refinement_goal.h>
#include <debond/solve/path/load_path.h>

namespace Debond
{
  /// How far the loop has come.
  struct AdaptiveProgress
  {
    /// The meshes that are done.
    std::vector<AdaptiveLevel> levels;

    /// How often the cells of each mesh are cut for the next one, see
    /// BisectedBody::refined().
    std::vector<std::vector<unsigned int>> divisions;

    /// The start on the last of these meshes; empty for rest.
    DofVector start;
  };

  /// Who is told what the loop does.
  template <int dim>
  struct AdaptiveObserver
  {
    /// The levels are numbered from 0.
    std::function<void(const unsigned int, const AdaptiveLevel &)>
      level_is_done;

    /// The scene on the next mesh, before it is solved.
    std::function<void(const AdaptiveProgress &, const Scene<dim> &)>
      next_mesh_is_made;

    /// Called at each step of a load path, on any of the meshes.
    LoadPathObserver<dim> step_is_done;
  };



  template <int dim>
  struct AdaptiveResult
  {
    /// The scene on the last mesh on which there is a result.
    std::shared_ptr<const Scene<dim>> scene;

    MethodChoice choice; ///< on the last mesh

    FollowedPath<dim>          path; ///< without steps if the scene has none
    std::vector<AdaptiveLevel> levels;

    /// The reason why the loop has not reached its target; empty if it has.
    std::string shortfall;
  };

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

  /// Solves the scene of make_first_scene(), and again and again on a mesh that
  /// is refined where the estimate is large, or what @p goal says, from the
  /// state before; with the search that the scene wants on each, and the linear
  /// solver that is best for each. It ends with the target of @p accuracy and
  /// the goal, if there are any. A load path is
  /// followed on each mesh, without its global branch and its arc, for the
  /// estimate of the factor that has the largest one relative to its J; the
  /// result is that of the last factor. @p begun is what an earlier run had
  /// done before @p scene, of which the observer is told again.
  template <int dim>
  AdaptiveResult<dim>
  solve_adaptively(const SolveSettings              &settings,
                   const AccuracyParameters         &accuracy,
                   RefinementGoal<dim>              *goal,
                   const AdaptiveProgress           &begun,
                   const AdaptiveObserver<dim>      &observer,
                   std::shared_ptr<const Scene<dim>> scene);
} // namespace Debond

#endif
