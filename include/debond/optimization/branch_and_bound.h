// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_branch_and_bound_h
#define debond_optimization_branch_and_bound_h

#include <deal.II/lac/full_matrix.h>

#include <debond/optimization/separable_bonds.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace Debond
{
  struct BranchAndBoundParameters
  {
    /// A part of the search space is left out if its least value is at most
    /// this below the best known one, an energy.
    double tolerance = 0.;

    unsigned int maximum_nodes   = 1000000;
    double       maximum_seconds = std::numeric_limits<double>::infinity();
  };



  /// Where the proof stands.
  struct ProofProgress
  {
    unsigned int nodes;
    unsigned int open; ///< nodes that wait
    double       lower, upper;
    double       seconds;
  };



  enum class ProofStatus
  {
    proved,      ///< upper - lower is at most the tolerance
    node_limit,  ///< the nodes were used up
    time_limit,  ///< the time was used up
    interrupted, ///< by the monitor
    rounding,    ///< all bonds are decided, rounding leaves a larger gap
    no_bound     ///< S is not safely positive definite: there is no bound
  };

  std::string
  to_string(const ProofStatus status);



  struct BranchAndBoundResult
  {
    ProofStatus            status = ProofStatus::no_bound;
    dealii::Vector<double> s;     ///< the best point found
    double                 upper; ///< its value
    double                 lower; ///< the minimum is not below this
    unsigned int           nodes = 0;
    double                 seconds;

    std::vector<ProofProgress> history; ///< at each tenth part more of nodes
  };



  /**
   * The global minimum of 1/2 s'S s - g's + Phi(s), s <= 0, by branch and bound
   * on which bonds are broken.
   *
   * A node decides some bonds. What is undecided is replaced by its convex
   * envelope on an interval, after an amount of convexity was moved from S to
   * the undecided bonds, which makes the envelope tighter (the D.C. splitting
   * of alpha-BB: Androulakis, Maranas, Floudas, J. Global Optim. 7, 1995). The
   * bound is LowerBound, which needs no exact minimum. The intervals shrink,
   * and bonds are decided, by what the bound leaves below the best known value.
   * The node with the lowest bound comes next, and from it one goes down to the
   * more promising half each time until it is left out.
   *
   * Runs in one thread; the order of the nodes is always the same, so that only
   * a limit of time makes a result depend on the machine.
   */
  class BranchAndBound
  {
  public:
    /// Returns false to end.
    using Monitor = std::function<bool(const ProofProgress &)>;

    explicit BranchAndBound(const BranchAndBoundParameters &parameters);

    /// @p start is a good point, with s <= 0.
    BranchAndBoundResult
    minimize(const dealii::FullMatrix<double> &S,
             const dealii::Vector<double>     &g,
             const SeparableBonds             &bonds,
             const dealii::Vector<double>     &start,
             const Monitor                    &monitor = {}) const;

  private:
    BranchAndBoundParameters parameters;
  };
} // namespace Debond

#endif
