// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_dof_vector_h
#define debond_linear_algebra_dof_vector_h

#include <deal.II/lac/vector.h>

#include <Eigen/Core>

namespace Debond
{
  /// An entry for each degree of freedom: displacements u, loads f, residuals;
  /// and what bundle methods minimise over.
  /// What has an entry for each contact node is an Eigen vector.
  using DofVector = dealii::Vector<double>;



  /// A view of the vector of a bundle method, valid as long as it.
  inline Eigen::Map<const Eigen::VectorXd>
  eigen_view(const dealii::Vector<double> &vector)
  {
    return {vector.begin(), static_cast<Eigen::Index>(vector.size())};
  }
} // namespace Debond

#endif
