// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/optimization/bundle/bundle_qp.h>
#include <debond/optimization/interval.h>

#include <algorithm>
#include <cmath>

namespace Debond
{
  std::string
  to_string(const BundleQP::Status status)
  {
    static const char *const words[] = {"optimal",
                                        "inaccurate",
                                        "iteration limit",
                                        "breakdown"};
    return words[static_cast<unsigned int>(status)];
  }



  double
  BundleQP::Solution::residual() const
  {
    // The comparisons of std::max would lose a NaN.
    return std::isfinite(stationarity + feasibility + complementarity) ?
             std::max({stationarity, feasibility, complementarity}) :
             infinity;
  }



  BundleQP::BundleQP(const unsigned int maximum_cuts,
                     const unsigned int n_bounds)
    : gram(maximum_cuts, maximum_cuts)
    , bounded(n_bounds, maximum_cuts)
    , bound_active(n_bounds, 0)
    , mu(Eigen::VectorXd::Zero(n_bounds))
    , free_bounds(Eigen::VectorXd::Ones(n_bounds))
  {
    factor.reserve(maximum_cuts);
  }



  void
  BundleQP::add_cut(const Eigen::Ref<const Eigen::VectorXd> &products,
                    const Eigen::Ref<const Eigen::VectorXd> &bounded_part)
  {
    // Both triangles are written, so that a column can be read as it stands.
    gram.col(m).head(m + 1) = products;
    gram.row(m).head(m + 1) = products.transpose();
    bounded.col(m)          = bounded_part;
    ++m;
  }



  void
  BundleQP::clear()
  {
    m = 0;
    cuts.clear();
    lambda.resize(0);
    factor.clear();
    factor_valid = false;
  }



  void
  BundleQP::run_active_set()
  {
    solution.status = Status::iteration_limit;
    start();
    if (solution.status == Status::breakdown)
      {
        evaluate();
        compute_residuals();
        return;
      }

    // The primal active-set method: with the maximum of the dual problem on the
    // working set as target, multipliers that become zero on the way leave the
    // set; once the target is reached, the constraint that promises most
    // enters. At a target that no constraint violates the point is primal
    // feasible as well, and so the minimum.
    //
    // The dual objective rises from one working set to the next, but for ties,
    // which can let the method go round in circles: as long as it rises there
    // is reason to continue. A solve from a good working set needs a few
    // changes, one from scratch about one for each constraint, so that there is
    // patience for twice as many without a rise.
    const unsigned int patience =
      20 + 2 * (m + static_cast<unsigned int>(mu.size()));
    const unsigned int limit = solution.steps + 10 * patience;
    double             best  = -infinity;
    step_limit               = solution.steps + patience;
    while (solution.steps <= step_limit)
      {
        if (move_towards(maximum_on_working_set(), false))
          continue;

        evaluate();
        if (const double dual = dual_objective(); dual > best)
          {
            best       = dual;
            step_limit = std::min(limit, solution.steps + patience);
          }
        const auto [kind, index] = most_violated();
        if (kind == Entering::nothing)
          {
            solution.status = Status::optimal;
            break;
          }
        if (!(kind == Entering::cut ? enter_cut(index) : enter_bound(index)))
          break;
      }

    if (solution.status != Status::optimal)
      {
        // A solve that failed may leave a working set that its factor does not
        // have: bounds that have not reached the factor leave the set, and the
        // factor is made anew next time.
        for (unsigned int i = 0; i < mu.size(); ++i)
          if (bound_active[i] != 0 && free_bounds(i) != 0.)
            {
              bound_active[i] = 0;
              mu(i)           = 0.;
            }
        factor_valid = false;
        evaluate();
      }
    compute_residuals();
  }



  const BundleQP::Solution &
  BundleQP::solve(const Eigen::Ref<const Eigen::VectorXd> &new_beta,
                  const Eigen::Ref<const Eigen::VectorXd> &new_b,
                  const double                             new_u)
  {
    beta           = new_beta;
    b              = new_b;
    u              = new_u;
    solution.steps = 0;
    run_active_set();

    // The residual is computed from the data, not from the factor, so that it
    // tells what the factor has lost. Errors that the factor has gathered over
    // many updates go with it when it is made anew, once.
    const auto is_solved = [this]() {
      return solution.residual() < QPTolerance::repair;
    };
    if (!is_solved())
      {
        factor_valid = false;
        run_active_set();
      }
    // Among cuts that depend on each other, working sets with one solution can
    // follow each other without an end.
    if (is_solved())
      solution.status = Status::optimal;
    else if (solution.status == Status::optimal)
      solution.status = Status::inaccurate;
    return solution;
  }



  void
  BundleQP::evaluate()
  {
    solution.lambda.setZero(m);
    for (unsigned int k = 0; k < cuts.size(); ++k)
      solution.lambda(cuts[k]) = lambda(k);
    solution.mu = mu;

    // d = -1/u (sum lambda_j eta_j + mu) on C. Where a bound is active d is the
    // bound itself, which has no rounding.
    solution.d.setZero(mu.size());
    for (unsigned int k = 0; k < cuts.size(); ++k)
      solution.d -= lambda(k) / u * bounded.col(cuts[k]);
    for (unsigned int i = 0; i < mu.size(); ++i)
      if (bound_active[i])
        solution.d(i) = b(i);

    // eta_j'd: the bounded components of d are known, the others enter by the
    // Gram matrix.
    solution.slopes.noalias() = bounded.leftCols(m).transpose() * solution.d;
    for (unsigned int k = 0; k < cuts.size(); ++k)
      solution.slopes -= lambda(k) / u * gram.col(cuts[k]).head(m);
    solution.v = (solution.slopes - beta).maxCoeff();
  }



