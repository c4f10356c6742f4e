// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/optimization/bundle/bundle_qp.h>
#include <debond/optimization/bundle/metric_direction.h>

#include <cmath>

namespace Debond
{
  MetricDirection::MetricDirection(const PiecewiseProblem &problem,
                                   const unsigned int      bundle_size)
    : S(problem.S)
    , upper(problem.upper)
    , phi(problem.phi)
    , eta(S.rows(), bundle_size)
    , active(S.rows(), 0)
  {}



  bool
  MetricDirection::is_feasible(const DofVector &x) const
  {
    return (eigen_view(x).array() <= upper.array()).all();
  }



  const MetricDirection::Solution &
  MetricDirection::solve(const DofVector &x, const Eigen::VectorXd &beta)
  {
    const unsigned int n = x.size();
    // Unless bonds soften, M is the second derivative of J as long as they stay
    // on their pieces, and the step with one subgradient is Newton's.
    Eigen::MatrixXd M = S;
    M += phi.curvature(eigen_view(x));
    const Eigen::VectorXd b = upper - eigen_view(x);
    const auto            G = eta.leftCols(m);

    // For a given active set of bounds d is known by the multipliers lambda of
    // the cuts, and these solve a BundleQP without bounds in the Gram matrix of
    // the cuts with M_ff^{-1}. The outer loop changes the active set by the
    // signs of mu and of d - b, as one would for a plain bound-constrained
    // problem.
    ActiveSetRule      rule;
    Eigen::VectorXd    mu;
    Eigen::VectorXd    force_terms; // of the stationarity condition
    BundleQP::Solution inner;
    solution.steps = 0;
    bool settled   = false;
    while (!settled && solution.steps < maximum_active_set_steps)
      {
        ++solution.steps;
        // Active components are at their bounds, the others follow from them.
        // Each guess of the active set costs a factorisation of M_ff; the first
        // guess is that of the last call, which is rarely far off.
        std::vector<int> free;
        d = b;
        for (unsigned int i = 0; i < n; ++i)
          if (active[i] == 0)
            {
              free.push_back(i);
              d(i) = 0.;
            }

        // d_free = -M_ff^{-1} (G_f lambda + M_fb b_b).
        Eigen::MatrixXd                         M_free = M(free, free);
        Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(M_free);
        const Eigen::MatrixXd G_free = G(free, Eigen::seqN(0, G.cols()));
        const Eigen::MatrixXd X      = factor.solve(G_free);
        const Eigen::VectorXd M_d    = M * d;
        const Eigen::VectorXd x_b    = factor.solve(M_d(free).eval());

        const Eigen::MatrixXd H = G_free.transpose() * X;
        BundleQP              qp(m, 0);
        for (unsigned int j = 0; j < m; ++j)
          qp.add_cut(H.col(j).head(j + 1), Eigen::VectorXd());
        // With x_b = M_ff^{-1} M_fb b_b and X = M_ff^{-1} G_f the cuts' values
        // at d are
        //
        //     G'd - beta = -H lambda - G_f'x_b + G_b'b_b - beta:
        //
        // those of a QP without bounds and with u = 1, in which all but the
        // first term is a constant of this active set.
        const Eigen::VectorXd shifted_beta =
          beta + G_free.transpose() * x_b - G.transpose() * d;
        inner = qp.solve(shifted_beta, Eigen::VectorXd(), 1.);

        const Eigen::VectorXd d_free = -(X * inner.lambda + x_b);
        for (unsigned int k = 0; k < free.size(); ++k)
          d(free[k]) = d_free(k);

        // Stationarity M d + G lambda + mu = 0 gives the multipliers of active
        // bounds.
        mu = -(G * inner.lambda + M * d);
        force_terms =
          G.cwiseAbs() * inner.lambda.cwiseAbs() + M.cwiseAbs() * d.cwiseAbs();
        for (const int i : free)
          mu(i) = 0.;
        const double largest_force = n > 0 ? force_terms.maxCoeff() : 0.;
        // Signs count beyond rounding only: an unknown at its bound without a
        // force on it would otherwise go in and out for ever.
        settled = rule.update(b,
                              d,
                              mu,
                              Tolerance::active_set *
                                (n > 0 ? d.lpNorm<Eigen::Infinity>() : 0.),
                              Tolerance::active_set * largest_force,
                              active) == 0;
      }

    solution.status = settled ? to_string(inner.status) : "iteration limit";
    solution.slopes = G.transpose() * d;
    solution.v      = (solution.slopes - beta).maxCoeff();
    // Bounds are complementary to rounding, so that the cuts alone make the
    // gap.
    solution.duality_gap = inner.lambda.dot(
      (solution.v + beta.array() - solution.slopes.array()).matrix());

    // From the original data.
    const Eigen::VectorXd stationarity = G * inner.lambda + M * d + mu;
    const auto            relative = [](const double value, const double of) {
      return value / std::max(of, std::numeric_limits<double>::min());
    };
    double residual = settled ? 0. : 1.;
    for (unsigned int i = 0; i < n; ++i)
      residual =
        std::max({residual,
                  relative(std::abs(stationarity(i)), force_terms.maxCoeff()),
                  relative(d(i) - b(i), d.lpNorm<Eigen::Infinity>()),
                  relative(-mu(i), force_terms.maxCoeff())});
    const double slope_terms =
      inner.lambda.dot(beta + G.cwiseAbs().transpose() * d.cwiseAbs());
    solution.residual =
      std::max(residual, relative(std::abs(solution.duality_gap), slope_terms));
    return solution;
  }



  void
  MetricDirection::direction(DofVector &direction) const
  {
    std::copy(d.begin(), d.end(), direction.begin());
  }



  double
  MetricDirection::length(const DofVector &direction) const
  {
    // This is the norm of the energy of the body. The curvature of the pieces
    // changes from one iteration to the next and is left out, so that the
    // lengths of different steps can be added up.
    const auto v = eigen_view(direction);
    return std::sqrt(v.dot(S * v));
  }



  void
  MetricDirection::project(DofVector &x) const
  {
    // A step to a bound ends beside it by the last digit.
    for (unsigned int i = 0; i < x.size(); ++i)
      x(i) = std::min(x(i), upper(i));
  }

} // namespace Debond
