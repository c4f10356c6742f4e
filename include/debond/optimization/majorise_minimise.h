// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_majorise_minimise_h
#define debond_optimization_majorise_minimise_h

#include <debond/optimization/piecewise_quadratic.h>
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
    unsigned int iteration;        ///< from 1
    double       functional;       ///< 1/2 s'S s - g's + Phi(s)
    double       residual;         ///< of the optimality conditions, relative
    unsigned int active_set_steps; ///< factorisations of the inner QP
    unsigned int n_active;         ///< bounds that are active
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
   * Majorise-minimise for
   *
   *     min 1/2 s'S s - g's + Phi(s)  subject to  s <= 0,
   *
   * S symmetric positive definite: Phi is replaced by its branch at the
   * current s, which lies above it, and the convex problem that is left is
   * solved exactly by active sets. The functional never rises; as there are
   * finitely many branches, the method ends at a point that is the minimum of
   * its own majorant and so satisfies the optimality conditions (for
   * quadrature points that move with s it converges in the limit).
   *
   * See Hunter, Lange, "A tutorial on MM algorithms", Amer. Statist. 58 (2004).
   */
  class MajoriseMinimise
  {
  public:
    using Monitor = std::function<bool(const MajoriseMinimiseIteration &)>;

    explicit MajoriseMinimise(const MajoriseMinimiseParameters &parameters);

    /// Improves s, which has to be <= 0.
    MajoriseMinimiseResult
    minimize(const dealii::FullMatrix<double> &S,
             const dealii::Vector<double>     &g,
             const PiecewiseQuadratic         &phi,
             dealii::Vector<double>           &s,
             const Monitor                    &monitor = {}) const;

  private:
    MajoriseMinimiseParameters parameters;
  };
} // namespace Debond

#endif
