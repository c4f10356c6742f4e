// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/global/separable_energy.h>

#include <algorithm>

namespace Debond
{
  PieceState
  SeparableEnergy::state(const VectorView &s) const
  {
    PieceState result(s.size());
    for (unsigned int i = 0; i < s.size(); ++i)
      result[i] = piece(i, s).number;
    return result;
  }



  double
  SeparableEnergy::change(const VectorView &s) const
  {
    // With nodal quadrature Phi is a sum of functions of one component each, so
    // that pieces, derivatives and bounds are those of single bonds.
    double sum = 0.;
    for (unsigned int i = 0; i < s.size(); ++i)
      sum += piece(i, s).value(s(i));
    return sum;
  }



  Eigen::VectorXd
  SeparableEnergy::subgradient(const VectorView &s) const
  {
    Eigen::VectorXd xi(s.size());
    for (unsigned int i = 0; i < s.size(); ++i)
      xi(i) = piece(i, s).derivative(s(i));
    return xi;
  }



  Eigen::SparseMatrix<double>
  SeparableEnergy::curvature(const VectorView &s) const
  {
    // Entries that are zero are left out, as broken bonds are many and products
    // with them take time.
    Eigen::SparseMatrix<double> result(s.size(), s.size());
    for (unsigned int i = 0; i < s.size(); ++i)
      if (const double c = f[i].majorant_curvature(s(i)); c != 0.)
        result.insert(i, i) = c;
    return result;
  }



  bool
  SeparableEnergy::softens() const
  {
    return std::any_of(f.begin(), f.end(), [](const PiecewiseEnergy &f_i) {
      return f_i.softens();
    });
  }



  bool
  SeparableEnergy::is_piecewise_quadratic() const
  {
    return std::all_of(f.begin(), f.end(), [](const PiecewiseEnergy &f_i) {
      return f_i.is_piecewise_quadratic();
    });
  }



  Eigen::SparseMatrix<double>
  SeparableEnergy::second_derivative(const VectorView &s) const
  {
    Eigen::SparseMatrix<double> result(s.size(), s.size());
    for (unsigned int i = 0; i < s.size(); ++i)
      result.insert(i, i) = piece(i, s).second_derivative(s(i));
    return result;
  }



  double
  SeparableEnergy::first_change(const VectorView &s,
                                const VectorView &ds,
                                const double      limit) const
  {
    double first = limit;
    for (unsigned int i = 0; i < s.size(); ++i)
      first = std::min(first, piece(i, s).way_to_end(s(i), ds(i)));
    return first;
  }



  double
  SeparableEnergy::largest_value() const
  {
    double sum = 0.;
    for (const PiecewiseEnergy &f_i : f)
      sum += f_i.largest_value();
    return sum;
  }
} // namespace Debond
