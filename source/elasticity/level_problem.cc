// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/vector_memory.templates.h>

#include <debond/elasticity/level_problem.h>
#include <debond/linear_algebra/stagnation.h>

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
    DofVector
    diagonal_of(const ElasticLevels<dim> &levels, const unsigned int l)
    {
      DofVector result(levels.n_unknowns(l));
      for (unsigned int i = 0; i < result.size(); ++i)
        result(i) = levels.diagonal_entry(l, i);
      return result;
    }



    /// Products on a level, for deal.II's solvers.
    template <int dim>
    class LevelVector : public DofVector
    {
    public:
      LevelVector() = default;

      LevelVector(const ElasticLevels<dim> &elastic_levels,
                  const unsigned int        level,
                  const DofVector          &values)
        : DofVector(values)
        , levels(&elastic_levels)
        , l(level)
      {}

      void
      reinit(const LevelVector &other, const bool omit_zeroing = false)
      {
        DofVector::reinit(other, omit_zeroing);
        levels = other.levels;
        l      = other.l;
      }

      double
      operator*(const LevelVector &other) const
      {
        return levels->product(l, *this, other);
      }

      double
      l2_norm() const
      {
        return std::sqrt(*this * *this);
      }

      double
      add_and_dot(const double       factor,
                  const LevelVector &added,
                  const LevelVector &other)
      {
        add(factor, added);
        return *this * other;
      }

    private:
      const ElasticLevels<dim> *levels = nullptr;
      unsigned int              l      = 0;
    };



    template <int dim>
    struct LinearOperator
    {
      std::function<void(DofVector &, const DofVector &)> product;

      void
      vmult(LevelVector<dim> &dst, const LevelVector<dim> &src) const
      {
        product(dst, src);
      }
    };
  } // namespace



  template <int dim>
  LevelProblem<dim>::LevelProblem(ElasticLevels<dim>          &elastic_levels,
                                  const unsigned int           level,
                                  const PiecewiseQuadratic    &nonsmooth,
                                  DofVector                   &start,
                                  const std::function<bool()> &go_on)
    : DisplacementProblem(elastic_levels.load(level),
                          nonsmooth,
                          elastic_levels.normals(level),
                          diagonal_of(elastic_levels, level),
                          start,
                          go_on)
    , levels(elastic_levels)
    , l(level)
    , contact_rows(levels.contact_rows(l))
  {}



  template <int dim>
  void
  LevelProblem<dim>::multiply(DofVector &dst, const DofVector &src) const
  {
    levels.vmult(l, dst, src);
  }



  template <int dim>
  Eigen::VectorXd
  LevelProblem<dim>::trace(const DofVector &v) const
  {
    return levels.trace(l, v);
  }



  template <int dim>
  double
  LevelProblem<dim>::product(const DofVector &a, const DofVector &b) const
  {
    return levels.product(l, a, b);
  }



  template <int dim>
  void
  LevelProblem<dim>::smooth_contact(DofVector &force)
  {
    // Each rank goes through all nodes, and then adds what that does to its
    // unknowns.
    using Entry                   = Eigen::SparseMatrix<double>::InnerIterator;
    Eigen::VectorXd       s       = trace(u);
    const Eigen::VectorXd old_s   = s;
    Eigen::VectorXd       force_s = trace(force);
    for (unsigned int i = 0; i < normals.size(); ++i)
      {
        const double stiffness = contact_rows.coeff(i, i) + E.coeff(i, i);
        s(i)                   = std::min(0., s(i) + force_s(i) / stiffness);
        if (s(i) == old_s(i))
          continue;
        for (Entry entry(contact_rows, i); entry; ++entry)
          force_s(entry.row()) += (old_s(i) - s(i)) * entry.value();
        for (Entry entry(E, i); entry; ++entry)
          force_s(entry.row()) += (old_s(i) - s(i)) * entry.value();
      }

    constexpr unsigned int elsewhere = dealii::numbers::invalid_unsigned_int;
    for (unsigned int i = 0; i < normals.size(); ++i)
      {
        if (s(i) == old_s(i))
          continue;
        if (normals[i] != elsewhere)
          {
            u(normals[i]) = s(i);
            levels.add_column(l, normals[i], old_s(i) - s(i), force);
          }
        for (Entry entry(E, i); entry; ++entry)
          if (normals[entry.row()] != elsewhere)
            force(normals[entry.row()]) += (old_s(i) - s(i)) * entry.value();
      }
    levels.update_ghosts(l, force);
  }



  template <int dim>
  MajorantProblem::Minimisation
  LevelProblem<dim>::minimise(const double tolerance)
  {
    const double required   = tolerance * largest_force;
    const auto   previous_u = u;
    Minimisation result     = {SolverStatus::quadratic_program, 0, 0};
    DofVector    force(u.size()), free_force(u.size()), correction(u.size()),
      image(u.size());
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
        const Eigen::VectorXd s       = trace(u);
        const Eigen::VectorXd force_s = trace(force);
        for (unsigned int i = 0; i < normals.size(); ++i)
          active[i] = s(i) == 0. && force_s(i) >= 0.;
        free_force = force;
        restrict_to_free(free_force);
        const double residual = norm(free_force);
        if (residual <= required)
          {
            result.status = SolverStatus::success;
            return result;
          }

        const bool is_changed = !is_truncated || cycle_active != active ||
                                curvature_norm(cycle_E - E) != 0.;
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
            LevelVector<dim>       x(levels, l, DofVector(u.size()));
            const LevelVector<dim> b(levels, l, free_force);
            dealii::SolverControl  control(maximum_cycles, 0.9 * required);
            dealii::PrimitiveVectorMemory<LevelVector<dim>> memory;
            dealii::SolverCG<LevelVector<dim>>              cg(control, memory);
            Stagnation                                      stagnation;
            cg.connect([this, &stagnation](const unsigned int,
                                           const double value,
                                           const LevelVector<dim> &) {
              return may_go_on() && !stagnation.is_reached(value) ?
                       dealii::SolverControl::success :
                       dealii::SolverControl::failure;
            });
            const LinearOperator<dim> majorant = {
              [this](DofVector &dst, const DofVector &src) {
                multiply_majorant(dst, src);
              }};
            const LinearOperator<dim> preconditioner = {
              [this](DofVector &dst, const DofVector &src) {
                levels.cycle().vmult(dst, src);
              }};
            try
              {
                cg.solve(majorant, x, b, preconditioner);
                correction = static_cast<const DofVector &>(x);
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
        double          longest = std::numeric_limits<double>::infinity();
        Eigen::VectorXd c       = trace(correction);
        for (unsigned int i = 0; i < normals.size(); ++i)
          {
            c(i) = std::min(c(i), -s(i));
            if (c(i) > 0.)
              longest = std::min(longest, -s(i) / c(i));
            if (normals[i] != dealii::numbers::invalid_unsigned_int)
              correction(normals[i]) = c(i);
          }
        multiply(image, correction);
        add_normal(E * c, image);
        const double slope     = product(force, correction);
        const double curvature = product(image, correction);
        if (!(slope > 0.) || !(curvature > 0.))
          {
            result.status = SolverStatus::stagnated;
            return result;
          }
        const double step = std::min(longest, slope / curvature);
        u.add(step, correction);
        force.add(-step, image);
        for (const unsigned int normal : normals)
          if (normal != dealii::numbers::invalid_unsigned_int)
            u(normal) = std::min(u(normal), 0.);
      }
    return result;
  }



  template class LevelProblem<2>;
  template class LevelProblem<3>;
} // namespace Debond
