// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_majorise_majorant_problem_h
#define debond_optimization_majorise_majorant_problem_h

#include <debond/optimization/status.h>

namespace Debond
{
  /**
   * What majorise-minimise needs of a functional
   *
   *     J(x) = q(x) + Phi(s),  s <= 0,
   *
   * q a convex quadratic, s some components of x and Phi a
   * PiecewiseQuadratic: the current point x, and a solver for the convex
   * problem in which Phi is replaced by its branch at a point.
   */
  class MajorantProblem
  {
  public:
    virtual ~MajorantProblem() = default;

    struct State
    {
      double functional;          ///< J
      double functional_rounding; ///< what rounding can change in J

      /// Largest violation of the optimality conditions, relative to their
      /// largest terms, and the part of it that rounding leaves.
      double residual;
      double residual_rounding;

      unsigned int n_active; ///< components of s that are zero
    };

    /// Evaluates the current point from the original data.
    virtual State
    evaluate() = 0;

    /// The majorant is the one that touches J at the current point from now
    /// on. Returns false if that is known to be the one of before.
    virtual bool
    majorise() = 0;

    struct Minimisation
    {
      /// success, stagnated, quadratic_program, or with the current point as
      /// it was before comes_off (there is no minimum) or interrupted.
      SolverStatus status;

      unsigned int active_set_steps;  ///< linear systems
      unsigned int linear_iterations; ///< for all of them, 0 if factorised
    };

    /// Moves the current point towards the minimum of the majorant until the
    /// majorant's optimality conditions hold to @p tolerance, in the measure
    /// of State::residual.
    virtual Minimisation
    minimise(const double tolerance) = 0;
  };
} // namespace Debond

#endif
