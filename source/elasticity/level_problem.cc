// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>

#include <debond/elasticity/level_problem.h>
#include <debond/linear_algebra/eigen_view.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace Debond
{
  namespace
  {
    constexpr unsigned int maximum_cycles     = 2000;
    constexpr unsigned int maximum_line_steps = 500;



    template <int dim>
    dealii::Vector<double>
    diagonal_of(const ElasticLevels<dim> &levels, const unsigned int l)
    {
      dealii::Vector<double> result(levels.n_unknowns(l));
      for (unsigned int i = 0; i < result.size(); ++i)
        result(i) = levels.diagonal_entry(l, i);
      return result;
    }



    /// For deal.II's solvers.
    struct LinearOperator
    {
      std::function<void(dealii::Vector<double> &,
                         const dealii::Vector<double> &)>
        product;

      void
      vmult(dealii::Vector<double>       &dst,
            const dealii::Vector<double> &src) const
      {
        product(dst, src);
      }
    };
  } // namespace



  template <int dim>
  LevelProblem<dim>::LevelProblem(ElasticLevels<dim>          &elastic_levels,
                                  const unsigned int           level,
                                  const PiecewiseQuadratic    &nonsmooth,
                                  dealii::Vector<double>      &start,
                                  const std::function<bool()> &go_on)
    : DisplacementProblem(elastic_levels.load(level),
                          nonsmooth,
                          elastic_levels.normals(level),
                          diagonal_of(elastic_levels, level),
                          start,
                          go_on)
    , levels(elastic_levels)
    , l(level)
  {}



  template <int dim>
  void
  LevelProblem<dim>::multiply(dealii::Vector<double>       &dst,
                              const dealii::Vector<double> &src) const
  {
    levels.vmult(l, dst, src);
  }



  template <int dim>
  void
  LevelProblem<dim>::smooth_contact(dealii::Vector<double> &force)
  {
    for (unsigned int i = 0; i < normals.size(); ++i)
      {
        const unsigned int normal = normals[i];
        const double       s      = u(normal);
        const double       new_s =
          std::min(0., s + force(normal) / (diagonal(normal) + E.coeff(i, i)));
        if (new_s == s)
          continue;
        u(normal) = new_s;
        levels.add_column(l, normal, s - new_s, force);
        for (Eigen::SparseMatrix<double>::InnerIterator entry(E, i); entry;
             ++entry)
          force(normals[entry.row()]) += (s - new_s) * entry.value();
      }
  }



  template <int dim>
  MajorantProblem::Minimisation
  LevelProblem<dim>::minimise(const double tolerance)
  {
    const double           required   = tolerance * largest_force;
    const auto             previous_u = u;
    Minimisation           result     = {SolverStatus::quadratic_program, 0, 0};
    dealii::Vector<double> force(u.size()), free_force(u.size()),
      correction(u.size()), product(u.size());
    const auto interrupted = [&]() {
      result.status = SolverStatus::interrupted;
      u             = previous_u;
      return result;
    };
    majorant_force(force);
    while (result.active_set_steps < maximum_line_steps &&
           result.linear_iterations < maximum_cycles)
      {
        if (!may_go_on())
          return interrupted();
        ++result.active_set_steps;
        smooth_contact(force);
        for (unsigned int i = 0; i < normals.size(); ++i)
          active[i] = u(normals[i]) == 0. && force(normals[i]) >= 0.;
        free_force = force;
        restrict_to_free(free_force);
        const double residual = free_force.l2_norm();
        if (residual <= required)
          {
            result.status = SolverStatus::success;
            return result;
          }

        const bool is_changed =
          !is_truncated || cycle_active != active || (cycle_E - E).norm() != 0.;
        if (is_changed)
          {
            std::vector<unsigned int> held;
            for (unsigned int i = 0; i < normals.size(); ++i)
              if (active[i] != 0)
                held.push_back(normals[i]);
            levels.cycle().truncate(l, held, normals, E);
            cycle_E      = E;
            cycle_active = active;
            is_truncated = true;
          }
        if (is_changed && !normals.empty())
          {
            levels.cycle().vmult(correction, free_force);
            ++result.linear_iterations;
          }
        else
          {
            correction = 0.;
            dealii::SolverControl control(maximum_cycles, 0.9 * required);
            dealii::SolverCG<dealii::Vector<double>> cg(control);
            cg.connect([this](const unsigned int,
                              const double,
                              const dealii::Vector<double> &) {
              return may_go_on() ? dealii::SolverControl::success :
                                   dealii::SolverControl::failure;
            });
            const LinearOperator majorant = {
              [this](dealii::Vector<double>       &dst,
                     const dealii::Vector<double> &src) {
                multiply_majorant(dst, src);
              }};
            try
              {
                cg.solve(majorant, correction, free_force, levels.cycle());
              }
            catch (const dealii::SolverControl::NoConvergence &)
              {
                result.linear_iterations += control.last_step();
                return may_go_on() ? result : interrupted();
              }
            result.linear_iterations += control.last_step();
            // A failure before the first step is not told by an exception.
            if (!may_go_on())
              return interrupted();
          }

        // Onto s <= 0, and then as far as the majorant falls.
        double longest = std::numeric_limits<double>::infinity();
        for (unsigned int i = 0; i < normals.size(); ++i)
          {
            double      &c = correction(normals[i]);
            const double s = u(normals[i]);
            c              = std::min(c, -s);
            if (c > 0.)
              longest = std::min(longest, -s / c);
          }
        multiply(product, correction);
        const dealii::Vector<double> c   = trace(correction);
        const Eigen::VectorXd        E_c = E * eigen_view(c);
        for (unsigned int i = 0; i < normals.size(); ++i)
          product(normals[i]) += E_c(i);
        const double slope     = force * correction;
        const double curvature = product * correction;
        if (!(slope > 0.) || !(curvature > 0.))
          {
            result.status = SolverStatus::stagnated;
            return result;
          }
        const double step = std::min(longest, slope / curvature);
        u.add(step, correction);
        force.add(-step, product);
        for (const unsigned int normal : normals)
          u(normal) = std::min(u(normal), 0.);
      }
    return result;
  }



  template class LevelProblem<2>;
  template class LevelProblem<3>;
} // namespace Debond
