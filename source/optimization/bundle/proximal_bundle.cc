// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/text.h>
#include <debond/base/tolerances.h>
#include <debond/optimization/bundle/bundle_qp.h>
#include <debond/optimization/bundle/line_search.h>

#include <cmath>

namespace Debond
{
  namespace
  {
    /// The paper's direction problem, M = u I (u > 0, energy per squared
    /// length). Only the components with bounds are handed to the QP; of all
    /// others it knows the Gram matrix. Keeps a reference to the bounds.
    class EuclideanDirection : public DirectionProblem
    {
    public:
      /// @p model: a vector with the layout of x. @p bundle_size: the most
      /// subgradients that will be added.
      EuclideanDirection(const double       proximal_weight,
                         const UpperBounds &upper_bounds,
                         const unsigned int bundle_size,
                         const DofVector   &model)
        : u(proximal_weight)
        , bounds(upper_bounds)
        , qp(bundle_size, static_cast<unsigned int>(bounds.indices.size()))
        , subgradients(bundle_size, model)
      {}

      bool
      is_feasible(const DofVector &x) const override
      {
        for (unsigned int i = 0; i < bounds.indices.size(); ++i)
          if (!(x(bounds.indices[i]) <= bounds.upper[i]))
            return false;
        return true;
      }

      unsigned int
      size() const override
      {
        return qp.n_cuts();
      }

      void
      clear() override
      {
        qp.clear();
      }

      void
      add(const DofVector &eta) override
      {
        // The bounded components go to the QP and out of the vector that inner
        // products are made of.
        const unsigned int j   = size();
        DofVector         &cut = subgradients[j];
        cut                    = eta;

        Eigen::VectorXd bounded(bounds.indices.size());
        for (unsigned int i = 0; i < bounds.indices.size(); ++i)
          {
            bounded(i)             = cut(bounds.indices[i]);
            cut(bounds.indices[i]) = 0.;
          }
        // One row of the Gram matrix for each new cut: the others are known.
        Eigen::VectorXd products(j + 1);
        for (unsigned int k = 0; k <= j; ++k)
          products(k) = subgradients[k] * cut;
        qp.add_cut(products, bounded);
      }

      const Solution &
      solve(const DofVector &x, const Eigen::VectorXd &beta) override
      {
        // In terms of d the bounds are d_i <= upper_i - x_i.
        Eigen::VectorXd b(bounds.indices.size());
        for (unsigned int i = 0; i < bounds.indices.size(); ++i)
          b(i) = bounds.upper[i] - x(bounds.indices[i]);

        const BundleQP::Solution &qp_solution = qp.solve(beta, b, u);
        lambda                                = qp_solution.lambda;
        d_bounded                             = qp_solution.d;

        solution.v           = qp_solution.v;
        solution.duality_gap = qp_solution.duality_gap;
        solution.residual    = qp_solution.residual();
        solution.steps       = qp_solution.steps;
        solution.status      = to_string(qp_solution.status);
        solution.slopes      = qp_solution.slopes;
        return solution;
      }

      void
      direction(DofVector &d) const override
      {
        // Off the bounds the QP is stationary where u d and the sum of lambda_j
        // eta_j cancel.
        d = 0.;
        // Two at a time, to read and write d half as often.
        std::vector<unsigned int> active;
        for (unsigned int j = 0; j < size(); ++j)
          if (lambda(j) > 0.)
            active.push_back(j);
        const auto factor = [&](const unsigned int k) {
          return -lambda(active[k]) / u;
        };
        for (unsigned int k = 0; k + 1 < active.size(); k += 2)
          d.add(factor(k),
                subgradients[active[k]],
                factor(k + 1),
                subgradients[active[k + 1]]);
        if (active.size() % 2 == 1)
          d.add(factor(static_cast<unsigned int>(active.size()) - 1),
                subgradients[active.back()]);
        // The QP knows these to the last digit.
        for (unsigned int i = 0; i < bounds.indices.size(); ++i)
          d(bounds.indices[i]) = d_bounded(i);
      }

