// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/bound_qp.h>
#include <debond/optimization/majorise_minimise.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Debond
{
  namespace
  {
    using Map = Eigen::Map<const Eigen::VectorXd>;

    Map
    as_eigen(const dealii::Vector<double> &v)
    {
      return Map(v.begin(), v.size());
    }



    /// Largest violation of  S s + xi - g + mu = 0,  mu >= 0,  s <= 0,  mu's
    /// = 0, relative to the largest term of the first.
    double
    optimality_residual(const Eigen::VectorXd &S_s,
                        const Eigen::VectorXd &xi,
                        const Eigen::VectorXd &g,
                        const Eigen::VectorXd &s)
    {
      const double largest_force = std::max({S_s.lpNorm<Eigen::Infinity>(),
                                             xi.lpNorm<Eigen::Infinity>(),
                                             g.lpNorm<Eigen::Infinity>()});
      double       residual      = 0.;
      for (unsigned int i = 0; i < s.size(); ++i)
        {
          const double mu = g(i) - S_s(i) - xi(i);
          residual        = std::max(residual, s(i) < 0. ? std::abs(mu) : -mu);
        }
      return largest_force > 0. ? residual / largest_force : 0.;
    }
  } // namespace



  MajoriseMinimise::MajoriseMinimise(
    const MajoriseMinimiseParameters &mm_parameters)
    : parameters(mm_parameters)
  {}



  MajoriseMinimiseResult
  MajoriseMinimise::minimize(const dealii::FullMatrix<double> &S,
                             const dealii::Vector<double>     &g,
                             const PiecewiseQuadratic         &phi,
                             dealii::Vector<double>           &s,
                             const Monitor                    &monitor) const
  {
    const unsigned int     n = s.size();
    MajoriseMinimiseResult result;

    dealii::FullMatrix<double> M(n, n);
    dealii::Vector<double>     xi(n), product(n);
    Eigen::VectorXd            S_s(n);
    const auto                 evaluate = [&]() {
      if (n > 0)
        S.vmult(product, s);
      S_s = as_eigen(product);
      result.functional =
        as_eigen(s).dot(0.5 * S_s - as_eigen(g)) + phi.value(s);
      phi.subgradient(s, xi);
      result.residual =
        optimality_residual(S_s, as_eigen(xi), as_eigen(g), as_eigen(s));
    };
    evaluate();

    ActiveSet active(n);
    for (unsigned int i = 0; i < n; ++i)
      active[i] = s(i) == 0.;

    while (true)
      {
        if (!std::isfinite(result.residual))
          {
            result.status = SolverStatus::not_finite;
            result.message =
              "objective: the functional or its subgradient is "
              "not a finite number. Check the data of the scene.";
            return result;
          }
        if (result.residual <= parameters.tolerance)
          {
            result.status = SolverStatus::success;
            return result;
          }
        if (result.history.size() == parameters.maximum_iterations)
          break;

        // Branches at s_k: Phi <= Phi(s_k) + xi'(s - s_k)
        //                        + 1/2 (s - s_k)'E (s - s_k).
        M = 0.;
        phi.add_curvature(s, M);
        if (n > 0)
          M.vmult(product, s);
        M.add(1., S);
        const Eigen::Map<const Eigen::MatrixXd> M_eigen(
          n > 0 ? &M(0, 0) : nullptr, n, n);
        const BoundQPResult qp =
          solve_bound_qp(M_eigen,
                         as_eigen(g) - as_eigen(xi) + as_eigen(product),
                         Eigen::VectorXd::Zero(n),
                         active);
        if (!qp.converged)
          {
            result.status = SolverStatus::quadratic_program;
            result.message =
              "majorise-minimise: the active set of the convex subproblem did "
              "not settle after " +
              std::to_string(qp.steps) + " steps. Try another method.";
            return result;
          }
        std::copy(qp.x.begin(), qp.x.end(), s.begin());
        evaluate();

        MajoriseMinimiseIteration iteration;
        iteration.iteration        = result.history.size() + 1;
        iteration.functional       = result.functional;
        iteration.residual         = result.residual;
        iteration.active_set_steps = qp.steps;
        iteration.n_active = std::count(active.begin(), active.end(), 1);
        result.history.push_back(iteration);
        if (monitor && !monitor(iteration))
          {
            result.status = SolverStatus::interrupted;
            break;
          }
      }

    std::ostringstream text;
    text.precision(3);
    text << "majorise-minimise: relative residual " << result.residual
         << " after " << result.history.size() << " iterations, required is "
         << parameters.tolerance << '.';
    if (result.status == SolverStatus::iteration_limit)
      text << " Try more iterations.";
    result.message = text.str();
    return result;
  }
} // namespace Debond
