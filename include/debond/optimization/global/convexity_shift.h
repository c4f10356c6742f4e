// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_convexity_shift_h
#define debond_optimization_global_convexity_shift_h

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace Debond
{
  /**
   * The inverse of A less a shift of its diagonal by what rounding can do to a
   * factorisation; nothing if that is not positive definite. If there is a
   * result, A is positive definite (Rump, BIT 46, 2006), and the result is
   * above its inverse.
   */
  std::optional<Eigen::MatrixXd>
  safe_inverse(const Eigen::MatrixXd &A);

  /// Returns whether safe_inverse() has a result, at a third of its cost.
  bool
  is_safely_positive_definite(const Eigen::MatrixXd &A);



  /// Approximately the largest t for which A - t diag(weights) is positive
  /// semidefinite (never much below it); infinite if all weights, which are not
  /// negative, are zero.
  double
  largest_multiple(const Eigen::MatrixXd &inverse_of_A,
                   const Eigen::VectorXd &weights);



  /// Takes the shift, or what a few retreats leave of it, from the diagonal of
  /// A and returns the safe_inverse() of the rest; nothing if A has none
  /// itself. A shift within the rounding of a matrix with the trace @p trace is
  /// none.
  std::optional<Eigen::MatrixXd>
  take_shift(const double trace, Eigen::MatrixXd &A, Eigen::VectorXd &shift);



  /**
   * Changes the diagonal D, which is moved from A into the terms of a
   * relaxation, towards a higher bound L(D), the minimum of the relaxation. L
   * is concave, its derivative with respect to D_i is v_i = 1/2 (s_i - a)(b -
   * s_i) where s_i is on the line from a to b of its envelope, and zero on the
   * parabolas. One sweep over the unknowns @p which of coordinate ascent for
   *
   *     v'D + mu log det (A - D),  D >= 0,
   *
   * with steps shortened, as v changes with D. @p inverse is that of A - D.
   */
  void
  raise_bound(const Eigen::MatrixXd           &inverse,
              const Eigen::VectorXd           &v,
              const double                     mu,
              const std::vector<unsigned int> &which,
              Eigen::VectorXd                 &D);
} // namespace Debond

#endif
