// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_product_h
#define debond_linear_algebra_product_h

#include <debond/linear_algebra/eigen_view.h>

#include <algorithm>

namespace Debond
{
  /// The product of one of Eigen's matrices, or its transpose, with a vector of
  /// deal.II's.
  template <typename MatrixType>
  dealii::Vector<double>
  product(const MatrixType &matrix, const dealii::Vector<double> &v)
  {
    const Eigen::VectorXd  values = matrix * eigen_view(v);
    dealii::Vector<double> result(static_cast<unsigned int>(values.size()));
    std::copy(values.begin(), values.end(), result.begin());
    return result;
  }
} // namespace Debond

#endif
