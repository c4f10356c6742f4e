// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_stagnation_h
#define debond_linear_algebra_stagnation_h

#include <debond/base/infinity.h>

#include <algorithm>
#include <limits>

namespace Debond
{
  /**
   * Whether an iteration goes on to no purpose: in a hundred steps its least
   * residual has not fallen to half. What rounding leaves stays as it is; what
   * falls slower than that loses less than six digits in 2000 steps.
   */
  class Stagnation
  {
  public:
    /// Takes the residual after one more step, which is not negative.
    bool
    is_reached(const double residual)
    {
      least = std::min(least, residual);
      if (++n_steps % steps != 0)
        return false;
      const bool result = least > 0.5 * before;
      before            = least;
      return result;
    }

  private:
    static constexpr unsigned int steps = 100;

    unsigned int n_steps = 0;
    double       least   = infinity;
    double       before  = infinity;
  };
} // namespace Debond

#endif
