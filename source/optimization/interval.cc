// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/optimization/interval.h>

#include <algorithm>
#include <cmath>

namespace Debond
{
  Interval
  hull(const Interval &a, const Interval &b)
  {
    if (a.is_empty())
      return b;
    if (b.is_empty())
      return a;
    return {std::min(a.lower, b.lower), std::max(a.upper, b.upper)};
  }



  Interval
  intersection(const Interval &a, const Interval &b)
  {
    return {std::max(a.lower, b.lower), std::min(a.upper, b.upper)};
  }



  double
  Growth::value(const double s) const
  {
    const double d = s - x;
    return constant + slope * d + 0.5 * curvature * d * d;
  }



  double
  Growth::least(const Interval &interval) const
  {
    if (interval.is_empty())
      return infinity;
    // A parabola that is not convex is least at an end.
    if (!(curvature > 0.))
      return std::min(value(interval.lower), value(interval.upper));
    return value(std::min(std::max(x - slope / curvature, interval.lower),
                          interval.upper));
  }



  Interval
  Growth::where_at_most(const double level, const Interval &interval) const
  {
    if (least(interval) > level)
      return {1., -1.};
    // What is concave is low at the ends.
    if (!(curvature > 0.))
      return interval;
    // constant + slope d + curvature/2 d^2 <= level within the roots about the
    // minimum, at d = centre.
    const double centre = -slope / curvature;
    const double radius =
      std::sqrt(
        std::max(0., centre * centre - 2. * (constant - level) / curvature)) *
        (1. + Tolerance::outwards) +
      Tolerance::outwards * std::abs(centre);
    // Rounding must not leave out the least value.
    const Interval inner = {std::max(interval.lower, x + centre - radius),
                            std::min(interval.upper, x + centre + radius)};
    return inner.is_empty() ? interval : inner;
  }
} // namespace Debond
