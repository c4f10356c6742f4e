// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_majorise_coarse_start_h
#define debond_optimization_majorise_coarse_start_h

#include <debond/optimization/majorise/majorise_minimise.h>
#include <debond/optimization/piecewise_quadratic.h>

#include <Eigen/SparseCore>

#include <functional>
#include <string>
#include <vector>

namespace Debond
{
  /// Gets the problem of a level and its point.
  using CoarseVisitor =
    std::function<void(const PiecewiseProblem &problem, Eigen::VectorXd &s)>;



  /**
   * A starting point for a problem from its minimum over the subspaces s = P_1
   * P_2 ... P_k s_k, coarsest first, from rest, and each minimum being the
   * start of the next finer one (nested iteration). The prolongations, finest
   * first, must have entries >= 0, so that s_k <= 0 gives s <= 0.
   *
   * A level on which @p method does not converge passes on what it reached, and
   * is named in @p failures. After the coarsest level, @p on_coarsest may
   * change its point.
   */
  Eigen::VectorXd
  coarse_start(const PiecewiseProblem                         &problem,
               const std::vector<Eigen::SparseMatrix<double>> &prolongations,
               const MajoriseMinimise                         &method,
               std::vector<std::string>                       &failures,
               const CoarseVisitor &on_coarsest = {});
} // namespace Debond

#endif
