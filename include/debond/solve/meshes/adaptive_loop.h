// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_meshes_adaptive_loop_h
#define debond_solve_meshes_adaptive_loop_h

#include <debond/solve/meshes/refinement_goal.h>
#include <debond/solve/path/load_path.h>

namespace Debond
{
  /// Who is told what the loop does.
  template <int dim>
  struct AdaptiveObserver
  {
    /// The levels are numbered from 0.
    std::function<void(const unsigned int, const AdaptiveLevel &)>
      level_is_done;

    /// The scene on the next mesh and where to start, before it is solved.
    std::function<void(const Answer<dim> &)> next_mesh_is_made;

    /// Called at each step of a load path, on any of the meshes.
    LoadPathObserver<dim> step_is_done;
  };



  /// Solves the scene of make_first_scene(), which @p begun has, and again and
  /// again on a mesh that is refined where the estimate is large, or what @p
  /// goal says, from the state before; with the search that the scene wants on
  /// each, and the linear solver that is best for each. It ends with the target
  /// of @p accuracy and the goal, if there are any. A load path is followed on
  /// each mesh, without its global branch and its arc, for the estimate of the
  /// factor that has the largest one relative to its J; the result is that of
  /// the last factor. Of the meshes that an earlier run had done the observer
  /// is told again.
  template <int dim>
  Answer<dim>
  solve_adaptively(const SolveSettings         &settings,
                   const AccuracyParameters    &accuracy,
                   RefinementGoal<dim>         *goal,
                   const AdaptiveObserver<dim> &observer,
                   Answer<dim>                  begun);
} // namespace Debond

#endif
