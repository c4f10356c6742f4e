// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_path_load_path_h
#define debond_solve_path_load_path_h

#include <debond/solve/answer.h>
#include <debond/solve/minimum/progress.h>

namespace Debond
{
  /// Called after each factor, with the states so far and the verification of
  /// the last one.
  template <int dim>
  using LoadPathObserver =
    std::function<void(const Answer<dim> &, const Verification<dim> &)>;

  /**
   * Applies the factors of the scene's load path to its loads one after the
   * other. Each time majorise-minimise starts from the state before, the first
   * time from rest, and ends in the part of {J <= J(start)} that is connected
   * with its start: the segment to the minimum of a majorant lies below it.
   *
   * The path ends early with a factor that is not solved or whose result is not
   * verified, and before the current factor if a signal arrives in it, unless
   * that is the first one. Each step is looked into for the largest force, see
   * LargestForce. Then come the global branch, if a factorisation gives the
   * problem on the contact normals, and the scene's arc, see follow_arc(), from
   * the first factor. The status of the solution is success if all factors were
   * solved, whether or not all of them are verified. A table of the factors is
   * printed to @p out unless that is null.
   *
   * @p begun has the scene, how it is solved, and the steps that an earlier run
   * or call has done on this mesh; the observer sees the last of them again.
   * With @p only_steps neither the branch nor the arc is looked for, which is
   * left to the last mesh.
   */
  template <int dim>
  Answer<dim>
  follow_load_path(const LoadPathParameters    &parameters,
                   const SolveSettings         &settings,
                   Answer<dim>                  begun,
                   const LoadPathObserver<dim> &observer,
                   std::ostream                *out,
                   const bool                   only_steps = false);

  /// Solves the scene of @p begun on its mesh: the states of its load path, or
  /// the minimum from the start that @p begun has.
  template <int dim>
  Answer<dim>
  solve_on_mesh(const LoadPathParameters    &parameters,
                const SolveSettings         &settings,
                Answer<dim>                  begun,
                const LoadPathObserver<dim> &observer,
                const ProgressLog            log,
                const bool                   only_steps = false);
} // namespace Debond

#endif
