// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_interval_h
#define debond_optimization_interval_h

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
} // namespace Debond

#endif
