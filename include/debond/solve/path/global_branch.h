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



  /// Called with the number of a step, its point, and the bonds with the memory
  /// of the steps before, which break for good where it leads to. Returns
  /// whether there is a next step.
  template <int dim>
  using EnergeticObserver = std::function<
    bool(const unsigned int, const BranchPoint &, AdhesionIntegral<dim> &)>;

  /**
   * The energetic path of bonds that do not heal: at each of the @p starts, the
   * factors and any point for each, in their order the lowest minimum that is
   * known of J with the memory that the steps before have left, which are
   * those of this path; searches and proofs are as in global_branch(). A
   * minimum is called global only if all those before are, since it is one for
   * their memory.
   *
   * @p scene has the memory of the body at rest. The path ends early, before
   * the current step, if @p interruption is requested.
   */
  template <int dim>
  void
  energetic_path(
    const SolverParameters                                     &parameters,
    const CondensedScene<dim>                                  &scene,
    const std::vector<std::pair<LoadFactors, Eigen::VectorXd>> &starts,
    const Interruption                                         &interruption,
    const EnergeticObserver<dim>                               &observer);
} // namespace Debond

#endif
