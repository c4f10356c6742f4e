// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_load_path_h
#define debond_solve_load_path_h

#include <debond/input/load_path_parameters.h>
#include <debond/input/solver_parameters.h>
#include <debond/linear_algebra/dof_vector.h>
#include <debond/solve/load_path_steps.h>
#include <debond/solve/scene.h>
#include <debond/solve/solve.h>

#include <functional>
#include <memory>
#include <ostream>
#include <vector>

namespace Debond
{
  /// The states of a load path on a mesh.
  template <int dim>
  struct FollowedPath
  {
    SolveResult                    result; ///< that of the last factor
    std::vector<LoadPathStep<dim>> steps;
    std::vector<LoadPathStep<dim>> arc;

    /// As they are after the last step, with references to the scene; null if
    /// there is none.
    std::shared_ptr<const AdhesionIntegral<dim>> bonds;
  };

  /// Called after each factor, with the displacement, its verification and the
  /// bonds as they are.
  template <int dim>
  using LoadPathObserver = std::function<void(const LoadPathStep<dim> &,
                                              const DofVector &,
                                              const Verification<dim> &,
                                              const AdhesionIntegral<dim> &)>;

  /**
   * Applies the factors of the scene's load path to its loads one after the
   * other. Each time majorise-minimise starts from the state before, the first
   * time from rest, and ends in the part of {J <= J(start)} that is connected
   * with its start: the segment to the minimum of a majorant lies below it.
   *
   * The path ends early with a factor that is not solved or whose result is not
   * verified, and after the current factor if a signal arrives. Then comes the
   * global branch, if a factorisation gives the problem on the contact normals.
   * The status of the result is success
   * if all factors were solved, whether or not all of them are verified. A
   * table of the factors is printed to @p out unless that is null.
   *
   * If the scene wants it, `arc` gets the curve of stationary states on which
   * that of the first factor is, a step for each breakpoint (StationaryPath),
   * until the factor leaves the interval of those of the path: `status` is
   * "stable" if the states between the last breakpoint and this one are minima,
   * else "unstable".
   */
  template <int dim>
  FollowedPath<dim>
  follow_load_path(const LoadPathParameters    &parameters,
                   const SolveSettings         &settings,
                   const Scene<dim>            &scene,
                   const LoadPathObserver<dim> &observer,
                   std::ostream                *out);
} // namespace Debond

#endif
