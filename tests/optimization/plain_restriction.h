// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_tests_optimization_plain_restriction_h
#define debond_tests_optimization_plain_restriction_h

#include <debond/optimization/objective.h>

namespace Debond
{
  /// The restriction by plain evaluation at x + t d.
  class PlainRestriction : public LineRestriction
  {
  public:
    PlainRestriction(const Objective &objective,
                     const DofVector &x,
                     const DofVector &d)
      : objective(objective)
      , x(x)
      , d(d)
      , value_at_x(objective.value(x))
    {}

    double
    change(const double t) const override
    {
      point = x;
      point.add(t, d);
      return objective.value(point) - value_at_x;
    }

    void
    subgradient(const double t, DofVector &eta) const override
    {
      point = x;
      point.add(t, d);
      objective.subgradient(point, eta);
    }

  private:
    const Objective  &objective;
    const DofVector  &x;
    const DofVector  &d;
    const double      value_at_x;
    mutable DofVector point;
  };
} // namespace Debond

#endif
