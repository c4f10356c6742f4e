// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_bundle_proximal_bundle_h
#define debond_optimization_bundle_proximal_bundle_h

#include <debond/optimization/bundle/direction_problem.h>
#include <debond/optimization/bundle/functional.h>
#include <debond/optimization/status.h>

namespace Debond
{
  enum class StepKind
  {
    long_step,
    short_step,
    null_step
  };

  std::string
  to_string(const StepKind kind);



  /// Which of the steps with (14) is taken; the paper leaves it open.
  enum class DescentRule
  {
    largest, ///< the largest in [0, 1], by bisection: the paper's words
    halving, ///< the first of 1, 1/2, 1/4, ...
    minimum  ///< on along that sequence while J falls, then a parabola
  };



  /// The parameters of the paper's Section 4, with its symbols.
  struct ProximalBundleParameters
  {
    /// u_k: weight of the proximal term, in units of the objective over the
    /// square of those of x.
    double u = 8e-4;

    /// gamma: weight of the distance in the subgradient locality measure, in
    /// the units of u.
    double gamma = 0.5;

    /// t_bar: step lengths below it make short steps; in (0, 1].
    double t_bar = 0.003;

    /// m_L: part of the predicted descent that a step has to reach, eq. (14);
    /// in (0, 1/2).
    double m_L = 0.001;

    /// m_R: part of the predicted slope that a new subgradient has to exceed,
    /// eq. (15); in (m_L, 1).
    double m_R = 0.5;

    /// Which step with (14) the line search takes.
    DescentRule line_search = DescentRule::minimum;

    /// epsilon_s: stop if v_k >= -epsilon_s; in units of the objective.
    double epsilon_s = 1e-13;

    /// Subgradients kept before the bundle is emptied and the method starts
    /// again from x_k (Section 6).
    unsigned int bundle_size = 200;

    unsigned int maximum_iterations = 40000;
  };



  /// One iteration, for histories and progress lines.
  struct BundleIteration
  {
    unsigned int iteration;   ///< from 1
    double       functional;  ///< J(x_{k+1})
    double       v;           ///< v_k, the predicted descent (negative)
    double       t_L;         ///< step length taken, 0 for a null step
    double       t_R;         ///< where the new subgradient was computed
    unsigned int bundle_size; ///< subgradients in the direction problem
    unsigned int qp_steps;    ///< changes of the working set in the QP
    StepKind     kind;
  };



  struct ProximalBundleResult
  {
    SolverStatus                 status      = SolverStatus::iteration_limit;
    double                       functional  = 0.; ///< J(x)
    double                       v           = 0.; ///< last v_k
    unsigned int                 long_steps  = 0;
    unsigned int                 short_steps = 0;
    unsigned int                 null_steps  = 0;
    double                       largest_qp_residual = 0.; ///< relative
    std::vector<BundleIteration> history;

    /// For any status but success: component, reached and required figure,
    /// and what to try.
    std::string message;

    /// Wall seconds by part.
    double qp_seconds             = 0.;
    double objective_seconds      = 0.;
    double linear_algebra_seconds = 0.;

    unsigned int
    iterations() const
    {
      return static_cast<unsigned int>(history.size());
    }
  };



  /**
   * The proximal bundle method of the paper's Section 4 for
   *
   *     min J(x)  subject to  x in K = {x : x_i <= upper_i, i in bounds}
   *
   * with the Euclidean proximal term, the subgradient locality measure, long,
   * short and null steps, and the bundle emptied when it is full.
   */
  class ProximalBundle
  {
  public:
    /// Called after each iteration; returning false ends the method with
    /// SolverStatus::interrupted.
    using Monitor = std::function<bool(const BundleIteration &)>;

    explicit ProximalBundle(const ProximalBundleParameters &parameters)
      : parameters(parameters)
    {}

    /// Improves x. Throws std::invalid_argument if x is not in K.
    ProximalBundleResult
    minimize(const Functional  &functional,
             const UpperBounds &bounds,
             DofVector         &x,
             const Monitor     &monitor = {}) const;

    /// Minimises in the metric of @p direction_problem, which also knows K and
    /// has to have room for `bundle_size` subgradients; the parameter u is not
    /// used. The method is one, whatever the metric.
    ProximalBundleResult
    minimize(const Functional &functional,
             DirectionProblem &direction_problem,
             DofVector        &x,
             const Monitor    &monitor = {}) const;

  private:
    ProximalBundleParameters parameters;
  };
} // namespace Debond

#endif
