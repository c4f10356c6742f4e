// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/text.h>
#include <debond/optimization/majorise/majorise_minimise.h>

#include <cmath>

namespace Debond
{
  namespace
  {
    /// What an inexact minimisation of the majorant may leave of the residual.
    constexpr double forcing = 0.1;



    std::string
    what_is_left(const MajoriseMinimiseResult &result, const double required)
    {
      return words(std::setprecision(3),
                   "majorise-minimise: relative residual ",
                   result.residual,
                   " after ",
                   result.history.size(),
                   " iterations, required is ",
                   required,
                   '.');
    }
    /// The state of the current point. Without loads, or with loads that are
    /// rounding, the largest force is no scale: then forces below @p zero_force
    /// count as rounding.
    MajorantProblem::State
    evaluated(MajorantProblem &problem, const double zero_force)
    {
      MajorantProblem::State state = problem.evaluate();
      if (state.largest_force > 0.)
        state.residual_rounding =
          std::max(state.residual_rounding, zero_force / state.largest_force);
      return state;
    }



    /// What a minimisation of the majorant of this @p iteration was short of.
    std::string
    unsolved(const MajoriseMinimiseIteration &iteration, const double required)
    {
      return words(std::setprecision(3),
                   "majorise-minimise: the convex subproblem of iteration ",
                   iteration.iteration,
                   " was not solved to ",
                   required,
                   " in ",
                   iteration.active_set_steps,
                   " active-set steps. Try another method.");
    }



    std::string
    has_risen_by(const double                     rise,
                 const MajoriseMinimiseIteration &iteration,
                 const double                     required)
    {
      return words(std::setprecision(3),
                   "majorise-minimise: J rose by ",
                   rise,
                   " in iteration ",
                   iteration.iteration,
                   ", with the relative residual ",
                   iteration.residual,
                   ", required is ",
                   required,
                   ". Try a larger stop tolerance or another method.");
    }
  } // namespace



  MajoriseMinimiseResult
  MajoriseMinimise::minimize(MajorantProblem &problem,
                             const Monitor   &monitor) const
  {
    MajoriseMinimiseResult result;
    const auto             finish = [&result](const SolverStatus status,
                                  const std::string &text = "") {
      result.status  = status;
      result.message = text;
      return result;
    };
    const auto left = [&]() {
      return what_is_left(result, parameters.tolerance);
    };
    const auto evaluate = [&]() {
      return evaluated(problem, parameters.zero_force);
    };
    MajorantProblem::State state = evaluate();
    const auto             note  = [&]() {
      result.functional = state.functional;
      result.residual   = state.residual;
    };
    // For the majorant that touches J at x_k,
    //
    //     J(x_{k+1}) <= majorant(x_{k+1}) <= majorant(x_k) = J(x_k):
    //
    // the first step because it is nowhere below J, the second because x_{k+1}
    // minimises it. So J never rises, but for rounding.
    bool interrupted = false;
    while (true)
      {
        note();
        if (!std::isfinite(state.residual))
          return finish(SolverStatus::not_finite,
                        "objective: the functional or its subgradient is "
                        "not a finite number. Check the data of the scene.");
        if (has_converged(state))
          return finish(SolverStatus::success);
        // A converged point is a result, whenever the signal came.
        if (interrupted)
          return finish(SolverStatus::interrupted, left());
        if (result.history.size() == parameters.maximum_iterations)
          return finish(SolverStatus::iteration_limit,
                        left() + " Try more Maximum iterations.");

        // Majorise. As long as the majorant changes it needs no exact minimum.
        // If it is the one before, x is its minimum but for what the last
        // minimisation has left, and only that has to become less. The state
        // before is what this iteration is compared with.
        const MajorantProblem::State before = state;
        const bool                   is_new = problem.majorise();
        const double                 tolerance =
          std::max(parameters.tolerance, state.residual_rounding);
        double inner_tolerance =
          is_new ? std::max(0.5 * tolerance, forcing * state.residual) :
                   0.5 * tolerance;

        // Minimise, and better if J has risen, as it may where a minimum of the
        // majorant is not exact. A rise counts only beyond the rounding of both
        // values, as the last steps change J by less than that.
        const auto has_risen = [&]() {
          return state.functional > before.functional +
                                      before.functional_rounding +
                                      state.functional_rounding;
        };
        MajoriseMinimiseIteration iteration = {};
        iteration.iteration =
          static_cast<unsigned int>(result.history.size()) + 1;
        // Each repetition asks for a tenth of the residual. It goes on to a
        // hundredth of what is required, below which rounding makes the
        // difference.
        do
          {
            const MajorantProblem::Minimisation inner =
              problem.minimise(inner_tolerance);
            iteration.active_set_steps += inner.active_set_steps;
            iteration.linear_iterations += inner.linear_iterations;
            iteration.operations += inner.operations;
            if (inner.status == SolverStatus::interrupted)
              return finish(SolverStatus::interrupted, left());
            if (inner.status == SolverStatus::comes_off)
              return finish(
                SolverStatus::comes_off,
                "neither the bonds and friction that are left nor the "
                "foundation hold the body: J falls without end.");
            if (!can_be_verified(inner.status))
              return finish(SolverStatus::quadratic_program,
                            unsolved(iteration, inner_tolerance));
            state = evaluate();
            inner_tolerance *= forcing;
          }
        while (has_risen() && inner_tolerance > 0.01 * tolerance);

        note();
        // A step that fails the tests below is in the history, too.
        iteration.functional = state.functional;
        iteration.residual   = state.residual;
        iteration.n_active   = state.n_active;
        result.history.push_back(iteration);
        // Where the optimality conditions hold, J has no more to fall.
        if (has_risen() && !has_converged(state))
          return finish(SolverStatus::no_descent,
                        has_risen_by(state.functional - before.functional -
                                       before.functional_rounding,
                                     iteration,
                                     parameters.tolerance));
        // The minimum of the same majorant once more, and no better: this is
        // what rounding leaves.
        if (!is_new && !has_converged(state) &&
            state.residual > 0.5 * before.residual)
          return finish(SolverStatus::stagnated,
                        left() +
                          " To minimise the same majorant again leaves no "
                          "less.");
        interrupted = monitor && !monitor(iteration);
      }
  }
} // namespace Debond
