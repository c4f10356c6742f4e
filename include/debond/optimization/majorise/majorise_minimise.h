// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_majorise_majorise_minimise_h
#define debond_optimization_majorise_majorise_minimise_h

#include <debond/optimization/majorise/majorant_problem.h>
#include <debond/optimization/status.h>

#include <functional>
#include <string>
#include <vector>

namespace Debond
{
  struct MajoriseMinimiseParameters
  {
    /// Stop if the optimality conditions hold to this part of their largest
    /// terms.
    double tolerance = 1e-10;

    unsigned int maximum_iterations = 200;
  };



  struct MajoriseMinimiseIteration
  {
    unsigned int iteration;         ///< from 1
    double       functional;        ///< J
    double       residual;          ///< of the optimality conditions, relative
    unsigned int active_set_steps;  ///< linear systems of the inner QP
    unsigned int linear_iterations; ///< for them, 0 if they were factorised
    unsigned int n_active;          ///< bounds that are active
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
   * by its branch at the current point, which lies above it, and the convex
   * problem that is left is solved, exactly or until what its solver leaves is
   * a tenth of the residual it started from. The functional never rises; as
   * there are finitely many branches, the method ends at a point that is the
   * minimum of its own majorant and so satisfies the optimality conditions
   * (for quadrature points that move with s it converges in the limit).
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

    /// Whether a point in this state ends the method with success.
    bool
    has_converged(const MajorantProblem::State &state) const;

  private:
    MajoriseMinimiseParameters parameters;
  };
} // namespace Debond

#endif
