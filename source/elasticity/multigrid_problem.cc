// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>

#include <debond/elasticity/multigrid_problem.h>
#include <debond/linear_algebra/eigen_view.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Debond
{
  namespace
  {
    /// What a linear system may leave of the residual that it started with,
    /// while the active set still changes.
    constexpr double linear_reduction = 0.1;

    constexpr unsigned int maximum_linear_iterations = 2000;
    constexpr unsigned int maximum_linear_systems    = 500;
  } // namespace



  /// A + E on the free unknowns.
  template <int dim>
  class MultigridProblem<dim>::Operator
  {
  public:
    explicit Operator(const MultigridProblem &problem)
      : problem(problem)
    {}

    void
    vmult(dealii::Vector<double> &dst, const dealii::Vector<double> &src) const
    {
      problem.A.vmult(dst, src);
      const dealii::Vector<double> s     = problem.contact.trace(src);
      const Eigen::VectorXd        force = problem.E * eigen_view(s);
      for (unsigned int i = 0; i < s.size(); ++i)
        dst(problem.normals[i]) += force(i);
      problem.restrict_to_free(dst);
    }

  private:
    const MultigridProblem &problem;
  };



  /// The V-cycle of A on the free unknowns.
  template <int dim>
  class MultigridProblem<dim>::Preconditioner
  {
  public:
    explicit Preconditioner(const MultigridProblem &problem)
      : problem(problem)
    {}

    void
    vmult(dealii::Vector<double> &dst, const dealii::Vector<double> &src) const
    {
      problem.multigrid.vmult(dst, src);
      problem.restrict_to_free(dst);
    }

  private:
    const MultigridProblem &problem;
  };



  template <int dim>
  MultigridProblem<dim>::MultigridProblem(
    const ElasticProblem<dim>   &elastic_problem,
    const PiecewiseQuadratic    &nonsmooth,
    const Multigrid             &preconditioner,
    dealii::Vector<double>      &start,
    const std::function<bool()> &go_on)
    : A(elastic_problem.trilinos_matrix())
    , f(elastic_problem.load())
    , phi(nonsmooth)
    , multigrid(preconditioner)
    , u(start)
    , may_go_on(go_on ? go_on : []() { return true; })
    , contact(elastic_problem.unknowns().contact())
    , normals(contact.normals())
    , active(contact.size())
  {
    diagonal.reinit(u);
    for (unsigned int i = 0; i < u.size(); ++i)
      diagonal(i) = A.diag_element(i);
    const dealii::Vector<double> s = contact.trace(u);
    for (unsigned int i = 0; i < s.size(); ++i)
      active[i] = s(i) == 0.;
  }



  template <int dim>
  MajorantProblem::State
  MultigridProblem<dim>::evaluate()
  {
    dealii::Vector<double> internal(u.size());
    A.vmult(internal, u);
    const dealii::Vector<double> s = contact.trace(u);
    dealii::Vector<double>       xi(s.size());
    phi.subgradient(s, xi);

    State        state;
    const double energy   = 0.5 * (internal * u);
    const double work     = f * u;
    const double adhesion = phi.value(s);
    state.functional      = energy - work + adhesion;

    // The terms of a row of A u are as large as diagonal times displacement,
    // and cancel.
    dealii::Vector<double> terms = diagonal;
    terms.scale(u);
    force_rounding =
      4. * std::numeric_limits<double>::epsilon() * terms.l2_norm();
    state.functional_rounding = force_rounding * u.l2_norm();

    dealii::Vector<double> violation = f;
    violation -= internal;
    // Vectors without entries have no norm in deal.II.
    const double adhesive_force = xi.size() == 0 ? 0. : xi.l2_norm();
    largest_force = std::max({f.l2_norm(), internal.l2_norm(), adhesive_force});
    state.n_active = 0;
    for (unsigned int i = 0; i < normals.size(); ++i)
      {
        // On a node in contact only a force that pulls violates the law.
        double &force = violation(normals[i]);
        force -= xi(i);
        if (s(i) == 0.)
          {
            ++state.n_active;
            force = std::min(force, 0.);
          }
      }
    const double scale      = largest_force == 0. ? 1. : 1. / largest_force;
    state.residual          = scale * violation.l2_norm();
    state.residual_rounding = scale * force_rounding;
    return state;
  }



  template <int dim>
  bool
  MultigridProblem<dim>::majorise()
  {
    // Phi <= Phi(s_k) + xi'(s - s_k) + 1/2 (s - s_k)'E (s - s_k).
    const dealii::Vector<double> s = contact.trace(u);
    dealii::Vector<double>       xi(s.size());
    phi.subgradient(s, xi);
    const Eigen::SparseMatrix<double> previous_E   = E;
    const Eigen::VectorXd             previous_b_c = b_c;
    E                                              = phi.curvature(s);
    const Eigen::VectorXd E_s                      = E * eigen_view(s);
    b_c                                            = E_s - eigen_view(xi);
    if (previous_b_c.size() != b_c.size())
      return true;
    constexpr double noise = 1e-12;
    return (b_c - previous_b_c).norm() > noise * (E_s.norm() + b_c.norm()) ||
           (E - previous_E).norm() > noise * E.norm();
  }



  template <int dim>
  MajorantProblem::Minimisation
  MultigridProblem<dim>::minimise(const double tolerance)
  {
    const double         required = tolerance * largest_force;
    const Operator       restricted(*this);
    const Preconditioner preconditioner(*this);
    ActiveSetRule        rule;
    Minimisation         result = {SolverStatus::quadratic_program, 0, 0};

    // Between active sets u may be outside K.
    const dealii::Vector<double> previous_u = u;

    dealii::Vector<double> force(u.size()), free_force(u.size()),
      correction(u.size());
    Eigen::VectorXd excess(normals.size()), mu(normals.size());
    majorant_force(force);
    bool settled = false; // the active set
    while (result.active_set_steps < maximum_linear_systems)
      {
        ++result.active_set_steps;
        // Nodes that enter the active set are moved into contact.
        bool moved = false;
        for (unsigned int i = 0; i < normals.size(); ++i)
          if (active[i] != 0 && u(normals[i]) != 0.)
            {
              u(normals[i]) = 0.;
              moved         = true;
            }
        if (moved)
          majorant_force(force);

        free_force = force;
        restrict_to_free(free_force);
        dealii::SolverControl control(
          maximum_linear_iterations,
          settled ?
            required :
            std::max(required, linear_reduction * free_force.l2_norm()));
        correction = 0.;
        dealii::SolverCG<dealii::Vector<double>> cg(control);
        cg.connect([this](const unsigned int,
                          const double,
                          const dealii::Vector<double> &) {
          return may_go_on() ? dealii::SolverControl::success :
                               dealii::SolverControl::failure;
        });
        bool solved = true;
        try
          {
            cg.solve(restricted, correction, free_force, preconditioner);
          }
        catch (const dealii::SolverControl::NoConvergence &)
          {
            solved = false;
          }
        result.linear_iterations += control.last_step();
        // A failure before the first step is not told by an exception.
        if (!may_go_on())
          {
            result.status = SolverStatus::interrupted;
            u             = previous_u;
            return result;
          }
        if (!solved)
          return result;
        u += correction;

        majorant_force(force);
        free_force = force;
        restrict_to_free(free_force);
        const double residual = free_force.l2_norm();
        for (unsigned int i = 0; i < normals.size(); ++i)
          {
            excess(i) = u(normals[i]);
            mu(i)     = active[i] != 0 ? force(normals[i]) : 0.;
          }
        // The forces of contact are known as well as the others.
        settled =
          rule.update(excess, mu, 0., std::max(residual, required), active) ==
          0;
        if (settled && residual <= 2. * required)
          {
            result.status = SolverStatus::success;
            return result;
          }
      }
    return result;
  }



  template <int dim>
  void
  MultigridProblem<dim>::majorant_force(dealii::Vector<double> &force) const
  {
    A.vmult(force, u);
    force.sadd(-1., 1., f);
    const dealii::Vector<double> s   = contact.trace(u);
    const Eigen::VectorXd        E_s = E * eigen_view(s);
    for (unsigned int i = 0; i < normals.size(); ++i)
      force(normals[i]) += b_c(i) - E_s(i);
  }



  template <int dim>
  void
  MultigridProblem<dim>::restrict_to_free(dealii::Vector<double> &v) const
  {
    for (unsigned int i = 0; i < normals.size(); ++i)
      if (active[i] != 0)
        v(normals[i]) = 0.;
  }



  template class MultigridProblem<2>;
  template class MultigridProblem<3>;
} // namespace Debond
