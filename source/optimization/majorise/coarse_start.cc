// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/majorise/coarse_start.h>
#include <debond/optimization/majorise/condensed_problem.h>

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



  namespace
  {
    Eigen::MatrixXd
    galerkin_product(const MatrixView &S, const Eigen::SparseMatrix<double> &P)
    {
      const Eigen::MatrixXd coarse = P.transpose() * (S * P).eval();
      return 0.5 * (coarse + coarse.transpose());
    }



    using Level = std::vector<Eigen::SparseMatrix<double>>::const_iterator;

    Eigen::VectorXd
    start_on_level(const MatrixView                &S,
                   const VectorView                &g,
                   const PiecewiseQuadratic        &phi,
                   const Level                      level,
                   const Level                      end,
                   const MajoriseMinimise          &method,
                   std::vector<std::string>        &failures,
                   const MajoriseMinimise::Monitor &monitor,
                   const CoarseVisitor             &on_coarsest)
    {
      if (level == end)
        return Eigen::VectorXd::Zero(g.size());

      const Eigen::SparseMatrix<double> &P        = *level;
      const Eigen::MatrixXd              coarse_S = galerkin_product(S, P);
      const Eigen::VectorXd              coarse_g = P.transpose() * g;
      const RestrictedFunction           coarse_phi(phi, P);

      Eigen::VectorXd              s = start_on_level(coarse_S,
                                         coarse_g,
                                         coarse_phi,
                                         level + 1,
                                         end,
                                         method,
                                         failures,
                                         monitor,
                                         on_coarsest);
      CondensedProblem             problem(coarse_S, coarse_g, coarse_phi, s);
      const MajoriseMinimiseResult result = method.minimize(problem, monitor);
      if (!can_be_verified(result.status))
        failures.push_back("start on " + std::to_string(s.size()) +
                           " of the contact nodes: " + result.message);
      if (on_coarsest && level + 1 == end)
        on_coarsest(coarse_S, coarse_g, coarse_phi, s);
      return P * s;
    }
  } // namespace



  Eigen::VectorXd
  coarse_start(const MatrixView                               &S,
               const VectorView                               &g,
               const PiecewiseQuadratic                       &phi,
               const std::vector<Eigen::SparseMatrix<double>> &prolongations,
               const MajoriseMinimise                         &method,
               std::vector<std::string>                       &failures,
               const MajoriseMinimise::Monitor                &monitor,
               const CoarseVisitor                            &on_coarsest)
  {
    return start_on_level(S,
                          g,
                          phi,
                          prolongations.begin(),
                          prolongations.end(),
                          method,
                          failures,
                          monitor,
                          on_coarsest);
  }
} // namespace Debond
