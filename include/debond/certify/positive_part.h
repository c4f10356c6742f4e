// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_positive_part_h
#define debond_certify_positive_part_h

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>

namespace Debond
{
  /// The mean over a line or a triangle of the square of the positive part of
  /// the affine function with the values @p q at its vertices. Nothing cancels:
  /// a triangle is cut along the line where the function is zero.
  template <std::size_t n>
  double
  mean_positive_square(std::array<double, n> q)
  {
    static_assert(n == 2 || n == 3);
    std::sort(q.begin(), q.end(), std::greater<double>());
    if (q[0] <= 0.)
      return 0.;
    if constexpr (n == 2)
      return q[1] >= 0. ? (q[0] * q[0] + q[0] * q[1] + q[1] * q[1]) / 3. :
                          q[0] * q[0] * q[0] / (3. * (q[0] - q[1]));
    else
      {
        // Where the values at all three vertices are not negative.
        const auto mean = [](const double a, const double b, const double c) {
          return (a * (a + b + c) + b * (b + c) + c * c) / 6.;
        };
        if (q[2] >= 0.)
          return mean(q[0], q[1], q[2]);
        // How far along the edge from the largest to the least value it is
        // positive.
        const double along = q[0] / (q[0] - q[2]);
        if (q[1] <= 0.)
          return along * (q[0] / (q[0] - q[1])) * mean(q[0], 0., 0.);
        const double other = q[1] / (q[1] - q[2]);
        return other * mean(q[0], q[1], 0.) +
               (1. - other) * along * mean(q[0], 0., 0.);
      }
  }
} // namespace Debond

#endif
