// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_cholesky_h
#define debond_linear_algebra_cholesky_h

#include <Eigen/Core>

namespace Debond
{
  /**
   * The Cholesky factor K = L L' of a small dense matrix that grows and
   * shrinks by a row at a time and changes by rank one, each in O(n^2)
   * (Golub and Van Loan, Matrix Computations, 4th ed., Section 6.5).
   */
  class UpdatableCholesky
  {
  public:
    /// Makes room for matrices up to the given size and empties the factor.
    void
    reserve(const unsigned int capacity);

    void
    clear()
    {
      n = 0;
    }

    unsigned int
    size() const
    {
      return n;
    }

    /// Factorises a whole matrix, whose lower triangle is read. Returns whether
    /// it is positive definite; if not the factor is empty.
    bool
    compute(const Eigen::MatrixXd &K);

    /// A number that is at least 1 / (|K| |K^{-1}|) in the 2-norm, at most 1.
    double
    condition_bound() const
    {
      const auto   diagonal = factor.diagonal().head(n);
      const double ratio =
        n == 0 ? 1. : diagonal.minCoeff() / diagonal.maxCoeff();
      return ratio * ratio;
    }

    /// Appends a row and column to K: @p column holds the new entries of K
    /// next to the existing rows, @p diagonal the new diagonal entry. Returns
    /// the part of the diagonal that is independent of the existing rows,
    /// relative to @p diagonal; if it is not above @p tolerance the factor is
    /// left as it was.
    double
    append(const Eigen::Ref<const Eigen::VectorXd> &column,
           const double                             diagonal,
           const double                             tolerance);

    /// Deletes row and column @p k.
    void
    remove(const unsigned int k);

    /// K <- K + w w'.
    void
    update(Eigen::VectorXd w)
    {
      update_trailing(0, w);
    }

    /// K <- K - w w'. Returns 1 - w' K^{-1} w; if it is not above
    /// @p tolerance the factor is left as it was.
    double
    downdate(const Eigen::Ref<const Eigen::VectorXd> &w,
             const double                             tolerance);

    /// b <- K^{-1} b.
    void
    solve_in_place(Eigen::Ref<Eigen::VectorXd> b) const;

  private:
    /// Rank-one update of the trailing block that starts at row @p first; w
    /// has its size.
    void
    update_trailing(const unsigned int first, Eigen::Ref<Eigen::VectorXd> w);

    unsigned int    n = 0;
    Eigen::MatrixXd factor; ///< lower triangle, leading n x n block in use
  };



  /// The Cholesky factor of a dense symmetric matrix by LAPACK, which takes a
  /// third of the time of Eigen's code, which is compiled for any machine.
  class DenseCholesky
  {
  public:
    /// Reads the lower triangle.
    explicit DenseCholesky(Eigen::MatrixXd A);

    /// Returns whether there is a factor.
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