      double
      length(const DofVector &d) const override
      {
        return d.l2_norm();
      }

      void
      project(DofVector &x) const override
      {
        for (unsigned int i = 0; i < bounds.indices.size(); ++i)
          x(bounds.indices[i]) =
            std::min<double>(x(bounds.indices[i]), bounds.upper[i]);
      }

    private:
      const double       u;
      const UpperBounds &bounds;
      BundleQP           qp;

      /// With zeros in the bounded components, which the QP holds: so the part
      /// of the Gram matrix that remains when bounds are active is not a
      /// difference.
      std::vector<DofVector> subgradients;

      Eigen::VectorXd lambda; ///< of the last solve()
      Eigen::VectorXd d_bounded;
      Solution        solution;
    };



    /**
     * The bundle of the paper's Section 4: up to @p capacity subgradients
     * eta_j, which the direction problem holds, with their linearisation errors
     * alpha_j (energy) and the lengths s_j of the way from y_j to x_k (in the
     * norm of the direction problem). Keeps a reference to the direction
     * problem, which has to outlive it and is cleared at the start.
     */
    class Bundle
    {
    public:
      using Solution = DirectionProblem::Solution;

      Bundle(DirectionProblem &direction_problem, const unsigned int capacity)
        : problem(direction_problem)
        , alpha(capacity)
        , distance(capacity)
      {
        problem.clear();
      }

      unsigned int
      size() const
      {
        return problem.size();
      }

      bool
      full() const
      {
        return size() == alpha.size();
      }

      void
      clear()
      {
        problem.clear();
      }

      /// Adds the subgradient eta with its alpha_j and s_j at x_k. There has to
      /// be room: !full().
      void
      add(const DofVector &eta,
          const double     new_alpha,
          const double     new_distance)
      {
        alpha(size())    = new_alpha;
        distance(size()) = new_distance;
        problem.add(eta);
      }

      /// The direction at @p x = x_k, from beta_j = max(|alpha_j|, gamma
      /// s_j^2). The result is valid until the next call.
      const Solution &
      solve(const DofVector &x, const double gamma)
      {
        // beta_j, the subgradient locality measure, stands for alpha_j, which
        // may be negative if J is not convex; gamma s_j^2 takes weight from
        // subgradients that are far away. As beta_j >= 0, no cut is above
        // J(x_k) at d = 0.
        const unsigned int m = size();
        return problem.solve(x,
                             alpha.head(m).cwiseAbs().cwiseMax(
                               gamma * distance.head(m).cwiseAbs2()));
      }

      /// Changes alpha_j and s_j of all subgradients from x_k to x_{k+1} = x_k
      /// + t_L d, where d is the direction of @p solution and @p d_length its
      /// length.
      void
      move(const Solution         &solution,
           const LineSearchResult &step,
           const double            d_length)
      {
        // alpha_j = J(x) - J(y_j) - eta_j'(x - y_j) changes with x by the
        // change of J less eta_j'(x_{k+1} - x_k). The way s_j grows by the
        // length of the step, whatever its direction: it is a sum of lengths.
        const unsigned int m = size();
        alpha.head(m) +=
          (step.change - step.t_L * solution.slopes.array()).matrix();
        distance.head(m).array() += step.t_L * d_length;
      }

    private:
      DirectionProblem &problem;
      Eigen::VectorXd   alpha;    ///< linearisation errors
      Eigen::VectorXd   distance; ///< s_j^k
    };



    /// Returns whether inner products with a subgradient, which the QP is made
    /// of, are finite numbers.
    bool
    is_usable(const DofVector &eta)
    {
      // Squares of larger numbers and sums of these may be infinite.
      constexpr double largest = 1e140;
      return eta.linfty_norm() < largest && std::isfinite(eta * eta);
    }



    /// Adds the wall time from its construction to its end.
    class Stopwatch
    {
    public:
      explicit Stopwatch(double &seconds)
        : seconds(seconds)
      {}

      ~Stopwatch()
      {
        seconds += timer.wall_time();
      }

    private:
      double       &seconds;
      dealii::Timer timer;
    };



