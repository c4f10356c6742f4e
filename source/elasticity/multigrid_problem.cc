// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>

#include <debond/elasticity/multigrid_problem.h>
#include <debond/linear_algebra/stagnation.h>

#include <algorithm>

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
    vmult(DofVector &dst, const DofVector &src) const
    {
      problem.multiply_majorant(dst, src);
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
    vmult(DofVector &dst, const DofVector &src) const
    {
      problem.multigrid.vmult(dst, src);
      problem.restrict_to_free(dst);
    }

  private:
    const MultigridProblem &problem;
  };



  namespace
  {
    template <int dim>
    DofVector
    diagonal_of(const ElasticProblem<dim> &problem)
    {
      DofVector result(problem.unknowns().n_dofs());
      for (unsigned int i = 0; i < result.size(); ++i)
        result(i) = problem.diagonal_entry(i);
      return result;
    }
  } // namespace



  template <int dim>
  MultigridProblem<dim>::MultigridProblem(const ElasticProblem<dim> &problem,
                                          const PiecewiseQuadratic  &nonsmooth,
                                          const Multigrid &preconditioner,
                                          DofVector       &start,
                                          const std::function<bool()> &go_on)
    : DisplacementProblem(problem.load(),
                          nonsmooth,
                          {problem.unknowns().contact().normals().begin(),
                           problem.unknowns().contact().normals().end()},
                          diagonal_of(problem),
                          start,
                          go_on)
    , A(problem.trilinos_matrix())
    , multigrid(preconditioner)
  {}



  template <int dim>
  void
  MultigridProblem<dim>::multiply(DofVector &dst, const DofVector &src) const
  {
    A.vmult(dst, src);
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
    const DofVector previous_u = u;

    DofVector       force(u.size()), free_force(u.size()), correction(u.size());
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
        dealii::SolverCG<DofVector> cg(control);
        Stagnation                  stagnation;
        cg.connect([this, &stagnation](const unsigned int,
                                       const double value,
                                       const DofVector &) {
          return may_go_on() && !stagnation.is_reached(value) ?
                   dealii::SolverControl::success :
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



  template class MultigridProblem<2>;
  template class MultigridProblem<3>;
} // namespace Debond
