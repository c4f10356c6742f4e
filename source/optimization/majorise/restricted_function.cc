// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/linear_algebra/eigen_view.h>
#include <debond/optimization/majorise/restricted_function.h>

#include <algorithm>

namespace Debond
{
  namespace
  {
    template <typename MatrixType>
    dealii::Vector<double>
    product(const MatrixType &matrix, const dealii::Vector<double> &v)
    {
      const Eigen::VectorXd  values = matrix * eigen_view(v);
      dealii::Vector<double> result(static_cast<unsigned int>(values.size()));
      std::copy(values.begin(), values.end(), result.begin());
      return result;
    }
  } // namespace



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
