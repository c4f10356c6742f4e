// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/majorise/condensed_problem.h>

namespace Debond
{
  Eigen::VectorXd
  coarse_bounds(const Eigen::SparseMatrix<double> &P,
                const Eigen::VectorXd             &upper)
  {
    // Values on the fine nodes are means of coarse ones with weights that are
    // not negative. So if a coarse value is at most the least bound of the
    // nodes that it has a part in, all fine values keep their bounds.
    Eigen::VectorXd result = Eigen::VectorXd::Constant(P.cols(), infinity);
    for (Eigen::Index k = 0; k < P.cols(); ++k)
      for (Eigen::SparseMatrix<double>::InnerIterator entry(P, k); entry;
           ++entry)
        result(k) = std::min(result(k), upper(entry.row()));
    return result;
  }



  ActiveSetGuess::ActiveSetGuess(
    const MatrixView                               &S,
    const std::vector<Eigen::SparseMatrix<double>> &prolongations)
  {
    // The matrices P'S P of all subspaces are made once, as S is that of all
    // majorants to come.
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
                             const Eigen::VectorXd             &r,
                             const Eigen::VectorXd             &upper) const
  {
    // On the coarsest space all bounds start inactive: with few unknowns any
    // start will do.
    ActiveSet active(r.size(), 0);
    if (level == levels.size())
      return active;

    // The problem of the next coarser space is that of x = P y: Galerkin
    // products of S and E, and P'r. Its own active set is guessed in the same
    // way first, so that each space has an active set that is nearly right.
    const Eigen::SparseMatrix<double> &P = levels[level].P;
    const Eigen::SparseMatrix<double>  coarse_E =
      P.transpose() * Eigen::SparseMatrix<double>(E * P);
    const Eigen::VectorXd coarse_r = P.transpose() * r;
    Eigen::MatrixXd       coarse_M = levels[level].S;
    coarse_M += coarse_E;
    const Eigen::VectorXd coarse_upper = coarse_bounds(P, upper);
    ActiveSet             coarse_active =
      active_set(level + 1, coarse_M, coarse_E, coarse_r, coarse_upper);
    Eigen::VectorXd x =
      P * solve_bound_qp(coarse_M, coarse_r, coarse_upper, coarse_active).x;
    for (Eigen::Index i = 0; i < x.size(); ++i)
      {
        // The projected Gauss-Seidel sweep. What the coarse point has inside
        // the contact zone is at its bounds already; the sweep puts right the
        // rim, which coarse functions blur.
        x(i) = std::min(x(i) + (r(i) - M.col(i).dot(x)) / M(i, i), upper(i));
        active[i] = x(i) == upper(i);
      }
    return active;
  }



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
    // The functional on the subspace s = P y is J itself, not an approximation
    // of it: the law stays at the points of the finest boundary, at the s that
    // y stands for. S is symmetric to the last digit, as factorisations read
    // one triangle and products both.
    const Eigen::MatrixXd    product = P.transpose() * (problem.S * P).eval();
    const Eigen::MatrixXd    S       = 0.5 * (product + product.transpose());
    const Eigen::VectorXd    g       = P.transpose() * problem.g;
    const RestrictedFunction phi(problem.phi, P);
    const PiecewiseProblem   coarse = {
        S, g, coarse_bounds(P, problem.upper), phi, problem.interruption};

    // From the coarsest space to this one, each begins at the minimum of the
    // one before. Dense factorisations take the third power of the number of
    // nodes, so with half the nodes a space costs an eighth, and most steps are
    // made where they are cheap.
    const std::vector<Eigen::SparseMatrix<double>> coarser(
      prolongations.begin() + 1, prolongations.end());
    Eigen::VectorXd s =
      coarse_start(coarse, coarser, method, failures, on_coarsest);
    CondensedProblem             condensed(coarse, s);
    const MajoriseMinimiseResult result =
      method.minimize(condensed, [&](const auto &) {
        return !problem.interruption.requested();
      });
    // A start that is no minimum is as good as any other start; it is only
    // told.
    if (!can_be_verified(result.status))
      failures.push_back("start on " + std::to_string(s.size()) +
                         " of the contact nodes: " + result.message);
    if (on_coarsest && coarser.empty())
      on_coarsest(coarse, s);
    return P * s;
  }
} // namespace Debond
