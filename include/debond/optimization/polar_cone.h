// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_polar_cone_h
#define debond_optimization_polar_cone_h

#include <debond/base/views.h>

#include <optional>

namespace Debond
{
  /**
   * The point p nearest to @p f of those with b'p <= 0 for each column b of
   * @p B, which has as many rows as f has entries: p = f - B lambda with the
   * nonnegative least squares lambda (Moreau), by the active sets of Lawson and
   * Hanson, Solving Least Squares Problems (1974), chapter 23. For few rows and
   * any number of columns: each set has at most as many columns as there are
   * rows. Columns may be of any lengths, zero and parallel; b'p is at most
   * rounding of |b| |f|.
   *
   * Nothing if rounding lets the sets repeat.
   */
  std::optional<Eigen::VectorXd>
  project_on_polar_cone(const MatrixView &B, const Eigen::VectorXd &f);
} // namespace Debond

#endif
