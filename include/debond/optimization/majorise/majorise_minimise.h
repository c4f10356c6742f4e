// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_majorise_majorise_minimise_h
#define debond_optimization_majorise_majorise_minimise_h

#include <debond/optimization/status.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace Debond
{
  /**
   * What majorise-minimise needs of a functional
   *
   *     J(x) = q(x) + Phi(s),  s <= 0,
   *
   * q a convex quadratic, s some components of x and Phi a
   * PiecewiseQuadratic: the current point x, and a solver for the convex
   * problem in which Phi is replaced by the Majorant at a point.
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
      double largest_force; ///< the largest of these terms

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

      /// The operations of dense factorisations (BoundQPResult::operations).
      double operations = 0.;
    };

    /// Moves the current point towards the minimum of the majorant until the
    /// majorant's optimality conditions hold to @p tolerance, in the measure
    /// of State::residual.
    virtual Minimisation
    minimise(const double tolerance) = 0;
  };



  struct MajoriseMinimiseParameters
  {
    /// Stop if the optimality conditions hold to this part of their largest
    /// terms.
    double tolerance = 1e-10;

    unsigned int maximum_iterations = 5000;

    /// Violations below are rounding, of forces that may act at other times:
    /// without any force there is nothing else that they are small beside.
    double zero_force = 0.;
  };



  struct MajoriseMinimiseIteration
  {
    unsigned int iteration;         ///< from 1
    double       functional;        ///< J
    double       residual;          ///< of the optimality conditions, relative
    unsigned int active_set_steps;  ///< linear systems of the inner QP
    unsigned int linear_iterations; ///< for them, 0 if they were factorised
    unsigned int n_active;          ///< bounds that are active
    double       operations = 0.;   ///< of dense factorisations
  };



  struct MajoriseMinimiseResult
  {
    SolverStatus status     = SolverStatus::iteration_limit;
    double       functional = 0.;
    double       residual   = 0.;

    std::vector<MajoriseMinimiseIteration> history;

    /// For any status but success: component, reached and required figure,
    /// and what to try.
    std::string message;
  };



  /**
   * Majorise-minimise for the functional of a MajorantProblem: Phi is replaced
   * by its Majorant at the current point, which lies above it, and the convex
   * problem that is left is solved, exactly or until what its solver leaves is
   * a tenth of the residual it started from. The functional never rises; as
   * there are finitely many pieces, the method ends at a point that is the
   * minimum of its own majorant and so satisfies the optimality conditions
   * (for quadrature points that move with s, and where Phi softens, it
   * converges in the limit).
   *
   * See Hunter, Lange, "A tutorial on MM algorithms", Amer. Statist. 58 (2004).
   */
  class MajoriseMinimise
  {
  public:
    using Monitor = std::function<bool(const MajoriseMinimiseIteration &)>;

    explicit MajoriseMinimise(const MajoriseMinimiseParameters &mm_parameters)
      : parameters(mm_parameters)
    {}

    /// Improves the problem's current point.
    MajoriseMinimiseResult
    minimize(MajorantProblem &problem, const Monitor &monitor = {}) const;

    /// Returns whether a point in this state ends the method with success.
    bool
    has_converged(const MajorantProblem::State &state) const
    {
      return state.residual <=
             std::max(parameters.tolerance, state.residual_rounding);
    }

  private:
    MajoriseMinimiseParameters parameters;
  };
} // namespace Debond

#endif
