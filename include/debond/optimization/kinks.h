// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_kinks_h
#define debond_optimization_kinks_h

#include <debond/base/views.h>

namespace Debond
{
  /// The sum of weight_i |x_i - place_i|, weight_i >= 0: friction with a given
  /// bound. Both are empty if there is no such term.
  struct Kinks
  {
    Eigen::VectorXd weight = {}, place = {};

    /// Returns whether x_i has a term.
    bool
    has(const Eigen::Index i) const
    {
      return weight.size() > 0 && weight(i) > 0.;
    }

    double
    value(const VectorView &x) const
    {
      return weight.size() == 0 ? 0. : weight.dot((x - place).cwiseAbs());
    }

    /// The derivative by x_i, 0 at the kink itself.
    double
    derivative(const Eigen::Index i, const double x_i) const
    {
      return !has(i) || x_i == place(i) ?
               0. :
               std::copysign(weight(i), x_i - place(i));
    }
  };
} // namespace Debond

#endif
