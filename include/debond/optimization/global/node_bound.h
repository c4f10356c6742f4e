// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_node_bound_h
#define debond_optimization_global_node_bound_h

#include <debond/optimization/global/branch_and_bound.h>
#include <debond/optimization/global/envelope_relaxation.h>

#include <array>

namespace Debond
{
  /// A part of the search space of branch and bound: a box.
  struct ProofNode
  {
    double          bound;
    unsigned int    number;
    Eigen::VectorXd lower, upper;
    Eigen::VectorXd x;     ///< where its relaxation starts
    Eigen::VectorXd shift; ///< convexity moved to the terms of Phi

    bool
    operator<(const ProofNode &other) const
    {
      return bound != other.bound ? bound < other.bound : number < other.number;
    }
  };



  /// The findings of NodeBound about a node.
  struct NodeResult
  {
    /// The unknown to branch on next, where, and bounds of the upper and the
    /// lower half.
    std::optional<unsigned int> unknown;
    double                      split       = 0.;
    std::array<double, 2>       half_bounds = {};

    /// If there is none, the node is done: it has no value below this.
    double least;

    std::vector<ProofRound> rounds; ///< by which this was found
  };



  /// A ball with the points of a node: the functional is at least
  ///     value + 1/2 (s - x)'A (s - x)
  /// in the node's box.
  struct NodeBall
  {
    double          value;
    Eigen::VectorXd x;
    Eigen::MatrixXd inverse; ///< of A
    Eigen::VectorXd D;       ///< what A has less than S on its diagonal
  };



  /**
   * Bounds nodes of the branch and bound for 1/2 s'S s - g's + Phi(s), s <=
   * upper <= 0, Phi with pieces.
   *
   * A node's box leaves each unknown some pieces in a row: if it is a convex
   * one, the unknown is decided. The others' terms are replaced by their convex
   * envelope on the box, after an amount of convexity was moved from S to them,
   * which makes the envelope tighter (the D.C. splitting of alpha-BB:
   * Androulakis, Maranas, Floudas, J. Global Optim. 7, 1995): first the same
   * multiple of the differences of their curvatures, which leaves enough in S
   * to shrink the box, then what raises the bound (raise_bound, with which the
   * bound nears that of a semidefinite program). Each bound shrinks the box to
   * where a point can be below the best known value, which decides unknowns.
   */
  class NodeBound
  {
  public:
    /// The root has at most so many relaxations.
    NodeBound(const SeparableProblem &problem,
              const unsigned int      rounds_of_root =
                BranchAndBoundParameters().rounds_of_root)
      : phi(problem.phi)
      , n(static_cast<unsigned int>(problem.g.size()))
      , S(problem.S)
      , g(problem.g)
      , upper(problem.upper)
      , rounds_of_root(rounds_of_root)
    {}

    /// The box in which points are not above @p best_value; nothing if S is not
    /// safely positive definite.
    std::optional<ProofNode>
    root(const double best_value) const;

    /// What the box of the root follows from.
    ProofRound
    round_of_root(const ProofNode &root) const;

    /// A lower bound of the functional, the value of the round, that is close
    /// to its value at @p s if the convexity with which the terms of Phi are
    /// not below their tangents at s leaves S positive definite; minus infinity
    /// if it does not. Takes one factorisation.
    ProofRound
    bound_at(const Eigen::VectorXd &s) const;

    /// Raises the node's bound and shrinks its box.
    NodeResult
    bound(ProofNode   &node,
          const double best_value,
          const double tolerance) const;

    /// Balls for the convexity that the node's bound was raised with, which has
    /// a high value, and for that of its first relaxation, which has a large A;
    /// none if S, with the terms that are decided, is not safely positive
    /// definite.
    std::vector<NodeBall>
    balls(const ProofNode &node) const;

  protected:
    const SeparableEnergy &phi;
    const unsigned int     n;
    Eigen::MatrixXd        S;
    Eigen::VectorXd        g, upper;
    const unsigned int     rounds_of_root;
  };
} // namespace Debond

#endif
