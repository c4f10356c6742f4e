// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/majorise/restricted_function.h>

namespace Debond
{
  RestrictedFunction::RestrictedFunction(
    const PiecewiseQuadratic          &fine_function,
    const Eigen::SparseMatrix<double> &prolongation)
    : phi(fine_function)
    , P(prolongation)
  {}



  Eigen::VectorXd
  RestrictedFunction::subgradient(const VectorView &s) const
  {
    return P.transpose() * phi.subgradient(P * s);
  }



  Eigen::SparseMatrix<double>
  RestrictedFunction::curvature(const VectorView &s) const
  {
    return P.transpose() * phi.curvature(P * s) * P;
  }
} // namespace Debond
