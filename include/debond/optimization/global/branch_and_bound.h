// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_branch_and_bound_h
#define debond_optimization_global_branch_and_bound_h

#include <debond/optimization/global/proof_record.h>

namespace Debond
{
  struct BranchAndBoundParameters
  {
    /// A part of the search space is left out if its least value is at most
    /// this below the best known one, an energy.
    double tolerance = 0.;

    /// With 0 there is only the bound at the start, NodeBound::bound_at().
    unsigned int maximum_nodes = 1000000;

    unsigned int rounds_of_root = 30; ///< relaxations of the first node

    double maximum_seconds = infinity;

    /// For the open nodes.
    double maximum_bytes = infinity;

    unsigned int n_threads = 1;

    bool keeps_record = false; ///< BranchAndBoundResult::record
  };



  /// The state of a proof.
  struct ProofProgress
  {
    unsigned int nodes;
    unsigned int open; ///< nodes that wait
    double       lower, upper;
    double       seconds;
  };



  enum class ProofStatus
  {
    proved,       ///< upper - lower is at most the tolerance
    node_limit,   ///< the nodes were used up
    time_limit,   ///< the time was used up
    memory_limit, ///< the open nodes take too much
    interrupted,  ///< SeparableProblem::interruption
    rounding,     ///< all is decided, rounding leaves a larger gap
    no_bound      ///< S is not safely positive definite: there is no bound
  };

  std::string
  to_string(const ProofStatus status);



  struct BranchAndBoundResult
  {
    ProofStatus     status = ProofStatus::no_bound;
    Eigen::VectorXd s;     ///< the best point found
    double          upper; ///< its value
    double          lower; ///< the minimum is not below this
    unsigned int    nodes = 0;
    double          seconds;

    std::vector<ProofProgress> history; ///< at each tenth part more of nodes

    ProofRecord record; ///< empty if none was to be kept
  };



  /**
   * The global minimum of 1/2 s'S s - g's + Phi(s), s <= upper <= 0, by branch
   * and bound on the pieces of Phi.
   *
   * A node leaves each unknown some pieces, and NodeBound bounds it. The open
   * nodes with the lowest bounds are next, some at a time, in as many threads
   * as there are. The order of the nodes does not depend on the number of
   * threads, so that only a limit of time makes a result depend on the machine.
   *
   * @p start is a good point within the bounds.
   */
  BranchAndBoundResult
  branch_and_bound(const BranchAndBoundParameters &parameters,
                   const SeparableProblem         &problem,
                   const VectorView               &start);
} // namespace Debond

#endif
