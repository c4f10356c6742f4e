// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_path_global_branch_h
#define debond_solve_path_global_branch_h

#include <debond/solve/minimum/condensed_scene.h>
#include <debond/solve/minimum/which_minimum.h>

namespace Debond
{
  /// A minimum of the condensed problem under multiples of its loads.
  struct BranchPoint
  {
    Eigen::VectorXd s;
    double          functional; ///< without the energy at s = 0
    WhichMinimum    which;
  };

  using Branch = std::map<LoadFactors, BranchPoint>;

  /// Called with the factors and the point, each time that one is done.
  using BranchMonitor =
    std::function<void(const LoadFactors, const BranchPoint &)>;

  /**
   * The lowest minima that are known at the factors of @p start, which holds a
   * minimum for each: a full search, or if @p parameters limit its operations
   * searches that share these, with starts from the neighbours in the order of
   * LoadFactors, and the proof if it is @p wanted. No point is above the one in
   * @p start. Factors that were not reached when @p interruption was requested
   * are left out.
   */
  template <int dim>
  Branch
  global_branch(const GlobalBranch         wanted,
                const SolverParameters    &parameters,
                const CondensedScene<dim> &scene,
                const Branch              &start,
                const Interruption        &interruption,
                const BranchMonitor       &monitor);
} // namespace Debond

#endif
