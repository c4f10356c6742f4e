// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/majorise/majorise_minimise.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace Debond
{
  namespace
  {
    /// What an inexact minimisation of the majorant may leave of the residual.
    constexpr double forcing = 0.1;



    std::string
    what_is_left(const MajoriseMinimiseResult &result, const double required)
    {
      std::ostringstream text;
      text.precision(3);
      text << "majorise-minimise: relative residual " << result.residual
           << " after " << result.history.size() << " iterations, required is "
           << required << '.';
      return text.str();
    }
  } // namespace



  MajoriseMinimiseResult
  MajoriseMinimise::minimize(MajorantProblem &problem,
                             const Monitor   &monitor) const
  {
    MajoriseMinimiseResult result;
    MajorantProblem::State state       = problem.evaluate();
    bool                   interrupted = false;
    while (true)
      {
        result.functional = state.functional;
        result.residual   = state.residual;
        if (!std::isfinite(state.residual))
          {
            result.status = SolverStatus::not_finite;
            result.message =
              "objective: the functional or its subgradient is "
              "not a finite number. Check the data of the scene.";
            return result;
          }
        if (has_converged(state))
          {
            result.status = SolverStatus::success;
            return result;
          }
        // What is converged is a result, whenever the signal came.
        if (interrupted)
          {
            result.status = SolverStatus::interrupted;
            break;
          }
        if (result.history.size() == parameters.maximum_iterations)
          break;

        MajoriseMinimiseIteration iteration = {};
        iteration.iteration =
          static_cast<unsigned int>(result.history.size()) + 1;

        const double tolerance =
          std::max(parameters.tolerance, state.residual_rounding);
        // As long as the majorant changes it needs no exact minimum.
        double     inner_tolerance = 0.5 * tolerance;
        const bool new_majorant    = problem.majorise();
        if (new_majorant)
          inner_tolerance = std::max(inner_tolerance, forcing * state.residual);
        const double previous_residual = state.residual;
        const double upper = state.functional + state.functional_rounding;
        do
          {
            const MajorantProblem::Minimisation inner =
              problem.minimise(inner_tolerance);
            iteration.active_set_steps += inner.active_set_steps;
            iteration.linear_iterations += inner.linear_iterations;
            iteration.operations += inner.operations;
            if (inner.status == SolverStatus::interrupted)
              {
                result.status  = SolverStatus::interrupted;
                result.message = what_is_left(result, parameters.tolerance);
                return result;
              }
            if (inner.status == SolverStatus::comes_off)
              {
                result.status = SolverStatus::comes_off;
                result.message =
                  "neither the bonds that are left nor the foundation hold the "
                  "body: J falls without end.";
                return result;
              }
            if (!can_be_verified(inner.status))
              {
                std::ostringstream text;
                text.precision(3);
                text << "majorise-minimise: the convex subproblem of iteration "
                     << iteration.iteration << " was not solved to "
                     << inner_tolerance << " in " << iteration.active_set_steps
                     << " active-set steps. Try another method.";
                result.status  = SolverStatus::quadratic_program;
                result.message = text.str();
                return result;
              }
            state = problem.evaluate();
            inner_tolerance *= forcing;
          }
        while (state.functional > upper + state.functional_rounding &&
               inner_tolerance > 0.01 * tolerance);
        // Where the optimality conditions hold, J has no more to fall.
        const bool is_converged = has_converged(state);
        const bool risen =
          state.functional > upper + state.functional_rounding && !is_converged;

        iteration.functional = result.functional = state.functional;
        iteration.residual = result.residual = state.residual;
        iteration.n_active                   = state.n_active;
        result.history.push_back(iteration);
        if (risen)
          {
            std::ostringstream text;
            text.precision(3);
            text << "majorise-minimise: J rose by " << state.functional - upper
                 << " in iteration " << iteration.iteration
                 << ", with the relative residual " << state.residual
                 << ", required is " << parameters.tolerance
                 << ". Try a larger stop tolerance or another method.";
            result.status  = SolverStatus::no_descent;
            result.message = text.str();
            return result;
          }
        // The minimum of the same majorant once more, and no better: this is
        // what rounding leaves.
        if (!new_majorant && !is_converged &&
            state.residual > 0.5 * previous_residual)
          {
            result.status  = SolverStatus::stagnated;
            result.message = what_is_left(result, parameters.tolerance) +
                             " To minimise the same majorant again leaves no "
                             "less.";
            return result;
          }
        interrupted = monitor && !monitor(iteration);
      }

    result.message = what_is_left(result, parameters.tolerance);
    if (result.status == SolverStatus::iteration_limit)
      result.message += " Try more iterations.";
    return result;
  }
} // namespace Debond
