// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_eigen_view_h
#define debond_linear_algebra_eigen_view_h

#include <deal.II/lac/vector.h>

#include <Eigen/Core>

namespace Debond
{
  /// A view of the vector of a bundle method, valid as long as it.
  inline Eigen::Map<const Eigen::VectorXd>
  eigen_view(const dealii::Vector<double> &vector)
  {
    return {vector.begin(), static_cast<Eigen::Index>(vector.size())};
  }
} // namespace Debond

#endif
