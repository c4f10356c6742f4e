// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_objective_h
#define debond_optimization_objective_h

#include <debond/base/dof_vector.h>

#include <Eigen/Core>

#include <memory>
#include <string>
#include <vector>

namespace Debond
{
  /**
   * The restriction t -> J(x + t d) of an objective to a line. A line search
   * asks for many values on one line; an objective that can share work
   * between them returns its own implementation from Objective::along().
   */
  class LineRestriction
  {
  public:
    virtual ~LineRestriction() = default;

    /// J(x + t d) - J(x), without the cancellation of the plain difference
    /// where the objective can avoid it.
    virtual double
    change(const double t) const = 0;

    /// One element of the Clarke subdifferential of J at x + t d.
    virtual void
    subgradient(const double t, DofVector &eta) const = 0;
  };



  /**
   * A locally Lipschitz function J: R^n -> R as the bundle method sees it: its
   * value and one (any) element of its Clarke subdifferential at each point
   * (Section 4 of Czepiel's paper).
   */
  class Objective
  {
  public:
    virtual ~Objective() = default;

    /// J(x).
    virtual double
    value(const DofVector &x) const = 0;

    /// One element of the Clarke subdifferential of J at x, written to eta,
    /// which has the size of x.
    virtual void
    subgradient(const DofVector &x, DofVector &eta) const = 0;

    /// The restriction to the line through x with direction d. Both vectors
    /// must outlive the result.
    virtual std::unique_ptr<LineRestriction>
    along(const DofVector &x, const DofVector &d) const = 0;
  };



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
