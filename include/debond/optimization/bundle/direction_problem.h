// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_bundle_direction_problem_h
#define debond_optimization_bundle_direction_problem_h

#include <debond/base/dof_vector.h>

#include <string>

namespace Debond
{
  /**
   * The feasible set K = {x : x[index[i]] <= upper[i]}. An index occurs at
   * most once.
   */
  struct UpperBounds
  {
    std::vector<unsigned int> indices;
    std::vector<double>       upper;
  };



  /**
   * The direction-finding problem of the bundle method with a metric M,
   *
   *     min_{d, v}  v + 1/2 d'M d
   *     subject to  eta_j'd - beta_j <= v,  x + d in K.
   *
   * The paper has M = u_k I. Holds the subgradients eta_j.
   */
  class DirectionProblem
  {
  public:
    struct Solution
    {
      /// max_j (eta_j'd - beta_j), the predicted descent v_k.
      double v = 0.;

      /// The exact predicted descent is not below v - duality_gap.
      double duality_gap = 0.;

      /// Largest of the relative residuals of the optimality conditions.
      double residual = 0.;

      /// Changes of the working set.
      unsigned int steps = 0;

      /// How the solver ended, in words.
      std::string status;

      /// eta_j'd for each subgradient.
      Eigen::VectorXd slopes;
    };

    virtual ~DirectionProblem() = default;

    /// Returns whether x is in K.
    virtual bool
    is_feasible(const DofVector &x) const = 0;

    /// Number of subgradients.
    virtual unsigned int
    size() const = 0;

    /// Removes all subgradients. The active bounds are kept for the next
    /// start.
    virtual void
    clear() = 0;

    virtual void
    add(const DofVector &eta) = 0;

    /// Solves at x for the given beta >= 0, one for each subgradient.
    virtual const Solution &
    solve(const DofVector &x, const Eigen::VectorXd &beta) = 0;

    /// The d of the last solve().
    virtual void
    direction(DofVector &d) const = 0;

    /// The distance that the locality measure counts: the length of d in the
    /// metric M / u.
    virtual double
    length(const DofVector &d) const = 0;

    /// Takes rounding back that may have taken x out of K.
    virtual void
    project(DofVector &x) const = 0;
  };
} // namespace Debond

#endif
