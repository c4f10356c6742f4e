// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_bundle_bundle_qp_h
#define debond_optimization_bundle_bundle_qp_h

#include <debond/linear_algebra/cholesky.h>

#include <string>
#include <vector>

namespace Debond
{
  /**
   * The direction-finding problem of the bundle method (paper, Problem QP),
   *
   *     primal:  min_{d, v}  v + u/2 d'd
   *              subject to  eta_j'd - beta_j <= v   (lambda_j >= 0)
   *                          d_i <= b_i, i in C      (mu_i >= 0)
   *
   *     dual:    max  -1/(2u) |sum_j lambda_j eta_j + mu|^2
   *                   - lambda'beta - mu'b
   *              subject to  lambda >= 0,  sum lambda = 1,  mu >= 0,
   *
   *     d = -1/u (sum_j lambda_j eta_j + mu),
   *
   * by a primal active-set method on the dual problem. The working set holds
   * the cuts W and the bounds B whose multipliers are free. On a working set,
   * mu is eliminated in closed form and lambda solves
   *
   *     H lambda + v 1 = C_B'b_B - beta_W,   1'lambda = 1,
   *     H = 1/u (eta_W'eta_W without the components in B),
   *
   * with a Cholesky factor of H + kappa 1 1' that is updated when a cut or a
   * bound enters or leaves. See Kiwiel, "A method for solving certain
   * quadratic programming problems arising in nonsmooth optimization", IMA J.
   * Numer. Anal. 6 (1986), for the treatment of the cuts alone.
   *
   * The problem is small: the subgradients enter by the Gram matrix of their
   * unbounded components and by their bounded components. The working set
   * and multipliers of one solve() start the next.
   */
  class BundleQP
  {
  public:
    enum class Status
    {
      optimal,
      inaccurate,      ///< the working set is right, but not the residual
      iteration_limit, ///< the working set kept changing
      breakdown        ///< no multiplier blocks a step along a null direction
    };

    struct Solution
    {
      Status          status = Status::optimal;
      unsigned int    steps  = 0; ///< changes of the working set
      Eigen::VectorXd lambda;     ///< for each cut
      Eigen::VectorXd mu;         ///< for each bound
      Eigen::VectorXd d;          ///< the bounded components of d
      Eigen::VectorXd slopes;     ///< eta_j'd for each cut

      /// max_j (eta_j'd - beta_j), the predicted descent v_k.
      double v = 0.;

      /// By how much the primal exceeds the dual objective, so that the exact
      /// predicted descent is not below v - duality_gap.
      double duality_gap = 0.;

      /// @name Residuals from the original data
      /// Relative to the largest of the terms that they are the sum of.
      /// @{
      double stationarity    = 0.; ///< of d on C, and of sum lambda = 1
      double feasibility     = 0.; ///< of d_i <= b_i, and signs of multipliers
      double complementarity = 0.; ///< of lambda and mu with their constraints
      /// @}

      double
      residual() const;
    };

    /// Room for the given number of cuts and bounds; empties the problem.
    BundleQP(const unsigned int maximum_cuts, const unsigned int n_bounds);

    unsigned int
    n_cuts() const
    {
      return m;
    }

    /// Adds a subgradient eta. @p products: its inner products with all
    /// earlier cuts and, last, with itself, over the unbounded components
    /// only; @p bounded: its components in C.
    void
    add_cut(const Eigen::Ref<const Eigen::VectorXd> &products,
            const Eigen::Ref<const Eigen::VectorXd> &bounded);

    /// Removes all cuts. The active bounds are kept for the next start.
    void
    clear();

    /// Solves for the given beta >= 0 (one per cut), b (one per bound) and
    /// u > 0. There must be a cut.
    const Solution &
    solve(const Eigen::Ref<const Eigen::VectorXd> &beta,
          const Eigen::Ref<const Eigen::VectorXd> &b,
          const double                             u);

  private:
    /// lambda of the working set and mu of all bounds, as a point of the dual
    /// problem or as a direction in it.
    struct DualPoint
    {
      Eigen::VectorXd lambda;
      Eigen::VectorXd mu;
    };

    enum class Entering
    {
      nothing,
      cut,
      bound
    };

    void
    run_active_set();
    void
    start();
    void
    factorize();
    double
    h(const unsigned int j, const unsigned int k) const;
    Eigen::VectorXd
    h_times(const Eigen::VectorXd &lambda) const;
    Eigen::VectorXd
    bounded_rows(const unsigned int i) const;
    DualPoint
    maximum_on_working_set();
    bool
    move_towards(const DualPoint &target, const bool direction_only);
    void
    drop_cut(const unsigned int position);
    void
    drop_bound(const unsigned int i);
    bool
    enter_cut(const unsigned int j);
    bool
    enter_bound(const unsigned int i);
    void
    evaluate();
    /// At the point of evaluate(), where mu'(d - b) = 0.
    double
    dual_objective() const
    {
      return solution.lambda.dot(0.5 * solution.slopes - beta) -
             0.5 * mu.dot(b);
    }
    std::pair<Entering, unsigned int>
    most_violated() const;
    void
    compute_residuals();

    unsigned int    m = 0;   ///< number of cuts
    Eigen::MatrixXd gram;    ///< eta_j'eta_k over the unbounded components
    Eigen::MatrixXd bounded; ///< components in C, a column for each cut

    // Data of the current solve().
    Eigen::VectorXd beta;
    Eigen::VectorXd b;
    double          u = 0.;

    // Working set and dual point.
    std::vector<unsigned int> cuts;         ///< W
    std::vector<char>         bound_active; ///< whether i is in B
    Eigen::VectorXd           lambda;       ///< of W, in its order
    Eigen::VectorXd           mu;           ///< of all bounds, 0 outside B
    Eigen::VectorXd           free_bounds;  ///< 1 outside B, 0 in B
    UpdatableCholesky         factor;       ///< of H + kappa 1 1' on W
    double                    kappa    = 0.;
    double                    factor_u = 0.; ///< the u that the factor is for
    bool                      factor_valid = false;
    unsigned int              step_limit   = 0; ///< for solution.steps

    Solution solution;
  };

  std::string
  to_string(const BundleQP::Status status);
} // namespace Debond

#endif
