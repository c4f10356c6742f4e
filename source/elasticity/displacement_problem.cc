// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/vector_memory.templates.h>

#include <debond/elasticity/displacement_problem.h>
#include <debond/linear_algebra/stagnation.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Debond
{
  namespace
  {
    constexpr unsigned int maximum_linear_iterations = 2000;
    constexpr unsigned int maximum_line_steps        = 500;

    /// What linear systems may leave of their residual while the contact set
    /// changes.
    constexpr double linear_reduction = 0.1;
  } // namespace



  class DisplacementProblem::Vector : public DofVector
  {
  public:
    Vector() = default;

    Vector(const DisplacementProblem &displacement_problem,
           const DofVector           &values)
      : DofVector(values)
      , problem(&displacement_problem)
    {}

    void
    reinit(const Vector &other, const bool omit_zeroing = false)
    {
      DofVector::reinit(other, omit_zeroing);
      problem = other.problem;
    }

    double
    operator*(const Vector &other) const
    {
      return problem->product(*this, other);
    }

    double
    l2_norm() const
    {
      return problem->norm(*this);
    }

    double
    add_and_dot(const double factor, const Vector &added, const Vector &other)
    {
      add(factor, added);
      return *this * other;
    }

  private:
    const DisplacementProblem *problem = nullptr;
  };



  struct DisplacementProblem::LinearOperator
  {
    std::function<void(DofVector &, const DofVector &)> product;

    void
    vmult(Vector &dst, const Vector &src) const
    {
      product(dst, src);
    }
  };



  DisplacementProblem::DisplacementProblem(
    const DofVector                 &load,
    const PiecewiseQuadratic        &nonsmooth,
    const std::vector<unsigned int> &contact_normals,
    CorrectionSolver                &multigrid_cycle,
    DofVector                       &start,
    const std::function<bool()>     &go_on)
    : normals(contact_normals)
    , f(load)
    , phi(nonsmooth)
    , cycle(multigrid_cycle)
    , u(start)
    , may_go_on(go_on ? go_on : []() { return true; })
    , active(contact_normals.size())
  {
    for (unsigned int i = 0; i < normals.size(); ++i)
      active[i] = normals[i] != dealii::numbers::invalid_unsigned_int &&
                  u(normals[i]) == 0.;
  }



  Eigen::VectorXd
  DisplacementProblem::trace(const DofVector &v) const
  {
    Eigen::VectorXd s(normals.size());
    for (unsigned int i = 0; i < normals.size(); ++i)
      s(i) = v(normals[i]);
    return s;
  }



  void
  DisplacementProblem::add_normal(const VectorView &s, DofVector &v) const
  {
    for (unsigned int i = 0; i < normals.size(); ++i)
      if (normals[i] != dealii::numbers::invalid_unsigned_int)
        v(normals[i]) += s(i);
  }



  double
  DisplacementProblem::norm(const DofVector &v) const
  {
    return std::sqrt(product(v, v));
  }



  MajorantProblem::State
  DisplacementProblem::evaluate()
  {
    DofVector internal(u.size());
    multiply(internal, u);
    const Eigen::VectorXd s  = trace(u);
    const Eigen::VectorXd xi = phi.subgradient(s);

    State        state;
    const double energy   = 0.5 * product(internal, u);
    const double work     = product(f, u);
    const double adhesion = phi.value(s);
    state.functional      = energy - work + adhesion;

    // The terms of a row of A u are as large as diagonal times displacement,
    // and cancel.
    DofVector terms = diagonal;
    terms.scale(u);
    force_rounding = 4. * std::numeric_limits<double>::epsilon() * norm(terms);
    state.functional_rounding = force_rounding * norm(u);

    DofVector violation = f;
    violation -= internal;
    largest_force  = std::max({norm(f), norm(internal), xi.norm()});
    state.n_active = 0;
    for (unsigned int i = 0; i < normals.size(); ++i)
      {
        if (s(i) == 0.)
          ++state.n_active;
        if (normals[i] == dealii::numbers::invalid_unsigned_int)
          continue;
        // On a node in contact only a force that pulls violates the law.
        double &force = violation(normals[i]);
        force -= xi(i);
        if (s(i) == 0.)
          force = std::min(force, 0.);
      }
    const double scale      = largest_force == 0. ? 1. : 1. / largest_force;
    state.residual          = scale * norm(violation);
    state.residual_rounding = scale * force_rounding;
    return state;
  }



  bool
  DisplacementProblem::majorise()
  {
    // Phi <= Phi(s_k) + xi'(s - s_k) + 1/2 (s - s_k)'E (s - s_k).
    const Eigen::VectorXd             s            = trace(u);
    const Eigen::SparseMatrix<double> previous_E   = E;
    const Eigen::VectorXd             previous_b_c = b_c;
    E                                              = phi.curvature(s);
    const Eigen::VectorXd E_s                      = E * s;
    b_c                                            = E_s - phi.subgradient(s);
    if (previous_b_c.size() != b_c.size())
      return true;
    constexpr double noise = 1e-12;
    return (b_c - previous_b_c).norm() > noise * (E_s.norm() + b_c.norm()) ||
           curvature_norm(E - previous_E) > noise * curvature_norm(E);
  }



  void
  DisplacementProblem::majorant_force(DofVector &force) const
  {
    multiply(force, u);
    force.sadd(-1., 1., f);
    const Eigen::VectorXd E_s = E * trace(u);
    add_normal(b_c - E_s, force);
  }



  void
  DisplacementProblem::multiply_majorant(DofVector       &dst,
                                         const DofVector &src) const
  {
    multiply(dst, src);
    add_normal(E * trace(src), dst);
    restrict_to_free(dst);
  }



  void
  DisplacementProblem::restrict_to_free(DofVector &v) const
  {
    for (unsigned int i = 0; i < normals.size(); ++i)
      if (active[i] != 0 && normals[i] != dealii::numbers::invalid_unsigned_int)
        v(normals[i]) = 0.;
  }



  void
  DisplacementProblem::smooth_contact(DofVector &force)
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
    for (unsigned int i = 0; i < normals.size(); ++i)
      if (normals[i] != dealii::numbers::invalid_unsigned_int)
        u(normals[i]) = s(i);
    add_normal(E * (old_s - s), force);
    add_contact_columns(old_s - s, force);
  }



  bool
  DisplacementProblem::solve_majorant(const DofVector &force,
                                      const double     tolerance,
                                      DofVector       &correction,
                                      unsigned int    &n_iterations) const
  {
    Vector                x(*this, DofVector(u.size()));
    const Vector          b(*this, force);
    dealii::SolverControl control(maximum_linear_iterations, tolerance);
    dealii::PrimitiveVectorMemory<Vector> memory;
    dealii::SolverCG<Vector>              cg(control, memory);
    Stagnation                            stagnation;
    cg.connect([this, &stagnation](const unsigned int,
                                   const double value,
                                   const Vector &) {
      return may_go_on() && !stagnation.is_reached(value) ?
               dealii::SolverControl::success :
               dealii::SolverControl::failure;
    });
    const LinearOperator majorant = {
      [this](DofVector &dst, const DofVector &src) {
        multiply_majorant(dst, src);
      }};
    const LinearOperator preconditioner = {
      [this](DofVector &dst, const DofVector &src) { dst = cycle.solve(src); }};
    bool is_solved = true;
    try
      {
        cg.solve(majorant, x, b, preconditioner);
        correction = static_cast<const DofVector &>(x);
      }
    catch (const dealii::SolverControl::NoConvergence &)
      {
        is_solved = false;
      }
    n_iterations += control.last_step();
    return is_solved;
  }



  MajorantProblem::Minimisation
  DisplacementProblem::minimise(const double tolerance)
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
           result.linear_iterations < maximum_linear_iterations)
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

        const bool is_changed = !is_prepared || cycle_active != active ||
                                curvature_norm(cycle_E - E) != 0.;
        if (is_changed)
          {
            cycle.prepare(E, active);
            cycle_E      = E;
            cycle_active = active;
            is_prepared  = true;
          }
        const bool is_solved =
          solve_majorant(free_force,
                         std::max(0.9 * required,
                                  is_changed && !normals.empty() ?
                                    linear_reduction * residual :
                                    0.),
                         correction,
                         result.linear_iterations);
        // A failure before the first step is not told by an exception.
        if (!may_go_on())
          return interrupted();
        if (!is_solved)
          return result;

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
} // namespace Debond
