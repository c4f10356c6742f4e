// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/global/separable_bonds.h>

#include <algorithm>
#include <cmath>

namespace Debond
{
  SeparableBonds::SeparableBonds(const Eigen::VectorXd &stiffness,
                                 const double           threshold)
    : stiffness(stiffness)
    , threshold(threshold)
  {}



  double
  SeparableBonds::value(const dealii::Vector<double> &s) const
  {
    double sum = 0.;
    for (unsigned int i = 0; i < s.size(); ++i)
      sum +=
        0.5 * stiffness(i) * std::pow(std::min(std::abs(s(i)), threshold), 2);
    return sum;
  }



  void
  SeparableBonds::subgradient(const dealii::Vector<double> &s,
                              dealii::Vector<double>       &xi) const
  {
    for (unsigned int i = 0; i < s.size(); ++i)
      xi(i) = s(i) < -threshold ? 0. : stiffness(i) * s(i);
  }



  Eigen::SparseMatrix<double>
  SeparableBonds::curvature(const dealii::Vector<double> &s) const
  {
    Eigen::SparseMatrix<double> result(s.size(), s.size());
    for (unsigned int i = 0; i < s.size(); ++i)
      if (s(i) >= -threshold)
        result.insert(i, i) = stiffness(i);
    return result;
  }
} // namespace Debond
