// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_bond_bound_h
#define debond_optimization_global_bond_bound_h

#include <debond/optimization/global/node_bound.h>

namespace Debond
{
  /**
   * The bounds of NodeBound for springs with several unknowns z that lose their
   * stiffness at once (SeparableEnergy::is_piecewise_quadratic() with bonds),
   *
   *     J(z) = 1/2 z'S z - g'z + sum_i min(1/2 sum_j k_j z_j^2, G_i),
   *
   * z <= upper, which may be infinite. Bonds hold, are broken, or may do both:
   * entry n + i of a node's lower bounds is positive where bond i is broken,
   * that of the upper ones below 1 where it holds; the others are a box for z.
   *
   * With A = S + the stiffness of bonds that hold - D, D a diagonal, and r =
   * A x - g, for any x
   *
   *     J(z) >= -1/2 x'A x + sum_j (r_j z_j + D_j/2 z_j^2) + sum_i min(...),
   *
   * where the sums run over the other bonds' terms: each is the lesser of two
   * separable quadratics, of which the least values in the box have closed
   * forms. The bound is high at the minimum with a convex function below each
   * min(...) + D/2 z^2, and grows with the distance from x by A, which makes
   * the box smaller. States with bounds above the best value are left out.
   */
  class BondBound : public NodeBound
  {
  public:
    using NodeBound::NodeBound;

    std::optional<ProofNode>
    root(const double best_value) const;

    ProofRound
    bound_at(const Eigen::VectorXd &z) const;

    NodeResult
    bound(ProofNode   &node,
          const double best_value,
          const double tolerance) const;
  };
} // namespace Debond

#endif
