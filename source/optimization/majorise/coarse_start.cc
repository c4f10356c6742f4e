// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/majorise/coarse_start.h>
#include <debond/optimization/majorise/condensed_problem.h>

#include <algorithm>

namespace Debond
{
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
