// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_proof_record_h
#define debond_optimization_global_proof_record_h

#include <debond/optimization/global/separable_energy.h>

#include <array>
#include <map>
#include <optional>

namespace Debond
{
  /**
   * What one relaxation of a node has shown, for others to check; see
   * doc/reference/proofs.md. With A = S - diag(D) and any x there is a lower
   * bound in any box, and how it grows with one unknown.
   */
  struct ProofRound
  {
    Eigen::VectorXd D, x;

    /// Of planes below pairs of kinks; empty without such.
    Eigen::VectorXd forces = {};

    /// The bound in the node's box.
    double value = -infinity;

    /// What it has left of the box; empty if the box stays as it was.
    Eigen::VectorXd lower = {}, upper = {};
  };



  /// What was found about a node of branch and bound. Its box is divided at
  /// `split` of an unknown, or it is done.
  struct NodeRecord
  {
    std::vector<ProofRound>     rounds;
    std::optional<unsigned int> unknown     = {};
    double                      split       = 0.;
    std::array<unsigned int, 2> halves      = {}; ///< numbers, upper half first
    std::array<double, 2>       half_bounds = {}; ///< by the last round
  };

  /// Nodes by their numbers, from 0, the root. Those that are not there have
  /// been left out by the bound of the node that they are a half of.
  using ProofRecord = std::map<unsigned int, NodeRecord>;



  /// c_0 + 1/2 s'S s - g's + phi(s), s <= upper.
  struct DiscreteProblem
  {
    Eigen::MatrixXd S;
    Eigen::VectorXd g;
    double          c_0;
    Eigen::VectorXd upper;
    SeparableEnergy phi;
  };



  /// With what proves its minimum.
  struct RecordedProof
  {
    DiscreteProblem problem;
    Eigen::VectorXd state; ///< with the least value that is known
    ProofRecord     nodes;
  };
} // namespace Debond

#endif