  /// The constraint outside the working set whose violation promises the
  /// largest increase of the dual function.
  std::pair<BundleQP::Entering, unsigned int>
  BundleQP::most_violated() const
  {
    // On the working set all eta_j'd - beta_j are equal but for rounding, which
    // their mean by lambda smooths.
    double v = 0.;
    for (unsigned int k = 0; k < cuts.size(); ++k)
      v += lambda(k) * (solution.slopes(cuts[k]) - beta(cuts[k]));

    double longest_cut = 0.;
    for (const unsigned int j : cuts)
      longest_cut = std::max(longest_cut, gram(j, j));
    longest_cut         = std::sqrt(longest_cut);
    const double d_norm = solution.d.norm();

    std::pair<Entering, unsigned int> entering(Entering::nothing, 0);
    double                            largest_gain = 0.;
    std::vector<char>                 in_set(m, 0);
    for (const unsigned int j : cuts)
      in_set[j] = 1;
    for (unsigned int j = 0; j < m; ++j)
      if (!in_set[j])
        {
          const double excess = solution.slopes(j) - beta(j) - v;
          // The terms of eta_j'd may be far larger than their sum: what is
          // within their rounding is no violation, and would enter and leave
          // for ever.
          const double rounding =
            QPTolerance::rounding * (std::sqrt(gram(j, j)) * longest_cut / u +
                                     bounded.col(j).norm() * d_norm + beta(j));
          if (excess > QPTolerance::cut * std::abs(v) + rounding)
            {
              // The dual function rises by about excess^2 over twice the
              // curvature along lambda_j.
              const double gain = excess / std::sqrt(h(j, j) + kappa);
              if (gain > largest_gain)
                {
                  largest_gain = gain;
                  entering     = {Entering::cut, j};
                }
            }
        }

    const double d_largest =
      mu.size() > 0 ? solution.d.lpNorm<Eigen::Infinity>() : 0.;
    for (unsigned int i = 0; i < mu.size(); ++i)
      if (!bound_active[i])
        {
          const double excess   = solution.d(i) - b(i);
          double       rounding = 0.;
          for (unsigned int k = 0; k < cuts.size(); ++k)
            rounding += lambda(k) * std::abs(bounded(i, cuts[k]));
          rounding *= QPTolerance::rounding / u;
          if (excess > QPTolerance::bound * d_largest + rounding)
            {
              // As above, with the curvature 1/u along mu_i.
              const double gain = excess * std::sqrt(u);
              if (gain > largest_gain)
                {
                  largest_gain = gain;
                  entering     = {Entering::bound, i};
                }
            }
        }
    return entering;
  }



  void
  BundleQP::compute_residuals()
  {
    const Eigen::VectorXd &x = solution.lambda;

    // Each condition is relative to the largest of the terms that it is a sum
    // of, as absolute sizes depend on units.
    const Eigen::VectorXd cut_force = bounded.leftCols(m) * x;
    const Eigen::VectorXd cut_force_terms =
      bounded.leftCols(m).cwiseAbs() * x.cwiseAbs();
    double largest_force = std::numeric_limits<double>::min();
    double d_largest     = std::numeric_limits<double>::min();
    for (unsigned int i = 0; i < mu.size(); ++i)
      {
        largest_force =
          std::max({largest_force, cut_force_terms(i), std::abs(mu(i))});
        d_largest = std::max(d_largest, std::abs(solution.d(i)));
      }

    solution.stationarity = std::abs(x.sum() - 1.);
    solution.feasibility  = std::max(0., -x.minCoeff());
    for (unsigned int i = 0; i < mu.size(); ++i)
      {
        solution.stationarity =
          std::max(solution.stationarity,
                   std::abs(u * solution.d(i) + cut_force(i) + mu(i)) /
                     largest_force);
        solution.feasibility = std::max(
          {solution.feasibility,
           (solution.d(i) - b(i)) / std::max(d_largest, cut_force_terms(i) / u),
           -mu(i) / largest_force});
      }

    // sum_j lambda_j (v + beta_j - eta_j'd) + sum_i mu_i (b_i - d_i) is the
    // duality gap.
    double gap = 0.;
    for (unsigned int j = 0; j < m; ++j)
      gap += x(j) * (solution.v + beta(j) - solution.slopes(j));
    for (unsigned int i = 0; i < mu.size(); ++i)
      gap += mu(i) * std::abs(b(i) - solution.d(i));
    // Where cuts cancel, d and products of cuts are less than their terms.
    const Eigen::VectorXd d_terms =
      solution.d.cwiseAbs().cwiseMax(cut_force_terms / u);
    double length_terms = 0.;
    for (const unsigned int k : cuts)
      length_terms += x(k) * std::sqrt(std::abs(gram(k, k)));
    double magnitude = std::abs(solution.v) + length_terms * length_terms / u;
    for (const unsigned int j : cuts)
      magnitude += x(j) * (beta(j) + bounded.col(j).cwiseAbs().dot(d_terms));
    solution.duality_gap = gap;
    solution.complementarity =
      std::abs(gap) / std::max(magnitude, std::numeric_limits<double>::min());
  }
} // namespace Debond
