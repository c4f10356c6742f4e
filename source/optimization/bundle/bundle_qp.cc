// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/bundle/bundle_qp.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Debond
{
  /// All tolerances of BundleQP, relative ones.
  namespace QPTolerance
  {
    /// Units of rounding by which terms may miss zero.
    constexpr double rounding = 64. * std::numeric_limits<double>::epsilon();

    /// Part of its squared length by which a cut (or bound) has to stand out
    /// of the working set to enter it. The Gram matrix has the square of the
    /// relative accuracy of the subgradients, so this is close to rounding.
    constexpr double independence = 1e-13;

    /// A cut enters if it exceeds v by more than this part of |v|.
    constexpr double cut = 1e-12;

    /// A bound enters if d exceeds it by more than this part of |d|.
    constexpr double bound = 1e-13;

    /// Residual of the linear system above which it is refined.
    constexpr double refinement = 1e-14;

    /// Residual of a solution above which the factor is made anew, once.
    constexpr double repair = 1e-10;

    /// Range of kappa over the mean diagonal of H in which the factor is kept.
    constexpr double kappa_range = 1e2;
  } // namespace QPTolerance



  std::string
  to_string(const BundleQP::Status status)
  {
    switch (status)
      {
        case BundleQP::Status::optimal:
          return "optimal";
        case BundleQP::Status::inaccurate:
          return "inaccurate";
        case BundleQP::Status::iteration_limit:
          return "iteration limit";
        case BundleQP::Status::breakdown:
          return "breakdown";
      }
    return "unknown";
  }



  double
  BundleQP::Solution::residual() const
  {
    // The comparisons of std::max would lose a NaN.
    return std::isfinite(stationarity + feasibility + complementarity) ?
             std::max({stationarity, feasibility, complementarity}) :
             std::numeric_limits<double>::infinity();
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

    // The dual objective rises from one working set to the next, but for ties:
    // as long as it does there is reason to go on.
    const unsigned int patience =
      20 + 2 * (m + static_cast<unsigned int>(mu.size()));
    const unsigned int limit = solution.steps + 10 * patience;
    double             best  = -std::numeric_limits<double>::infinity();
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
        // Whatever was left half done: bounds that have not reached the factor
        // leave the working set, and the factor is made anew next time.
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

    // Errors that the factor has gathered over many updates go with it.
    if (solution.status != Status::optimal ||
        !(solution.residual() < QPTolerance::repair))
      {
        factor_valid = false;
        run_active_set();
        if (solution.status == Status::optimal &&
            !(solution.residual() < QPTolerance::repair))
          solution.status = Status::inaccurate;
      }
    return solution;
  }



  double
  BundleQP::h(const unsigned int j, const unsigned int k) const
  {
    return (gram(j, k) + (bounded.col(j).array() * free_bounds.array() *
                          bounded.col(k).array())
                           .sum()) /
           u;
  }



  Eigen::VectorXd
  BundleQP::h_times(const Eigen::VectorXd &x) const
  {
    const unsigned int n       = static_cast<unsigned int>(cuts.size());
    Eigen::VectorXd    in_free = Eigen::VectorXd::Zero(mu.size());
    for (unsigned int k = 0; k < n; ++k)
      in_free += x(k) * bounded.col(cuts[k]);
    in_free.array() *= free_bounds.array();

    Eigen::VectorXd result(n);
    for (unsigned int j = 0; j < n; ++j)
      {
        double sum = bounded.col(cuts[j]).dot(in_free);
        for (unsigned int k = 0; k < n; ++k)
          sum += gram(cuts[k], cuts[j]) * x(k);
        result(j) = sum / u;
      }
    return result;
  }



  Eigen::VectorXd
  BundleQP::bounded_rows(const unsigned int i) const
  {
    Eigen::VectorXd row(cuts.size());
    for (unsigned int k = 0; k < cuts.size(); ++k)
      row(k) = bounded(i, cuts[k]);
    return row;
  }



  void
  BundleQP::factorize()
  {
    // kappa must be neither so large that the differences of the cuts drown
    // in kappa 1 1', nor so small that 1 1' is lost.
    double       log_sum = 0.;
    unsigned int n_terms = 0;
    for (const unsigned int j : cuts)
      if (const double diagonal = h(j, j); diagonal > 0.)
        {
          log_sum += std::log(diagonal);
          ++n_terms;
        }
    kappa = n_terms > 0 ? std::exp(log_sum / n_terms) : 1.;

    factor.clear();
    factor_u     = u;
    factor_valid = true;
    for (unsigned int k = 0; k < cuts.size();)
      {
        Eigen::VectorXd column(k);
        for (unsigned int l = 0; l < k; ++l)
          column(l) = h(cuts[l], cuts[k]) + kappa;
        if (factor.append(column, h(cuts[k], cuts[k]) + kappa, 0.) > 0.)
          ++k;
        else if (cuts.size() == 1)
          {
            solution.status = Status::breakdown;
            return;
          }
        else
          {
            // Cannot stay in the working set. Its weight must go somewhere;
            // the next steps put it right.
            const double weight = lambda(k);
            cuts.erase(cuts.begin() + k);
            lambda.segment(k, lambda.size() - k - 1) =
              lambda.tail(lambda.size() - k - 1).eval();
            lambda.conservativeResize(lambda.size() - 1);
            lambda(0) += weight;
          }
      }
  }



  void
  BundleQP::start()
  {
    if (cuts.empty())
      {
        cuts   = {m - 1};
        lambda = Eigen::VectorXd::Ones(1);
      }
    lambda /= lambda.sum();

    double smallest = std::numeric_limits<double>::max(), largest = 0.;
    for (const unsigned int j : cuts)
      {
        const double diagonal = h(j, j);
        smallest              = std::min(smallest, diagonal);
        largest               = std::max(largest, diagonal);
      }
    if (!factor_valid || factor_u != u ||
        kappa > QPTolerance::kappa_range * largest ||
        kappa * QPTolerance::kappa_range < smallest)
      factorize();
  }



  BundleQP::DualPoint
  BundleQP::maximum_on_working_set()
  {
    const unsigned int n = static_cast<unsigned int>(cuts.size());

    Eigen::VectorXd b_active =
      (b.array() * (1. - free_bounds.array())).matrix();
    Eigen::VectorXd right_side(n);
    for (unsigned int k = 0; k < n; ++k)
      right_side(k) = bounded.col(cuts[k]).dot(b_active) - beta(cuts[k]);
    // What all entries share goes into v; left in, it would be lost against
    // sum lambda = 1 where it is large beside H. It is their mean; but what a
    // long cut has more than a short one is no part of it, so that with cuts of
    // very different lengths each entry counts by what one unit of lambda
    // changes in it.
    constexpr double very_different = 1e8; // of squared lengths
    Eigen::VectorXd  diagonal(n);
    for (unsigned int k = 0; k < n; ++k)
      diagonal(k) = h(cuts[k], cuts[k]) + kappa;
    const bool is_weighted =
      diagonal.maxCoeff() > very_different * diagonal.minCoeff();
    const Eigen::VectorXd weights        = diagonal.cwiseInverse();
    const auto            without_shared = [&](const Eigen::VectorXd &r) {
      const double shared =
        is_weighted ? weights.dot(r) / weights.sum() : r.mean();
      return Eigen::VectorXd(r.array() - shared);
    };
    right_side = without_shared(right_side);

    // With K = H + kappa 1 1', H lambda + v 1 = r becomes
    // K lambda = r + (kappa sum lambda - v) 1.
    Eigen::VectorXd ones = Eigen::VectorXd::Ones(n);
    factor.solve_in_place(ones);
    const double ones_K_ones = ones.sum();

    DualPoint       target{Eigen::VectorXd::Zero(n),
                     Eigen::VectorXd::Zero(mu.size())};
    Eigen::VectorXd residual = right_side;
    double          missing  = 1.;
    double          previous = std::numeric_limits<double>::max();
    for (unsigned int refinement = 0; refinement < 4; ++refinement)
      {
        Eigen::VectorXd correction = residual;
        factor.solve_in_place(correction);
        correction += (missing - correction.sum()) / ones_K_ones * ones;
        const Eigen::VectorXd refined = target.lambda + correction;

        const Eigen::VectorXd product = h_times(refined);
        const Eigen::VectorXd rest    = without_shared(right_side - product);
        const double          terms   = product.lpNorm<Eigen::Infinity>() +
                             right_side.lpNorm<Eigen::Infinity>() +
                             std::numeric_limits<double>::min();
        // Both parts count: with cuts of very different lengths the sum of
        // lambda is the last to be right.
        const double error = std::max(rest.lpNorm<Eigen::Infinity>() / terms,
                                      std::abs(1. - refined.sum()));
        if (!(error < previous))
          break;
        target.lambda = refined;
        residual      = rest;
        missing       = 1. - refined.sum();
        previous      = error;
        if (error <= QPTolerance::refinement)
          break;
      }

    for (unsigned int i = 0; i < mu.size(); ++i)
      if (bound_active[i])
        {
          double force = u * b(i);
          for (unsigned int k = 0; k < n; ++k)
            force += bounded(i, cuts[k]) * target.lambda(k);
          target.mu(i) = -force;
        }
    return target;
  }



  /// Moves towards @p target (or along it, if it is a direction) as far as
  /// the multipliers stay nonnegative. If one of them blocks, it leaves the
  /// working set and the result is true.
  bool
  BundleQP::move_towards(const DualPoint &target, const bool direction_only)
  {
    const unsigned int    n = static_cast<unsigned int>(cuts.size());
    const Eigen::VectorXd lambda_step =
      direction_only ? target.lambda : Eigen::VectorXd(target.lambda - lambda);
    const Eigen::VectorXd mu_step =
      direction_only ? target.mu : Eigen::VectorXd(target.mu - mu);

    constexpr double infinity     = std::numeric_limits<double>::infinity();
    double           length       = direction_only ? infinity : 1.;
    int              blocking_cut = -1, blocking_bound = -1;
    for (unsigned int k = 0; k < n; ++k)
      if (lambda_step(k) < 0. && -lambda_step(k) * length > lambda(k))
        {
          length       = lambda(k) / -lambda_step(k);
          blocking_cut = k;
        }
    for (unsigned int i = 0; i < mu.size(); ++i)
      if (bound_active[i] && mu_step(i) < 0. && -mu_step(i) * length > mu(i))
        {
          length         = mu(i) / -mu_step(i);
          blocking_bound = i;
        }
    if (length == infinity)
      {
        solution.status = Status::breakdown;
        return false;
      }

    lambda += length * lambda_step;
    mu += length * mu_step;
    // Rounding of the entries next to the blocking one.
    lambda = lambda.cwiseMax(0.);
    mu     = mu.cwiseMax(0.);

    if (blocking_bound >= 0)
      drop_bound(blocking_bound);
    else if (blocking_cut >= 0)
      drop_cut(blocking_cut);
    return blocking_bound >= 0 || blocking_cut >= 0;
  }



  void
  BundleQP::drop_cut(const unsigned int position)
  {
    const unsigned int behind =
      static_cast<unsigned int>(cuts.size()) - position - 1;
    lambda.segment(position, behind) = lambda.tail(behind).eval();
    lambda.conservativeResize(cuts.size() - 1);
    cuts.erase(cuts.begin() + position);
    if (position < factor.size())
      factor.remove(position);
    ++solution.steps;
  }



  void
  BundleQP::drop_bound(const unsigned int i)
  {
    bound_active[i] = 0;
    free_bounds(i)  = 1.;
    mu(i)           = 0.;
    factor.update(bounded_rows(i).head(factor.size()) / std::sqrt(u));
    ++solution.steps;
  }



  /// Takes cut j into the working set with multiplier zero; if it depends on
  /// the working set, weight moves to it until something else leaves. False
  /// if that fails.
  bool
  BundleQP::enter_cut(const unsigned int j)
  {
    ++solution.steps;
    while (true)
      {
        const unsigned int n = factor.size();
        Eigen::VectorXd    column(n);
        for (unsigned int k = 0; k < n; ++k)
          column(k) = h(cuts[k], j) + kappa;
        // Unless it is in the set from an earlier round.
        if (cuts.size() == n)
          {
            cuts.push_back(j);
            lambda.conservativeResize(n + 1);
            lambda(n) = 0.;
          }
        if (factor.append(column, h(j, j) + kappa, QPTolerance::independence) >
            QPTolerance::independence)
          return true;

        factor.solve_in_place(column);
        DualPoint direction{Eigen::VectorXd(n + 1),
                            Eigen::VectorXd::Zero(mu.size())};
        direction.lambda.head(n) = -column / column.sum();
        direction.lambda(n)      = 1.;
        for (unsigned int i = 0; i < mu.size(); ++i)
          if (bound_active[i])
            for (unsigned int k = 0; k <= n; ++k)
              direction.mu(i) -= bounded(i, cuts[k]) * direction.lambda(k);
        if (!move_towards(direction, true) || solution.steps > step_limit)
          {
            solution.status = Status::breakdown;
            return false;
          }
      }
  }



  /// The same for bound i.
  bool
  BundleQP::enter_bound(const unsigned int i)
  {
    ++solution.steps;
    bound_active[i] = 1;
    while (true)
      {
        const Eigen::VectorXd row = bounded_rows(i);
        if (factor.downdate(row / std::sqrt(u), QPTolerance::independence) >
            QPTolerance::independence)
          {
            free_bounds(i) = 0.;
            return true;
          }

        // The components of d outside B do not change along this direction.
        DualPoint direction{-row, Eigen::VectorXd::Zero(mu.size())};
        factor.solve_in_place(direction.lambda);
        direction.lambda /= u;
        direction.lambda.array() -= direction.lambda.mean();
        for (unsigned int k = 0; k < mu.size(); ++k)
          if (bound_active[k])
            for (unsigned int l = 0; l < cuts.size(); ++l)
              direction.mu(k) -= bounded(k, cuts[l]) * direction.lambda(l);
        direction.mu(i) = 1.;
        if (!move_towards(direction, true) || !bound_active[i])
          {
            solution.status = Status::breakdown;
            return false;
          }
      }
  }



  void
  BundleQP::evaluate()
  {
    solution.lambda.setZero(m);
    for (unsigned int k = 0; k < cuts.size(); ++k)
      solution.lambda(cuts[k]) = lambda(k);
    solution.mu = mu;

    solution.d.setZero(mu.size());
    for (unsigned int k = 0; k < cuts.size(); ++k)
      solution.d -= lambda(k) / u * bounded.col(cuts[k]);
    for (unsigned int i = 0; i < mu.size(); ++i)
      if (bound_active[i])
        solution.d(i) = b(i);

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
          const double rounding =
            QPTolerance::rounding * (std::sqrt(gram(j, j)) * longest_cut / u +
                                     bounded.col(j).norm() * d_norm + beta(j));
          if (excess > QPTolerance::cut * std::abs(v) + rounding)
            {
              const double gain = excess * excess / (h(j, j) + kappa);
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
              const double gain = excess * excess * u;
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
    double magnitude = std::abs(solution.v);
    for (const unsigned int j : cuts)
      {
        double slope_terms =
          bounded.col(j).cwiseAbs().dot(solution.d.cwiseAbs());
        for (const unsigned int k : cuts)
          slope_terms += x(k) * std::abs(gram(k, j)) / u;
        magnitude += x(j) * (beta(j) + slope_terms);
      }
    solution.duality_gap = gap;
    solution.complementarity =
      std::abs(gap) / std::max(magnitude, std::numeric_limits<double>::min());
  }
} // namespace Debond
