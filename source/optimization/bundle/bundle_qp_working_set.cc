// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/optimization/bundle/bundle_qp.h>
#include <debond/optimization/interval.h>

#include <algorithm>
#include <cmath>

namespace Debond
{
  double
  BundleQP::h(const unsigned int j, const unsigned int k) const
  {
    // Components at their bounds do not move, so that H is without them.
    return (gram(j, k) + (bounded.col(j).array() * free_bounds.array() *
                          bounded.col(k).array())
                           .sum()) /
           u;
  }



  Eigen::VectorXd
  BundleQP::h_times(const Eigen::VectorXd &x) const
  {
    // H x in O(m^2 + m n_C): the combination of the cuts on the free bounds
    // first, then its products with each cut.
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
    return bounded(i, cuts).transpose();
  }



  void
  BundleQP::factorize()
  {
    // H alone is singular as soon as there are more cuts than dimensions, or
    // cuts that are combinations of each other up to a constant. H + kappa 1 1'
    // is positive definite where H is on directions with sum lambda = 0, which
    // is all that the method needs. kappa must be neither so large that the
    // differences of the cuts drown in kappa 1 1', nor so small that 1 1' is
    // lost.
    double       log_sum = 0.;
    unsigned int n_terms = 0;
    for (const unsigned int j : cuts)
      if (const double diagonal = h(j, j); diagonal > 0.)
        {
          log_sum += std::log(diagonal);
          ++n_terms;
        }
    // The geometric mean of the diagonal is the middle of its range, whatever
    // the lengths of the cuts.
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
            // A cut that depends on the others cannot stay in the working set.
            // Its weight is given to another one, and the next steps put that
            // right.
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
    // The multipliers of the last solve are a feasible point of this one,
    // whatever beta, b and u have become.
    lambda /= lambda.sum();

    double smallest = std::numeric_limits<double>::max(), largest = 0.;
    for (const unsigned int j : cuts)
      {
        const double diagonal = h(j, j);
        smallest              = std::min(smallest, diagonal);
        largest               = std::max(largest, diagonal);
      }
    // Updates keep the factor as cuts and bounds come and go; with another u,
    // or a kappa that is no longer of the size of H, it is made anew.
    if (!factor_valid || factor_u != u ||
        kappa > QPTolerance::kappa_range * largest ||
        kappa * QPTolerance::kappa_range < smallest)
      factorize();
  }



  BundleQP::DualPoint
  BundleQP::maximum_on_working_set()
  {
    const unsigned int n = static_cast<unsigned int>(cuts.size());

    // The right side C_B'b_B - beta_W.
    Eigen::VectorXd b_active =
      (b.array() * (1. - free_bounds.array())).matrix();
    Eigen::VectorXd right_side(n);
    for (unsigned int k = 0; k < n; ++k)
      right_side(k) = bounded.col(cuts[k]).dot(b_active) - beta(cuts[k]);
    // What all entries share goes into v; left in, it would be lost against sum
    // lambda = 1 where it is large beside H. It is their mean; but what a long
    // cut has more than a short one is no part of it, so that with cuts of very
    // different lengths each entry counts by what one unit of lambda changes in
    // it.
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

    // With K = H + kappa 1 1' the system H lambda + v 1 = r becomes K lambda =
    // r + (kappa sum lambda - v) 1, so that lambda = K^{-1} r + c K^{-1} 1,
    // with the c for which the sum is 1.
    Eigen::VectorXd ones = Eigen::VectorXd::Ones(n);
    factor.solve_in_place(ones);
    const double ones_K_ones = ones.sum();

    DualPoint       target{Eigen::VectorXd::Zero(n),
                     Eigen::VectorXd::Zero(mu.size())};
    Eigen::VectorXd residual = right_side;
    double          missing  = 1.;
    double          previous = std::numeric_limits<double>::max();
    // Refined by residuals with H itself: the factor has gathered rounding over
    // its updates, and kappa 1 1' hides the last digits of H.
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

    // mu is what stationarity of the active components leaves: u d_i + sum
    // lambda_j eta_ji + mu_i = 0 with d_i = b_i.
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
    // The longest step at which no multiplier is negative; the first one to
    // become zero blocks.
    const unsigned int    n = static_cast<unsigned int>(cuts.size());
    const Eigen::VectorXd lambda_step =
      direction_only ? target.lambda : Eigen::VectorXd(target.lambda - lambda);
    const Eigen::VectorXd mu_step =
      direction_only ? target.mu : Eigen::VectorXd(target.mu - mu);

    double length       = direction_only ? infinity : 1.;
    int    blocking_cut = -1, blocking_bound = -1;
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
    // Along a direction in the null space of H the dual objective does not
    // fall. With no multiplier to block it would rise for ever, and the primal
    // problem have no feasible point; but d = 0 is one, so this is rounding.
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
    // A cut that is about to enter is the last one and not in the factor yet.
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
    // Component i counts in H again: a rank-one term is added, which is always
    // possible.
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

        // Cut j is a combination of those in the set: H has a null vector, the
        // combination less e_j, with the sum 0. Along it the objective is
        // linear and rises, until some multiplier is zero and its constraint
        // leaves.
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
        // Component i leaves H: a rank-one term is taken off, which fails if
        // nothing positive definite is left.
        if (factor.downdate(row / std::sqrt(u), QPTolerance::independence) >
            QPTolerance::independence)
          {
            free_bounds(i) = 0.;
            return true;
          }

        // K = H + kappa 1 1' without the term of i has, to rounding, the null
        // vector z = K^{-1} row. As both parts are semidefinite, the sum of z
        // is zero and H without i has it as well: on (-z/u, mu_i = 1) sum
        // lambda stays 1, and no component of d outside B changes, while mu of
        // the bounds in B keeps d at them. The dual objective is linear along
        // it.
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
} // namespace Debond
