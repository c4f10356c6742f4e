// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/optimization/majorise/majorant.h>

namespace Debond
{
  bool
  Majorant::touch(const Eigen::VectorXd             &s,
                  const Eigen::VectorXd             &xi,
                  const Eigen::SparseMatrix<double> &curvature)
  {
    // Squares of what rounding leaves of a vanishing load would underflow. And
    // Eigen's norms refuse what has no entries, as bodies without contact.
    const auto size = [](const Eigen::VectorXd &v) {
      return v.size() == 0 ? 0. : v.lpNorm<Eigen::Infinity>();
    };
    const auto norm = [](const Eigen::SparseMatrix<double> &matrix) {
      return matrix.size() == 0 ? 0. : matrix.norm();
    };
    // The gradient E s - b of 1/2 s'E s - b's has to be xi at s.
    const Eigen::VectorXd E_s   = curvature * s;
    const Eigen::VectorXd new_b = E_s - xi;
    // Both terms of b are as large as E s, and cancel where the piece of the
    // law goes through zero.
    const bool is_same =
      touches &&
      size(new_b - b) <= Tolerance::same_majorant * (size(E_s) + size(new_b)) &&
      norm(curvature - E) <= Tolerance::same_majorant * norm(curvature);
    E       = curvature;
    b       = new_b;
    touches = true;
    return !is_same;
  }
} // namespace Debond
