// SPDX-License-Identifier: LGPL-2.1-or-later
// The mean square of the positive part of an affine function beside sums over
// many small parts of the line or the triangle, for all signs of the values.

#include <debond/certify/positive_part.h>

#include <cmath>
#include <iostream>

#include "../check.h"

using namespace Debond;

namespace
{
  double
  square(const double q)
  {
    return q > 0. ? q * q : 0.;
  }



  double
  sum(const std::array<double, 2> &q)
  {
    constexpr unsigned int n     = 4000;
    double                 total = 0.;
    for (unsigned int i = 0; i < n; ++i)
      {
        const double x = (i + 0.5) / n;
        total += square(q[0] + x * (q[1] - q[0])) / n;
      }
    return total;
  }



  double
  sum(const std::array<double, 3> &q)
  {
    constexpr unsigned int n     = 300;
    double                 total = 0.;
    const auto             add   = [&](const double i, const double j) {
      total += square(q[0] + i / n * (q[1] - q[0]) + j / n * (q[2] - q[0]));
    };
    // At the centroids of n^2 parts.
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; i + j < n; ++j)
        {
          add(i + 1. / 3., j + 1. / 3.);
          if (i + j + 1 < n)
            add(i + 2. / 3., j + 2. / 3.);
        }
    return total / (n * n);
  }



  template <std::size_t n>
  void
  test(const std::string &name, const std::array<double, n> &q)
  {
    double largest = 0.;
    for (const double value : q)
      largest = std::max(largest, std::abs(value));
    check(name,
          std::abs(mean_positive_square(q) - sum(q)) / (largest * largest),
          1e-5);
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;

  test<2>("line, both positive", {{1., 0.3}});
  test<2>("line, one", {{-0.4, 2.}});
  test<2>("line, none", {{-0.4, -2.}});
  test<3>("triangle, all positive", {{0.3, 1., 0.7}});
  test<3>("triangle, two", {{0.3, -1., 0.7}});
  test<3>("triangle, two, far", {{0.3, -20., 0.2}});
  test<3>("triangle, one", {{-0.3, -1., 0.7}});
  test<3>("triangle, one and a zero", {{0., -1., 0.7}});
  test<3>("triangle, two zeros", {{0., 0., -0.7}});
  test<3>("triangle, the same", {{0.4, 0.4, 0.4}});
  check("a value of the size of rounding changes nothing",
        std::abs(mean_positive_square<3>({{1., 1e-17, -1.}}) /
                   mean_positive_square<3>({{1., -1e-17, -1.}}) -
                 1.),
        1e-14);
}
