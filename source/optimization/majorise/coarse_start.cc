// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/full_matrix.h>

#include <debond/linear_algebra/product.h>
#include <debond/optimization/majorise/coarse_start.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/optimization/majorise/restricted_function.h>

#include <algorithm>

namespace Debond
{
  namespace
  {
    dealii::FullMatrix<double>
    galerkin_product(const dealii::FullMatrix<double>  &S,
                     const Eigen::SparseMatrix<double> &P)
    {
      const Eigen::MatrixXd coarse = P.transpose() * (eigen_view(S) * P).eval();
      dealii::FullMatrix<double> result(P.cols(), P.cols());
      for (unsigned int i = 0; i < result.m(); ++i)
        for (unsigned int j = 0; j < result.n(); ++j)
          result(i, j) = 0.5 * (coarse(i, j) + coarse(j, i));
      return result;
    }



    using Level = std::vector<Eigen::SparseMatrix<double>>::const_iterator;

    dealii::Vector<double>
    start_on_level(const dealii::FullMatrix<double> &S,
                   const dealii::Vector<double>     &g,
                   const PiecewiseQuadratic         &phi,
                   const Level                       level,
                   const Level                       end,
                   const MajoriseMinimise           &method,
                   std::vector<std::string>         &failures,
                   const MajoriseMinimise::Monitor  &monitor,
                   const CoarseVisitor              &on_coarsest)
    {
      if (level == end)
        return dealii::Vector<double>(g.size());

      const Eigen::SparseMatrix<double> &P        = *level;
      const dealii::FullMatrix<double>   coarse_S = galerkin_product(S, P);
      const dealii::Vector<double>       coarse_g = product(P.transpose(), g);
      const RestrictedFunction           coarse_phi(phi, P);

      dealii::Vector<double>       s = start_on_level(coarse_S,
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
      return product(P, s);
    }
  } // namespace



  dealii::Vector<double>
  coarse_start(const dealii::FullMatrix<double>               &S,
               const dealii::Vector<double>                   &g,
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
