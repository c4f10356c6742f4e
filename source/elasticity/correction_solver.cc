// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/exceptions.h>

#include <debond/elasticity/correction_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Debond
{
  CondensedCorrection::CondensedCorrection(
    const Condensation &condensed_problem)
    : condensed(condensed_problem)
  {}



  void
  CondensedCorrection::prepare(const Eigen::SparseMatrix<double> &E,
                               const ActiveSet                   &held)
  {
    free.clear();
    std::vector<unsigned int> place(held.size());
    for (unsigned int i = 0; i < held.size(); ++i)
      if (held[i] == 0)
        {
          place[i] = static_cast<unsigned int>(free.size());
          free.push_back(i);
        }
    if (free.empty())
      return;

    const MatrixView   S = condensed.schur_complement();
    const unsigned int n = static_cast<unsigned int>(free.size());
    // Where rounding has made S + E indefinite a larger diagonal mends it.
    for (double shift = 0.; shift < 1e-3;
         shift = std::max(10. * shift, std::numeric_limits<double>::epsilon()))
      {
        factor.reinit(n);
        for (unsigned int k = 0; k < n; ++k)
          for (unsigned int l = 0; l < n; ++l)
            factor(k, l) = S(free[k], free[l]);
        for (int j = 0; j < E.outerSize(); ++j)
          for (Eigen::SparseMatrix<double>::InnerIterator entry(E, j); entry;
               ++entry)
            if (held[j] == 0 && held[entry.row()] == 0)
              factor(place[entry.row()], place[j]) += entry.value();
        for (unsigned int k = 0; k < n; ++k)
          factor(k, k) *= 1. + shift;
        factor.set_property(dealii::LAPACKSupport::symmetric);
        try
          {
            factor.compute_cholesky_factorization();
            return;
          }
        catch (const dealii::LACExceptions::ExcSingular &)
          {}
      }
    // Any positive definite matrix is a preconditioner.
    factor.reinit(n);
    for (unsigned int k = 0; k < n; ++k)
      factor(k, k) = std::abs(S(free[k], free[k]));
    factor.set_property(dealii::LAPACKSupport::symmetric);
    factor.compute_cholesky_factorization();
  }



  DofVector
  CondensedCorrection::solve(const DofVector &r) const
  {
    return condensed.solve(r, [this](const Eigen::VectorXd &g) {
      Eigen::VectorXd s = Eigen::VectorXd::Zero(g.size());
      if (free.empty())
        return s;
      dealii::Vector<double> s_free(static_cast<unsigned int>(free.size()));
      for (unsigned int k = 0; k < free.size(); ++k)
        s_free(k) = g(free[k]);
      factor.solve(s_free);
      for (unsigned int k = 0; k < free.size(); ++k)
        s(free[k]) = s_free(k);
      return s;
    });
  }
} // namespace Debond
