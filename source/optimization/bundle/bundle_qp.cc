// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/bundle/bundle_qp.h>
#include <debond/optimization/bundle/bundle_qp_tolerances.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Debond
{
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



  unsigned int
  BundleQP::n_cuts() const
  {
    return m;
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
} // namespace Debond
