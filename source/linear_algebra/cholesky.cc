// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/exceptions.h>
#include <deal.II/lac/lapack_templates.h>

#include <debond/linear_algebra/cholesky.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <utility>

namespace Debond
{
  namespace
  {
    using LapackInteger = dealii::types::blas_int;

    /// The number of rows, but not zero, as LAPACK wants it.
    LapackInteger
    leading_dimension(const Eigen::MatrixXd &A)
    {
      return static_cast<LapackInteger>(std::max<Eigen::Index>(1, A.rows()));
    }



    /// The lower triangle becomes the factor. Returns whether A is positive
    /// definite.
    bool
    factorise(Eigen::MatrixXd &A)
    {
      const LapackInteger n   = static_cast<LapackInteger>(A.rows());
      const LapackInteger lda = leading_dimension(A);
      LapackInteger       info;
      dealii::potrf("L", &n, A.data(), &lda, &info);
      AssertThrow(info >= 0, dealii::ExcInternalError());
      return info == 0;
    }
  } // namespace



  void
  UpdatableCholesky::reserve(const unsigned int capacity)
  {
    factor.resize(capacity, capacity);
    n = 0;
  }



  bool
  UpdatableCholesky::compute(const Eigen::MatrixXd &K)
  {
    // LAPACK overwrites what it factorises; the factor is kept in the storage
    // that has room for more rows.
    Eigen::MatrixXd lower  = K;
    const bool      exists = factorise(lower);
    n                      = exists ? static_cast<unsigned int>(K.rows()) : 0;
    factor.topLeftCorner(n, n) = lower.topLeftCorner(n, n);
    return exists;
  }



  double
  UpdatableCholesky::append(const Eigen::Ref<const Eigen::VectorXd> &column,
                            const double                             diagonal,
                            const double                             tolerance)
  {
    // The new row l of the factor has L l = column. The new pivot, diagonal -
    // |l|^2, is what the new row has that the others do not: the squared
    // distance of its vector from their span if K is a Gram matrix. If it is no
    // more than rounding, the factor is not extended.
    Eigen::VectorXd row = column;
    factor.topLeftCorner(n, n).triangularView<Eigen::Lower>().solveInPlace(row);

    const double independent = diagonal - row.squaredNorm();
    if (!(independent > tolerance * diagonal))
      return independent / diagonal;

    factor.row(n).head(n) = row.transpose();
    factor(n, n)          = std::sqrt(independent);
    ++n;
    return independent / diagonal;
  }



  void
  UpdatableCholesky::remove(const unsigned int k)
  {
    // Without row and column k the leading block and the rows below it stay,
    // and the trailing block loses the part l l' of column k from its product:
    // its factor L_33 becomes that of L_33 L_33' + l l', a rank-one update,
    // which is stable.
    const unsigned int    trailing = n - k - 1;
    const Eigen::VectorXd deleted  = factor.col(k).segment(k + 1, trailing);

    // A column at a time, downwards: source and target overlap.
    for (unsigned int j = 0; j < k; ++j)
      for (unsigned int i = k; i + 1 < n; ++i)
        factor(i, j) = factor(i + 1, j);
    for (unsigned int j = k; j + 1 < n; ++j)
      for (unsigned int i = j; i + 1 < n; ++i)
        factor(i, j) = factor(i + 1, j + 1);
    --n;

    Eigen::VectorXd w = deleted;
    update_trailing(k, w);
  }



  void
  UpdatableCholesky::update_trailing(const unsigned int          first,
                                     Eigen::Ref<Eigen::VectorXd> w)
  {
    // A Givens rotation of column k of L and w makes the k-th entry of w zero,
    // and leaves LL' + ww' as it is. hypot() does not overflow.
    for (unsigned int k = first; k < n; ++k)
      {
        double      &diagonal = factor(k, k);
        const double entry    = w(k - first);
        const double r        = std::hypot(diagonal, entry);
        const double c        = r / diagonal;
        const double s        = entry / diagonal;
        diagonal              = r;

        const unsigned int rest   = n - k - 1;
        auto               column = factor.col(k).segment(k + 1, rest);
        auto               tail   = w.tail(rest);
        column                    = (column + s * tail) / c;
        tail                      = c * tail - s * column;
      }
  }



  double
  UpdatableCholesky::downdate(const Eigen::Ref<const Eigen::VectorXd> &w,
                              const double tolerance)
  {
    // Golub and Van Loan, Section 6.5.4: rotate (p, rho), with L p = w and
    // rho^2 = 1 - |p|^2, onto the last unit vector; the same rotations take L
    // to the new factor. rho^2 is also the ratio of the determinants of K - w
    // w' and K, and is 1 - w' K^{-1} w. It decides before anything is changed,
    // so that K - w w' which is not safely definite leaves the factor as it
    // was.
    Eigen::VectorXd p = w;
    factor.topLeftCorner(n, n).triangularView<Eigen::Lower>().solveInPlace(p);

    const double independent = 1. - p.squaredNorm();
    if (!(independent > tolerance))
      return independent;

    double          rho   = std::sqrt(independent);
    Eigen::VectorXd carry = Eigen::VectorXd::Zero(n);
    for (unsigned int k = n; k-- > 0;)
      {
        const double r = std::hypot(rho, p(k));
        const double c = rho / r;
        const double s = p(k) / r;
        rho            = r;

        for (unsigned int i = k; i < n; ++i)
          {
            const double l = factor(i, k);
            const double h = carry(i);
            carry(i)       = c * h + s * l;
            factor(i, k)   = c * l - s * h;
          }
      }
    return independent;
  }



  void
  UpdatableCholesky::solve_in_place(Eigen::Ref<Eigen::VectorXd> b) const
  {
    const auto L = factor.topLeftCorner(n, n).triangularView<Eigen::Lower>();
    L.solveInPlace(b);
    L.transpose().solveInPlace(b);
  }



  DenseCholesky::DenseCholesky(Eigen::MatrixXd A)
    : factor(std::move(A))
    , exists(factorise(factor))
  {}



  void
  DenseCholesky::solve_in_place(Eigen::VectorXd &b) const
  {
    const LapackInteger n       = static_cast<LapackInteger>(factor.rows());
    const LapackInteger lda     = leading_dimension(factor);
    const LapackInteger columns = 1;
    LapackInteger       info;
    dealii::potrs(
      "L", &n, &columns, factor.data(), &lda, b.data(), &lda, &info);
    AssertThrow(info == 0, dealii::ExcInternalError());
  }



  Eigen::MatrixXd
  DenseCholesky::inverse() const
  {
    const LapackInteger n      = static_cast<LapackInteger>(factor.rows());
    const LapackInteger lda    = leading_dimension(factor);
    Eigen::MatrixXd     result = factor;
    LapackInteger       info;
    dealii::potri("L", &n, result.data(), &lda, &info);
    AssertThrow(info == 0, dealii::ExcInternalError());
    // LAPACK sets the lower triangle only.
    result.triangularView<Eigen::StrictlyUpper>() = result.transpose();
    return result;
  }
} // namespace Debond
