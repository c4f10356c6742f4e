// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/global/separable_branches.h>

#include <algorithm>

namespace Debond
{
  BranchState
  SeparableBranches::state(const VectorView &s) const
  {
    BranchState result(s.size());
    for (unsigned int i = 0; i < s.size(); ++i)
      result[i] = f[i].index(s(i));
    return result;
  }



  double
  SeparableBranches::change(const VectorView &s) const
  {
    double sum = 0.;
    for (unsigned int i = 0; i < s.size(); ++i)
      sum += f[i].value(s(i));
    return sum;
  }



  Eigen::VectorXd
  SeparableBranches::subgradient(const VectorView &s) const
  {
    Eigen::VectorXd xi(s.size());
    for (unsigned int i = 0; i < s.size(); ++i)
      xi(i) = f[i][f[i].index(s(i))].derivative(s(i));
    return xi;
  }



  Eigen::SparseMatrix<double>
  SeparableBranches::curvature(const VectorView &s) const
  {
    Eigen::SparseMatrix<double> result(s.size(), s.size());
    for (unsigned int i = 0; i < s.size(); ++i)
      if (const double c = f[i].majorant_curvature(s(i)); c != 0.)
        result.insert(i, i) = c;
    return result;
  }



  bool
  SeparableBranches::softens() const
  {
    return std::any_of(f.begin(), f.end(), [](const PiecewiseEnergy &f_i) {
      return f_i.softens();
    });
  }



  bool
  SeparableBranches::is_piecewise_quadratic() const
  {
    return std::all_of(f.begin(), f.end(), [](const PiecewiseEnergy &f_i) {
      return f_i.is_piecewise_quadratic();
    });
  }



  Eigen::SparseMatrix<double>
  SeparableBranches::second_derivative(const VectorView &s) const
  {
    Eigen::SparseMatrix<double> result(s.size(), s.size());
    for (unsigned int i = 0; i < s.size(); ++i)
      result.insert(i, i) = f[i][f[i].index(s(i))].second_derivative(s(i));
    return result;
  }



  double
  SeparableBranches::first_change(const VectorView &s,
                                  const VectorView &ds,
                                  const double      limit) const
  {
    double first = limit;
    for (unsigned int i = 0; i < s.size(); ++i)
      first = std::min(first, f[i][f[i].index(s(i))].way_to_end(s(i), ds(i)));
    return first;
  }



  double
  SeparableBranches::largest_value() const
  {
    double sum = 0.;
    for (const PiecewiseEnergy &f_i : f)
      sum += f_i.largest_value();
    return sum;
  }
} // namespace Debond
