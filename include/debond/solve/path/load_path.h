// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_path_load_path_h
#define debond_solve_path_load_path_h

#include <debond/solve/minimum/solve.h>
#include <debond/solve/path/load_path_steps.h>

namespace Debond
{
  /// How far a path has come, and all that the way on depends on.
  template <int dim>
  struct PathProgress
  {
    std::vector<LoadPathStep<dim>> steps;

    /// By step.
    std::vector<Eigen::VectorXd> points; ///< s of the contact nodes
    std::vector<MinimumKind>     kinds;

    /// After the last step.
    DofVector  u;
    BondMemory memory;
  };

  /// The states of a load path on a mesh.
  template <int dim>
  struct FollowedPath
  {
    SolveResult                    result; ///< that of the last factor
    PathProgress<dim>              progress;
    std::vector<LoadPathStep<dim>> arc;

    /// The bonds after the last step, with references to the scene; null if
    /// there is none.
    std::shared_ptr<const AdhesionIntegral<dim>> bonds;
  };

  /// Called after each factor, with the verification of the displacement and
  /// the bonds as they are.
  template <int dim>
  using LoadPathObserver = std::function<void(const PathProgress<dim> &,
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
   * @p start has the steps that an earlier run or call has done, none at first;
   * the observer sees the last of them again. There is no factorisation if
   * nothing but that is left to do. The scene's arc, see follow_arc(), starts
   * from the first factor.
   */
  template <int dim>
  FollowedPath<dim>
  follow_load_path(const LoadPathParameters    &parameters,
                   const SolveSettings         &settings,
                   const Scene<dim>            &scene,
                   const FollowedPath<dim>     &start,
                   const LoadPathObserver<dim> &observer,
                   std::ostream                *out);
} // namespace Debond

#endif
