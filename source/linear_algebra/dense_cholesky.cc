// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/exceptions.h>
#include <deal.II/lac/lapack_templates.h>

#include <debond/linear_algebra/dense_cholesky.h>

#include <algorithm>
#include <utility>

namespace Debond
{
  namespace
  {
    using LapackInteger = dealii::types::blas_int;

    /// Not zero, as LAPACK wants it.
    LapackInteger
    leading_dimension(const Eigen::MatrixXd &A)
    {
      return static_cast<LapackInteger>(std::max<Eigen::Index>(1, A.rows()));
    }
  } // namespace



  DenseCholesky::DenseCholesky(Eigen::MatrixXd A)
    : factor(std::move(A))
  {
    const LapackInteger n   = static_cast<LapackInteger>(factor.rows());
    const LapackInteger lda = leading_dimension(factor);
    LapackInteger       info;
    dealii::potrf("L", &n, factor.data(), &lda, &info);
    AssertThrow(info >= 0, dealii::ExcInternalError());
    exists = info == 0;
  }



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
    result.triangularView<Eigen::StrictlyUpper>() = result.transpose();
    return result;
  }
} // namespace Debond
