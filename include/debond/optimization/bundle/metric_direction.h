// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_bundle_metric_direction_h
#define debond_optimization_bundle_metric_direction_h

#include <debond/optimization/bundle/direction_problem.h>
#include <debond/optimization/majorise/bound_qp.h>
#include <debond/optimization/piecewise_quadratic.h>

namespace Debond
{
  /**
   * The direction problem for s <= upper in the metric M = S + E(x), where S is
   * a dense symmetric positive definite matrix (the energy of the elastic body)
   * and E(x) the curvature of the quadratics that touch Phi at x. Active sets
   * for the bounds; on each of them the multipliers of the cuts solve a
   * BundleQP without bounds.
   *
   * Keeps references to S and Phi.
   */
  class MetricDirection : public DirectionProblem
  {
  public:
    MetricDirection(const PiecewiseProblem &problem,
                    const unsigned int      bundle_size);

    bool
    is_feasible(const DofVector &x) const override;

    unsigned int
    size() const override
    {
      return m;
    }

    void
    clear() override
    {
      m = 0;
    }

    void
    add(const DofVector &new_eta) override
    {
      eta.col(m++) = eigen_view(new_eta);
    }

    const Solution &
    solve(const DofVector &x, const Eigen::VectorXd &beta) override;

    void
    direction(DofVector &d) const override;

    /// (d'S d)^(1/2), the paper's ||d||_V.
    double
    length(const DofVector &d) const override;

    void
    project(DofVector &x) const override;

  private:
    const MatrixView          S;
    const Eigen::VectorXd     upper;
    const PiecewiseQuadratic &phi;
    unsigned int              m = 0; ///< number of subgradients
    Eigen::MatrixXd           eta;   ///< a column for each
    ActiveSet                 active;
    Eigen::VectorXd           d;
    Solution                  solution;
  };
} // namespace Debond

#endif
