// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_eigen_view_h
#define debond_linear_algebra_eigen_view_h

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <Eigen/Core>

namespace Debond
{
  /// A view of the matrix, whose rows are contiguous; Eigen's own matrices have
  /// contiguous columns. Valid as long as the matrix.
  inline auto
  eigen_view(const dealii::FullMatrix<double> &matrix)
  {
    using RowMajor =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    return Eigen::Map<const RowMajor>(matrix.empty() ? nullptr : &matrix(0, 0),
                                      matrix.m(),
                                      matrix.n());
  }

  /// A view of the vector, valid as long as it.
  inline Eigen::Map<const Eigen::VectorXd>
  eigen_view(const dealii::Vector<double> &vector)
  {
    return {vector.begin(), static_cast<Eigen::Index>(vector.size())};
  }
} // namespace Debond

#endif
