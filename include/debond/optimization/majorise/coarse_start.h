// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_majorise_coarse_start_h
#define debond_optimization_majorise_coarse_start_h

#include <debond/optimization/majorise/bound_qp.h>
#include <debond/optimization/majorise/majorise_minimise.h>
#include <debond/optimization/piecewise_quadratic.h>

namespace Debond
{
  /**
   * Where bounds of min 1/2 x'(S + E)x - r'x, x <= upper, may be active: the
   * problem is solved on subspaces x = P_1 ... P_k x_k, coarsest first, each
   * minimum, after a projected Gauss-Seidel sweep on the next finer space,
   * being where that one's active set starts (nested iteration). From there
   * solve_bound_qp() mostly needs one system, where from afar it needs the more
   * the more unknowns there are (10 for 639 contact nodes).
   */
  class ActiveSetGuess
  {
  public:
    /// Knows nothing.
    ActiveSetGuess() = default;

    /// @p prolongations as for coarse_start(): finest first, entries >= 0.
    ActiveSetGuess(
      const MatrixView                               &S,
      const std::vector<Eigen::SparseMatrix<double>> &prolongations);

    /// Returns whether there are no subspaces.
    bool
    empty() const
    {
      return levels.empty();
    }

    /// For @p M = S + E.
    ActiveSet
    active_set(const Eigen::MatrixXd             &M,
               const Eigen::SparseMatrix<double> &E,
               const Eigen::VectorXd             &r,
               const Eigen::VectorXd             &upper) const
    {
      return active_set(0, M, E, r, upper);
    }

  private:
    struct Level
    {
      Eigen::SparseMatrix<double> P; ///< to the next finer one
      Eigen::MatrixXd             S;
    };

    ActiveSet
    active_set(const unsigned int                 level,
               const Eigen::MatrixXd             &M,
               const Eigen::SparseMatrix<double> &E,
               const Eigen::VectorXd             &r,
               const Eigen::VectorXd             &upper) const;

    std::vector<Level> levels;
  };



  /// Bounds of s_k with which P s_k <= @p upper, for a P with entries >= 0 and
  /// sums of rows of at most 1, as of interpolation: the least of the bounds
  /// that an entry of s_k has a part in.
  Eigen::VectorXd
  coarse_bounds(const Eigen::SparseMatrix<double> &P,
                const Eigen::VectorXd             &upper);



  /// Gets the problem of a level and its point.
  using CoarseVisitor =
    std::function<void(const PiecewiseProblem &problem, Eigen::VectorXd &s)>;



  /**
   * A starting point for a problem from its minimum over the subspaces s = P_1
   * P_2 ... P_k s_k, coarsest first, from rest, and each minimum being the
   * start of the next finer one (nested iteration). The prolongations, finest
   * first, must have entries >= 0, so that a point within coarse_bounds() is
   * within the bounds.
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
