// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/tolerances.h>
#include <debond/optimization/bundle/bundle_qp.h>
#include <debond/optimization/bundle/line_search.h>
#include <debond/optimization/bundle/proximal_bundle.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

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
        const unsigned int j   = size();
        DofVector         &cut = subgradients[j];
        cut                    = eta;

        Eigen::VectorXd bounded(bounds.indices.size());
        for (unsigned int i = 0; i < bounds.indices.size(); ++i)
          {
            bounded(i)             = cut(bounds.indices[i]);
            cut(bounds.indices[i]) = 0.;
          }
        Eigen::VectorXd products(j + 1);
        for (unsigned int k = 0; k <= j; ++k)
          products(k) = subgradients[k] * cut;
        qp.add_cut(products, bounded);
      }

      const Solution &
      solve(const DofVector &x, const Eigen::VectorXd &beta) override
      {
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



    /// Whether inner products with a subgradient, which the QP is made of, are
    /// finite numbers.
    bool
    is_usable(const DofVector &eta)
    {
      constexpr double largest = 1e140;
      return eta.linfty_norm() < largest && std::isfinite(eta * eta);
    }



    std::string
    failure_message(const SolverStatus              status,
                    const double                    v,
                    const double                    qp_residual,
                    const std::string              &qp_status,
                    const ProximalBundleParameters &parameters)
    {
      std::ostringstream text;
      text.precision(3);
      switch (status)
        {
          case SolverStatus::iteration_limit:
            text << "proximal bundle method: predicted descent " << v
                 << " after " << parameters.maximum_iterations
                 << " iterations, required is at least "
                 << -parameters.epsilon_s
                 << ". Try another proximal weight, more iterations, a larger "
                    "bundle or a larger stop tolerance.";
            break;
          case SolverStatus::line_search:
            text << "line search: no subgradient with slope above m_R v_k = "
                 << parameters.m_R * v << " was found, predicted descent is "
                 << v << ", required is at least " << -parameters.epsilon_s
                 << ". Try a larger proximal weight or stop tolerance.";
            break;
          case SolverStatus::quadratic_program:
            text
              << "bundle QP, which ended as '" << qp_status
              << "': relative residual " << qp_residual
              << ", required is at most " << Tolerance::direction
              << ". Try a larger proximal weight (it has units: energy per squared "
                 "length) or a smaller bundle size.";
            break;
          case SolverStatus::not_finite:
            text << "objective: the functional or its subgradient is not a "
                    "finite number. Check the data of the scene.";
            break;
          case SolverStatus::interrupted:
            text << "proximal bundle method: predicted descent " << v
                 << ", required is at least " << -parameters.epsilon_s << '.';
            break;
          case SolverStatus::stagnated:  // has no test for it
          case SolverStatus::no_descent: // the line search sees to it
          case SolverStatus::comes_off:  // only supported bodies get here
          case SolverStatus::success:
            break;
        }
      return text.str();
    }
  } // namespace



  ProximalBundleResult
  ProximalBundle::minimize(const Objective   &objective,
                           const UpperBounds &bounds,
                           DofVector         &x,
                           const Monitor     &monitor) const
  {
    EuclideanDirection direction_problem(parameters.u,
                                         bounds,
                                         parameters.bundle_size,
                                         x);
    return minimize(objective, direction_problem, x, monitor);
  }



  ProximalBundleResult
  ProximalBundle::minimize(const Objective  &objective,
                           DirectionProblem &direction_problem,
                           DofVector        &x,
                           const Monitor    &monitor) const
  {
    if (!direction_problem.is_feasible(x))
      throw std::invalid_argument(
        "The start of the bundle method must satisfy the bounds.");

    ProximalBundleResult result;

    dealii::Timer qp_timer, objective_timer, algebra_timer;
    qp_timer.stop();
    objective_timer.stop();
    algebra_timer.stop();

    DofVector eta(x), d(x);

    Bundle     bundle(direction_problem, parameters.bundle_size);
    const auto restart = [&]() {
      bundle.clear();
      result.functional = objective.value(x);
      objective.subgradient(x, eta);
      if (is_usable(eta))
        bundle.add(eta, 0., 0.);
    };
    restart();

    const Bundle::Solution *direction = nullptr;
    while (true)
      {
        if (!std::isfinite(result.functional) || !is_usable(eta))
          {
            result.status = SolverStatus::not_finite;
            break;
          }
        qp_timer.start();
        direction = &bundle.solve(x, parameters.gamma);
        qp_timer.stop();
        result.v = direction->v;
        if (!std::isfinite(result.v) || !direction->slopes.allFinite())
          {
            result.status = SolverStatus::not_finite;
            break;
          }

        // d = 0 is feasible, so a positive v is a failure of the QP.
        if (result.v - direction->duality_gap >= -parameters.epsilon_s &&
            result.v <= parameters.epsilon_s)
          {
            result.status = SolverStatus::success;
            break;
          }
        if (result.v > parameters.epsilon_s ||
            !(direction->residual <= Tolerance::direction))
          {
            // Old subgradients may be to blame: once more without them.
            if (bundle.size() > 1)
              {
                restart();
                continue;
              }
            result.status = SolverStatus::quadratic_program;
            break;
          }
        result.largest_qp_residual =
          std::max(result.largest_qp_residual, direction->residual);
        if (result.iterations() >= parameters.maximum_iterations)
          {
            result.status = SolverStatus::iteration_limit;
            break;
          }

        algebra_timer.start();
        direction_problem.direction(d);
        const double d_length = direction_problem.length(d);
        algebra_timer.stop();

        objective_timer.start();
        const auto             line = objective.along(x, d);
        const LineSearchResult step =
          line_search(*line, d, d_length, result.v, parameters, eta);
        objective_timer.stop();
        if (!step.success)
          {
            // Old subgradients may be to blame: once more without them.
            if (bundle.size() > 1)
              {
                restart();
                continue;
              }
            result.status = SolverStatus::line_search;
            break;
          }

        BundleIteration iteration;
        iteration.iteration   = result.iterations() + 1;
        iteration.v           = result.v;
        iteration.t_L         = step.t_L;
        iteration.t_R         = step.t_R;
        iteration.bundle_size = bundle.size();
        iteration.qp_steps    = direction->steps;
        iteration.kind        = step.kind;

        algebra_timer.start();
        if (step.t_L > 0.)
          {
            x.add(step.t_L, d);
            direction_problem.project(x);
            result.functional += step.change;
            bundle.move(*direction, step, d_length);
          }

        if (bundle.full())
          restart();
        else if (is_usable(eta))
          bundle.add(eta, step.alpha, (step.t_R - step.t_L) * d_length);
        algebra_timer.stop();

        result.long_steps += step.kind == StepKind::long_step;
        result.short_steps += step.kind == StepKind::short_step;
        result.null_steps += step.kind == StepKind::null_step;
        iteration.functional = result.functional;
        result.history.push_back(iteration);
        if (monitor && !monitor(iteration))
          {
            result.status = SolverStatus::interrupted;
            break;
          }
      }

    result.functional = objective.value(x);
    if (result.status != SolverStatus::success)
      result.message =
        failure_message(result.status,
                        result.v,
                        direction != nullptr ? direction->residual : 0.,
                        direction != nullptr ? direction->status :
                                               "not started",
                        parameters);
    result.qp_seconds             = qp_timer.wall_time();
    result.objective_seconds      = objective_timer.wall_time();
    result.linear_algebra_seconds = algebra_timer.wall_time();
    return result;
  }

} // namespace Debond
