// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/linear_algebra/product.h>
#include <debond/optimization/majorise/restricted_function.h>

namespace Debond
{
  RestrictedFunction::RestrictedFunction(
    const PiecewiseQuadratic          &fine_function,
    const Eigen::SparseMatrix<double> &prolongation)
    : phi(fine_function)
    , P(prolongation)
  {}



  double
  RestrictedFunction::value(const dealii::Vector<double> &s) const
  {
    return phi.value(product(P, s));
  }



  void
  RestrictedFunction::subgradient(const dealii::Vector<double> &s,
                                  dealii::Vector<double>       &xi) const
  {
    dealii::Vector<double> fine(static_cast<unsigned int>(P.rows()));
    phi.subgradient(product(P, s), fine);
    xi = product(P.transpose(), fine);
  }



  Eigen::SparseMatrix<double>
  RestrictedFunction::curvature(const dealii::Vector<double> &s) const
  {
    return P.transpose() * phi.curvature(product(P, s)) * P;
  }
} // namespace Debond
