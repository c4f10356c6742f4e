// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_rounded_branches_h
#define debond_optimization_global_rounded_branches_h

#include <debond/optimization/branch_minimum.h>
#include <debond/optimization/interval.h>

#include <optional>
#include <vector>

namespace Debond
{
  /**
   * Convex branches whose minimum is at most
   *
   *     conv(f + D/2 s^2) - D/2 s^2,   s <= 0,
   *
   * conv being the convex envelope: by Jensen's inequality the mean of f(s) +
   * D/2 (s - m)^2 over functions s with the mean m is not below that at m.
   *
   * The envelope is f but on lines that touch it on both sides of a kink.
   * There the difference is concave, and not below the branch with the
   * curvature of f on the far side that meets f where the line touches.
   */
  class RoundedBranches
  {
  public:
    /// @p D > 0.
    RoundedBranches(const BranchMinimum &f, const double D);

    /// Those of f and one for each line. Throws std::invalid_argument as
    /// BranchMinimum does.
    BranchMinimum
    minimum() const;

    /// Whether s, or what a tenth of a kink's distance from 0 takes it to, is
    /// on a line.
    bool
    is_rounded_near(const double s) const;

    /// The piece of f that is not rounded on all of the interval, and for s > 0
    /// if the interval has such: there
    ///     conv(f + D/2 s^2)(s + w) >= f(s) + D/2 s^2 + (f'(s) + D s) w.
    std::optional<unsigned int>
    exact_piece(const Interval &interval) const;

  private:
    struct Line
    {
      double lower, upper;
    };

    const BranchMinimum &f;
    std::vector<Line>    lines;
  };
} // namespace Debond

#endif
