// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_majorise_bound_qp_h
#define debond_optimization_majorise_bound_qp_h

#include <debond/linear_algebra/bordered_cholesky.h>
#include <debond/optimization/status.h>

#include <limits>

namespace Debond
{
  /// Factorisations after which a solver gives up.
  constexpr unsigned int maximum_active_set_steps = 10000;

  /// Which bounds are active, by index.
  using ActiveSet = std::vector<char>;



  /**
   * The rule by which active-set methods for x <= b go on: bounds that are
   * exceeded enter, those with a negative multiplier leave, all at once as in
   * the primal-dual active set method (Hintermueller, Ito, Kunisch, SIAM J.
   * Optim. 13, 2002). Once the number of wrong indices has not fallen for long,
   * only the first of them changes, which ends after finitely many steps for
   * positive definite matrices (Murty, Math. Programming 7, 1974).
   */
  class ActiveSetRule
  {
  public:
    /// @p excess is x - b outside the active set, @p mu the multipliers in it;
    /// a sign counts only beyond @p excess_noise and @p mu_noise. Returns the
    /// number of wrong indices.
    unsigned int
    update(const Eigen::VectorXd &excess,
           const Eigen::VectorXd &mu,
           const double           excess_noise,
           const double           mu_noise,
           ActiveSet             &active);

    /// Returns whether the number of wrong indices has not fallen for long.
    bool
    wanders() const;

  private:
    std::size_t  fewest = std::numeric_limits<std::size_t>::max();
    unsigned int idle   = 0; ///< updates since there were fewer
  };



  struct BoundQPResult
  {
    /// success, stagnated, interrupted, or quadratic_program if there is no
    /// minimum or it was not found.
    SolverStatus status = SolverStatus::quadratic_program;
    unsigned int steps  = 0; ///< solutions on a set

    /// The cost in multiplications with an addition each: the same on every
    /// machine.
    double operations = 0.;

    Eigen::VectorXd x;
    Eigen::VectorXd mu; ///< multipliers, zero where inactive
  };



  /**
   * min 1/2 x'M x - r'x subject to x <= b for a dense symmetric positive
   * definite M, started at @p active, which is updated. Each step solves on
   * the free components with a Cholesky factorisation, or by that of a step
   * before. A @p factor can be handed on from problem to problem, whose
   * matrices may differ in few rows.
   *
   * Wrong indices are exchanged by ActiveSetRule. Matrices of slender bodies,
   * where fourth derivatives count, can make that wander; then projected Newton
   * steps take over (Bertsekas, SIAM J. Control Optim. 20, 1982), with which
   * the functional falls until rounding hides it. Then the status is stagnated.
   *
   * With a @p tolerance above zero the exchanges end as soon as the projection
   * onto x <= b meets the optimality conditions to this part of the largest
   * |r_i|: on slender bodies the last exchanges are many and move little.
   */
  BoundQPResult
  solve_bound_qp(const Eigen::Ref<const Eigen::MatrixXd> &M,
                 const Eigen::VectorXd                   &r,
                 const Eigen::VectorXd                   &b,
                 ActiveSet                               &active,
                 const double                             tolerance = 0.,
                 BorderedCholesky                        *factor    = nullptr);
} // namespace Debond

#endif
