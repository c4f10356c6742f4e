// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_objective_h
#define debond_optimization_objective_h

#include <debond/linear_algebra/dof_vector.h>

#include <memory>
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
} // namespace Debond

#endif
