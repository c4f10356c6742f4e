// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_interval_h
#define debond_optimization_interval_h

#include <debond/base/infinity.h>

namespace Debond
{
  /// A closed interval of real numbers, empty if lower > upper.
  struct Interval
  {
    double lower;
    double upper;

    bool
    is_empty() const
    {
      return lower > upper;
    }
  };



  /// The smallest interval that contains both @p a and @p b, either of which
  /// may be empty.
  Interval
  hull(const Interval &a, const Interval &b);

  /// Empty if they have nothing in common.
  Interval
  intersection(const Interval &a, const Interval &b);



  /**
   * How a lower bound of a functional grows with one of its unknowns:
   * constant + slope (s - x) + curvature/2 (s - x)^2.
   */
  struct Growth
  {
    double x;
    double constant, slope, curvature;

    double
    value(const double s) const;

    /// The least value on the interval, infinite if that is empty.
    double
    least(const Interval &interval) const;

    /// The part of the interval where the value is at most the level, rounded
    /// outwards; all of it if it is concave and has such values.
    Interval
    where_at_most(const double level, const Interval &interval) const;
  };
} // namespace Debond

#endif
