// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_dense_cholesky_h
#define debond_linear_algebra_dense_cholesky_h

#include <Eigen/Core>

namespace Debond
{
  /// The Cholesky factor of a dense symmetric matrix by LAPACK, which takes a
  /// third of the time of Eigen's code, which is compiled for any machine.
  class DenseCholesky
  {
  public:
    /// Reads the lower triangle.
    explicit DenseCholesky(Eigen::MatrixXd A);

    /// If not there is no factor.
    bool
    is_positive_definite() const
    {
      return exists;
    }

    /// b <- A^{-1} b.
    void
    solve_in_place(Eigen::VectorXd &b) const;

    /// A^{-1}.
    Eigen::MatrixXd
    inverse() const;

  private:
    Eigen::MatrixXd factor; ///< the lower triangle
    bool            exists;
  };
} // namespace Debond

#endif