    /// What to say of an end that is none with success, which @p direction, the
    /// last one, led to.
    std::string
    failure_message(const SolverStatus                status,
                    const DirectionProblem::Solution &direction,
                    const ProximalBundleParameters   &parameters)
    {
      const auto three_digits = std::setprecision(3);
      switch (status)
        {
          case SolverStatus::iteration_limit:
            return words(three_digits,
                         "proximal bundle method: predicted descent ",
                         direction.v,
                         " after ",
                         parameters.maximum_iterations,
                         " iterations, required is at least ",
                         -parameters.epsilon_s,
                         ". Try another proximal weight, more iterations, a "
                         "larger bundle or a larger stop tolerance.");
          case SolverStatus::line_search:
            return words(three_digits,
                         "line search: no subgradient with slope above m_R "
                         "v_k = ",
                         parameters.m_R * direction.v,
                         " was found, predicted descent is ",
                         direction.v,
                         ", required is at least ",
                         -parameters.epsilon_s,
                         ". Try a larger proximal weight or stop tolerance.");
          case SolverStatus::quadratic_program:
            return words(three_digits,
                         "bundle QP, which ended as '",
                         direction.status,
                         "': relative residual ",
                         direction.residual,
                         ", required is at most ",
                         Tolerance::direction,
                         ". Try a larger proximal weight (it has units: energy "
                         "per squared length) or a smaller bundle size.");
          case SolverStatus::not_finite:
            return "objective: the functional or its subgradient is not a "
                   "finite number. Check the data of the scene.";
          case SolverStatus::interrupted:
            return words(three_digits,
                         "proximal bundle method: predicted descent ",
                         direction.v,
                         ", required is at least ",
                         -parameters.epsilon_s,
                         '.');
          default: // the others are no ends of this method
            return "";
        }
    }
    /// Leaves the subgradient at @p x alone in the bundle, and returns J(x).
    /// The paper does the same every 200 steps (Section 6); here the bundle
    /// size says when.
    double
    restarted(const Functional &functional,
              const DofVector  &x,
              DofVector        &eta,
              Bundle           &bundle)
    {
      bundle.clear();
      functional.subgradient(x, eta);
      if (is_usable(eta))
        bundle.add(eta, 0., 0.);
      return functional.value(x);
    }



    /// Lists an iteration that was done with @p size subgradients.
    void
    add_iteration(const DirectionProblem::Solution &direction,
                  const LineSearchResult           &step,
                  const unsigned int                size,
                  ProximalBundleResult             &result)
    {
      result.long_steps += step.kind == StepKind::long_step;
      result.short_steps += step.kind == StepKind::short_step;
      result.null_steps += step.kind == StepKind::null_step;
      result.history.push_back({result.iterations() + 1,
                                result.functional,
                                direction.v,
                                step.t_L,
                                step.t_R,
                                size,
                                direction.steps,
                                step.kind});
    }
  } // namespace



  ProximalBundleResult
  ProximalBundle::minimize(const Functional  &functional,
                           const UpperBounds &bounds,
                           DofVector         &x,
                           const Monitor     &monitor) const
  {
    EuclideanDirection direction_problem(parameters.u,
                                         bounds,
                                         parameters.bundle_size,
                                         x);
    return minimize(functional, direction_problem, x, monitor);
  }



