// SPDX-License-Identifier: LGPL-2.1-or-later
// Iterations whose residuals are known: who goes on, and where the others end.

#include <debond/linear_algebra/stagnation.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>

#include "../check.h"

using namespace Debond;

namespace
{
  constexpr unsigned int most_steps = 2000;



  /// The step after which it ends, 0 if it does not. Steps count from 1.
  unsigned int
  end_of(const std::function<double(unsigned int)> &residual)
  {
    Stagnation stagnation;
    for (unsigned int step = 1; step <= most_steps; ++step)
      if (stagnation.is_reached(residual(step)))
        return step;
    return 0;
  }



  /// Falls to a half in so many steps.
  std::function<double(unsigned int)>
  halved_in(const double steps)
  {
    return
      [=](const unsigned int step) { return std::exp2(-1. * step / steps); };
  }
} // namespace



int
main()
{
  check("halved in 50 steps goes on", end_of(halved_in(50.)) == 0);
  check("halved in 99 steps goes on", end_of(halved_in(99.)) == 0);
  check("halved in 101 steps ends after 200", end_of(halved_in(101.)) == 200);
  check("what stays as it is ends after 200",
        end_of([](const unsigned int) { return 3.; }) == 200);
  check("what rises ends after 200",
        end_of([](const unsigned int step) { return 1. * step; }) == 200);
  check("twelve digits in 300 steps, and then rounding, end after 400",
        end_of([](const unsigned int step) {
          return std::max(1e-12, std::pow(10., -0.04 * step));
        }) == 400);

  // Residuals of conjugate gradients go up and down; the least one counts.
  check("a million times the least one, where it is looked at, goes on",
        end_of([](const unsigned int step) {
          return halved_in(50.)(step) * (step % 200 == 0 ? 1e6 : 1.);
        }) == 0);
  check("and without a lower one ends after 200",
        end_of([](const unsigned int step) {
          return step % 100 == 10 ? 1. : 1e6;
        }) == 200);

  // In other units the steps are the same.
  for (const double unit : {1e-300, 1e300})
    check("in other units", end_of([=](const unsigned int step) {
                              return unit * halved_in(101.)(step);
                            }) == 200);
  check("nothing left goes on",
        end_of([](const unsigned int) { return 0.; }) == 0);
}
