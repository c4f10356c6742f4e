// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_eigen_view_h
#define debond_linear_algebra_eigen_view_h

#include <deal.II/lac/full_matrix.h>

#include <debond/linear_algebra/dof_vector.h>

#include <Eigen/Core>

namespace Debond
{
  /// A view of a symmetric matrix, valid as long as it. deal.II's matrices have
  /// contiguous rows, Eigen's contiguous columns, so that it is of the
  /// transpose.
  inline Eigen::Map<const Eigen::MatrixXd>
  symmetric_view(const dealii::FullMatrix<double> &matrix)
  {
    return {matrix.empty() ? nullptr : &matrix(0, 0),
            static_cast<Eigen::Index>(matrix.n()),
            static_cast<Eigen::Index>(matrix.m())};
  }

  /// A view of the vector, valid as long as it.
  inline Eigen::Map<const Eigen::VectorXd>
  eigen_view(const DofVector &vector)
  {
    return {vector.begin(), static_cast<Eigen::Index>(vector.size())};
  }

  inline DofVector
  from_eigen(const Eigen::VectorXd &vector)
  {
    return DofVector(vector.begin(), vector.end());
  }
} // namespace Debond

#endif
