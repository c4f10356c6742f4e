// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/global/separable_energy.h>

namespace Debond
{
  Eigen::VectorXd
  SeparableEnergy::displacements(const VectorView &s) const
  {
    if (bonds.empty())
      return s;
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(f.size());
    for (unsigned int j = 0; j < s.size(); ++j)
      squares(bonds[j]) += weights(j) * s(j) * s(j);
    return -squares.cwiseSqrt();
  }



  void
  SeparableEnergy::set_displacement(const unsigned int i,
                                    const double       displacement,
                                    Eigen::VectorXd   &s) const
  {
    if (bonds.empty())
      {
        s(i) = displacement;
        return;
      }
    // A bond that is stretched keeps the direction of its jump; one at rest has
    // none.
    const double before  = displacements(s)(i);
    bool         is_done = false;
    for (unsigned int j = 0; j < s.size(); ++j)
      if (bonds[j] == i)
        {
          if (before < 0.)
            s(j) *= displacement / before;
          else
            s(j) = is_done ? 0. : displacement / std::sqrt(weights(j));
          is_done = true;
        }
  }



  PieceState
  SeparableEnergy::state(const VectorView &s) const
  {
    const Eigen::VectorXd l = displacements(s);
    PieceState            result(l.size());
    for (unsigned int i = 0; i < l.size(); ++i)
      result[i] = piece(i, l).number + f[i].n_left();
    return result;
  }



  double
  SeparableEnergy::change(const VectorView &s) const
  {
    // With nodal quadrature Phi is a sum of functions of one component each, so
    // that pieces, derivatives and bounds are those of single bonds.
    const Eigen::VectorXd l   = displacements(s);
    double                sum = 0.;
    for (unsigned int i = 0; i < l.size(); ++i)
      sum += piece(i, l).value(l(i));
    return sum + friction.value(s);
  }



  Eigen::VectorXd
  SeparableEnergy::subgradient(const VectorView &s) const
  {
    // Pieces that are quadratic in all unknowns of a bond have no linear terms.
    if (!bonds.empty())
      return curvature(s) * s;
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
    const Eigen::VectorXd       l = displacements(s);
    Eigen::SparseMatrix<double> result(s.size(), s.size());
    for (unsigned int j = 0; j < s.size(); ++j)
      {
        const unsigned int i = bonds.empty() ? j : bonds[j];
        if (const double c = f[i].majorant_curvature(l(i)); c != 0.)
          result.insert(j, j) = bonds.empty() ? c : c * weights(j);
      }
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
    // With a slope a piece is no quadratic in the unknowns of a bond, of which
    // that displacement is a square root.
    return std::all_of(f.begin(), f.end(), [&](const PiecewiseEnergy &f_i) {
      const bool is_spring = f_i.size() <= 2 && f_i[0].slope == 0. &&
                             (f_i.size() == 1 || f_i[1].is_flat());
      return f_i.is_piecewise_quadratic() && (bonds.empty() || is_spring);
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
