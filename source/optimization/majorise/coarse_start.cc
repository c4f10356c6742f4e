// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/majorise/coarse_start.h>
#include <debond/optimization/majorise/condensed_problem.h>

namespace Debond
{
  Eigen::VectorXd
  coarse_start(const PiecewiseProblem                         &problem,
               const std::vector<Eigen::SparseMatrix<double>> &prolongations,
               const MajoriseMinimise                         &method,
               std::vector<std::string>                       &failures,
               const CoarseVisitor                            &on_coarsest)
  {
    if (prolongations.empty())
      return Eigen::VectorXd::Zero(problem.g.size());

    const Eigen::SparseMatrix<double> &P = prolongations.front();
    const Eigen::MatrixXd    product = P.transpose() * (problem.S * P).eval();
    const Eigen::MatrixXd    S       = 0.5 * (product + product.transpose());
    const Eigen::VectorXd    g       = P.transpose() * problem.g;
    const RestrictedFunction phi(problem.phi, P);
    const PiecewiseProblem   coarse = {S, g, phi, problem.may_go_on};

    const std::vector<Eigen::SparseMatrix<double>> coarser(
      prolongations.begin() + 1, prolongations.end());
    Eigen::VectorXd s =
      coarse_start(coarse, coarser, method, failures, on_coarsest);
    CondensedProblem             condensed(S, g, phi, s);
    const MajoriseMinimiseResult result =
      method.minimize(condensed,
                      [&](const auto &) { return problem.may_go_on(); });
    if (!can_be_verified(result.status))
      failures.push_back("start on " + std::to_string(s.size()) +
                         " of the contact nodes: " + result.message);
    if (on_coarsest && coarser.empty())
      on_coarsest(coarse, s);
    return P * s;
  }
} // namespace Debond
