// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/majorise/active_set_guess.h>

#include <algorithm>

namespace Debond
{
  ActiveSetGuess::ActiveSetGuess(
    const MatrixView                               &S,
    const std::vector<Eigen::SparseMatrix<double>> &prolongations)
  {
    for (const Eigen::SparseMatrix<double> &P : prolongations)
      {
        Eigen::MatrixXd S_P;
        if (levels.empty())
          S_P = S * P;
        else
          S_P = levels.back().S * P;
        levels.push_back({P, P.transpose() * S_P});
      }
  }



  ActiveSet
  ActiveSetGuess::active_set(const unsigned int                 level,
                             const Eigen::MatrixXd             &M,
                             const Eigen::SparseMatrix<double> &E,
                             const Eigen::VectorXd             &r) const
  {
    ActiveSet active(r.size(), 0);
    if (level == levels.size())
      return active;

    const Eigen::SparseMatrix<double> &P = levels[level].P;
    const Eigen::SparseMatrix<double>  coarse_E =
      P.transpose() * Eigen::SparseMatrix<double>(E * P);
    const Eigen::VectorXd coarse_r = P.transpose() * r;
    Eigen::MatrixXd       coarse_M = levels[level].S;
    coarse_M += coarse_E;
    ActiveSet coarse_active =
      active_set(level + 1, coarse_M, coarse_E, coarse_r);
    Eigen::VectorXd x =
      P * solve_bound_qp(coarse_M,
                         coarse_r,
                         Eigen::VectorXd::Zero(coarse_r.size()),
                         coarse_active)
            .x;
    for (Eigen::Index i = 0; i < x.size(); ++i)
      {
        x(i)      = std::min(x(i) + (r(i) - M.col(i).dot(x)) / M(i, i), 0.);
        active[i] = x(i) == 0.;
      }
    return active;
  }
} // namespace Debond