  ProximalBundleResult
  ProximalBundle::minimize(const Functional &functional,
                           DirectionProblem &direction_problem,
                           DofVector        &x,
                           const Monitor    &monitor) const
  {
    if (!direction_problem.is_feasible(x))
      throw std::invalid_argument(
        "The start of the bundle method must satisfy the bounds.");

    // Section 4 of the paper. At the start of iteration k, x_k is in K,
    // result.functional is J(x_k), and each eta_j of the bundle has its alpha_j
    // and s_j as seen from x_k. Phase (1), direction finding, solves Problem QP
    // for (d_k, v_k); the stop criterion is v_k >= -epsilon_s. Phase (2), line
    // search, takes t_L with (14) and, after short and null steps, t_R with
    // (15). Then
    //
    //     x_{k+1} = x_k + t_L d_k,    y_{k+1} = x_k + t_R d_k,
    //
    // and eta_{k+1} from dJ(y_{k+1}) joins the bundle. J(x_k) never rises,
    // since (14) asks for a descent and a null step keeps x_k.
    ProximalBundleResult result;
    DofVector            eta(x), d(x);
    Bundle               bundle(direction_problem, parameters.bundle_size);

    // x_1 = y_1, and again from x_k once the bundle is full: the subgradient
    // there is all that is known.
    const auto restart = [&]() {
      result.functional = restarted(functional, x, eta, bundle);
    };
    // Old subgradients may be to blame for a failure: once more without them.
    // With the subgradient at x_k alone the direction is that of steepest
    // descent in the metric, subject to the bounds.
    const auto is_restarted = [&]() {
      const bool has_old = bundle.size() > 1;
      if (has_old)
        restart();
      return has_old;
    };
    Bundle::Solution direction;
    const auto       finish = [&](const SolverStatus status) {
      result.status     = status;
      result.functional = functional.value(x);
      result.message    = failure_message(status, direction, parameters);
      return result;
    };

    restart();
    while (true)
      {
        if (!std::isfinite(result.functional) || !is_usable(eta))
          return finish(SolverStatus::not_finite);

        // Direction finding: Problem QP for (d_k, v_k).
        {
          const Stopwatch clock(result.qp_seconds);
          direction = bundle.solve(x, parameters.gamma);
        }
        result.v = direction.v;
        if (!std::isfinite(direction.v) || !direction.slopes.allFinite())
          return finish(SolverStatus::not_finite);

        // Stop criterion: v_k >= -epsilon_s, for the exact v_k too, which is
        // not below v less the duality gap. As d = 0 is feasible, a positive
        // v_k is a failure of the QP.
        if (direction.v - direction.duality_gap >= -parameters.epsilon_s &&
            direction.v <= parameters.epsilon_s)
          return finish(SolverStatus::success);
        // (14) and (15) are measured by v_k, so that a direction is used only
        // if its residual, computed from the original data, is small.
        if (direction.v > parameters.epsilon_s ||
            !(direction.residual <= Tolerance::direction))
          {
            if (is_restarted())
              continue;
            return finish(SolverStatus::quadratic_program);
          }
        result.largest_qp_residual =
          std::max(result.largest_qp_residual, direction.residual);
        if (result.iterations() >= parameters.maximum_iterations)
          return finish(SolverStatus::iteration_limit);
        double d_length;
        {
          const Stopwatch clock(result.linear_algebra_seconds);
          direction_problem.direction(d);
          d_length = direction_problem.length(d);
        }

        // Line search: t_L with (14) and t_R with (15), where eta is eta_{k+1}.
        LineSearchResult step;
        {
          const Stopwatch clock(result.objective_seconds);
          step = line_search(Functional::Line(functional, x, d),
                             d,
                             d_length,
                             direction.v,
                             parameters,
                             eta);
        }
        if (!step.success)
          {
            if (is_restarted())
              continue;
            return finish(SolverStatus::line_search);
          }
        const unsigned int size = bundle.size();

        // x_{k+1}, with alpha_j and s_j there, and the new subgradient.
        {
          const Stopwatch clock(result.linear_algebra_seconds);
          if (step.t_L > 0.)
            {
              x.add(step.t_L, d);
              direction_problem.project(x);
              // J is carried on by its changes, as its value would cost another
              // product with A; restart() and finish() evaluate it anew.
              result.functional += step.change;
              bundle.move(direction, step, d_length);
            }
          // The first term of s_{k+1} is the way from y_{k+1} back to x_{k+1}.
          if (bundle.full())
            restart();
          else if (is_usable(eta))
            bundle.add(eta, step.alpha, (step.t_R - step.t_L) * d_length);
        }

        add_iteration(direction, step, size, result);
        if (monitor && !monitor(result.history.back()))
          return finish(SolverStatus::interrupted);
      }
  }
} // namespace Debond
