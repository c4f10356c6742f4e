// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>

#include <debond/linear_algebra/stagnation.h>
#include <debond/solve/minimum/displacement_problem.h>

#include <boost/serialization/utility.hpp>

#include <unordered_map>

namespace Debond
{
  namespace
  {
    /// The limits of one majorant. Cycles that work take some ten iterations,
    /// so that whoever reaches one of these has stagnated.
    constexpr unsigned int maximum_linear_iterations = 2000;
    constexpr unsigned int maximum_line_steps        = 500;

    /// The part of their residual that linear systems may leave while the
    /// contact set changes.
    constexpr double linear_reduction = 0.1;
  } // namespace



  template <int dim>
  DisplacementProblem::DisplacementProblem(const ElasticProblem<dim> &problem,
                                           const DofVector           &load,
                                           const PiecewiseQuadratic  &phi,
                                           TruncatedMultigrid &multigrid_cycle,
                                           DistributedVector  &start,
                                           const Interruption &interruption)
    : A(problem.distributed_matrix())
    , f(distribute(load,
                   start.locally_owned_elements(),
                   start.get_mpi_communicator()))
    , diagonal(distribute(problem.diagonal(),
                          start.locally_owned_elements(),
                          start.get_mpi_communicator()))
    , phi(phi)
    , contact(problem)
    , contact_block(contact.block_of(problem.matrix()))
    , rows_of_contact(A.rows_of(problem.unknowns().contact().dofs()))
    , cycle(multigrid_cycle)
    , u(start)
    , interruption(interruption)
    , internal(start)
    , active(contact.size())
  {
    // What is at s = 0 to begin with counts as active until the first sweep
    // over the contact nodes.
    const Eigen::VectorXd s = contact.trace(u);
    for (unsigned int i = 0; i < active.size(); ++i)
      active[i] = s(i) == contact.upper()(i);
  }



  MajorantProblem::State
  DisplacementProblem::evaluate()
  {
    // J and its residual come from A, f and the bonds in double precision,
    // whatever the single precision of the cycle does.
    A.vmult(internal, u);
    const Eigen::VectorXd s  = contact.trace(u);
    const Eigen::VectorXd xi = phi.subgradient(s);

    State state;
    state.functional = 0.5 * (internal * u) - f * u + phi.change(s);

    // The terms of a row of A u are as large as diagonal times displacement,
    // and cancel. What they leave is the least residual that can be asked for,
    // and with u the least change of J that means anything.
    Vector terms = diagonal;
    terms.scale(u);
    force_rounding            = Tolerance::row_of_product * terms.l2_norm();
    state.functional_rounding = force_rounding * u.l2_norm();

    Vector violation = f;
    violation -= internal;
    largest_force = std::max({f.l2_norm(), internal.l2_norm(), xi.norm()});
    // On a node in contact only a force that pulls violates the law.
    Eigen::VectorXd       change  = -xi;
    const Eigen::VectorXd force_s = contact.trace(violation) - xi;
    state.n_active                = 0;
    for (unsigned int i = 0; i < s.size(); ++i)
      if (s(i) == contact.upper()(i))
        {
          ++state.n_active;
          change(i) -= std::max(force_s(i), 0.);
        }
    contact.add(change, violation);
    const double scale      = largest_force == 0. ? 1. : 1. / largest_force;
    state.residual          = scale * violation.l2_norm();
    state.residual_rounding = scale * force_rounding;
    state.largest_force     = largest_force;
    return state;
  }



  bool
  DisplacementProblem::majorise()
  {
    // A majorant that is the same but for rounding has the same minimum, which
    // ends the iteration instead of another cycle.
    const Eigen::VectorXd s = contact.trace(u);
    return majorant.touch(s, phi.subgradient(s), phi.curvature(s));
  }



  void
  DisplacementProblem::smooth_contact(Vector &force)
  {
    // A projected Gauss-Seidel sweep over the contact normals, each to where
    // the majorant is least with all else held. It finds the contact set
    // locally before the coarse levels see it, and keeps J from rising. It is
    // sequential, and short beside a product with A; so each rank does the
    // whole of it and then adds what that does to its own unknowns.
    using Entry                   = Eigen::SparseMatrix<double>::InnerIterator;
    const auto           &E       = majorant.E;
    Eigen::VectorXd       s       = contact.trace(u);
    const Eigen::VectorXd old_s   = s;
    Eigen::VectorXd       force_s = contact.trace(force);
    for (unsigned int i = 0; i < s.size(); ++i)
      {
        // The majorant is a parabola in s_i, least at s_i + force_i /
        // stiffness_i or at the bound before it.
        const double stiffness = contact_block.coeff(i, i) + E.coeff(i, i);
        s(i) = std::min(contact.upper()(i), s(i) + force_s(i) / stiffness);
        if (s(i) == old_s(i))
          continue;
        for (Entry entry(contact_block, i); entry; ++entry)
          force_s(entry.row()) += (old_s(i) - s(i)) * entry.value();
        for (Entry entry(E, i); entry; ++entry)
          force_s(entry.row()) += (old_s(i) - s(i)) * entry.value();
      }
    // The force of all other unknowns is brought up to date with the rows of A
    // that couple to contact nodes, which is far less than a product with A.
    contact.set(s, u);
    Vector step(u);
    step = 0.;
    contact.set(s - old_s, step);
    A.subtract(rows_of_contact, A.at_columns(step), force);
    const Eigen::VectorXd of_bonds = E * (old_s - s);
    contact.add(of_bonds, force);
  }



  bool
  DisplacementProblem::solve_majorant(const Vector &force,
                                      const double  tolerance,
                                      Vector       &correction,
                                      unsigned int &n_iterations) const
  {
    // Conjugate gradients for Q(A + E)Q, which is the matrix of the truncated
    // cycle. They are left early when a signal comes, or when the residual has
    // stopped falling above the tolerance because of rounding.
    dealii::SolverControl    control(maximum_linear_iterations, tolerance);
    dealii::SolverCG<Vector> cg(control);
    Stagnation               stagnation;
    cg.connect([this, &stagnation](const unsigned int,
                                   const double value,
                                   const auto &) {
      return !interruption.requested() && !stagnation.is_reached(value) ?
               dealii::SolverControl::success :
               dealii::SolverControl::failure;
    });
    correction     = 0.;
    bool is_solved = true;
    try
      {
        cg.solve(cycle.matrix(), correction, force, cycle);
      }
    catch (const dealii::SolverControl::NoConvergence &)
      {
        is_solved = false;
      }
    // The cycle keeps held unknowns at zero to single precision; here they are
    // made so exactly.
    contact.set_zero(active, correction);
    n_iterations += control.last_step();
    return is_solved;
  }



  MajorantProblem::Minimisation
  DisplacementProblem::minimise(const double tolerance)
  {
    // One truncated nonsmooth Newton step a pass (Graeser and Kornhuber 2009;
    // doc/reference/multigrid.md): smooth the contact nodes, fix those that are
    // pressed, solve for all others, and go along the correction as far as s <=
    // 0 and the majorant allow.
    const double required   = tolerance * largest_force;
    const Vector previous_u = u;
    Minimisation result     = {SolverStatus::quadratic_program, 0, 0};
    Vector       force(u), free_force(u), correction(u), image(u);
    const auto   interrupted = [&]() {
      result.status = SolverStatus::interrupted;
      u             = previous_u;
      return result;
    };
    const auto &E = majorant.E;
    // Minus the majorant's gradient at u.
    force = f;
    force -= internal;
    const Eigen::VectorXd bond_forces = majorant.b - E * contact.trace(u);
    contact.add(bond_forces, force);
    while (result.active_set_steps < maximum_line_steps &&
           result.linear_iterations < maximum_linear_iterations)
      {
        if (interruption.requested())
          return interrupted();
        ++result.active_set_steps;
        smooth_contact(force);
        const Eigen::VectorXd s       = contact.trace(u);
        const Eigen::VectorXd force_s = contact.trace(force);
        // Nodes that are in contact and pressed do not move. All others are
        // free, also those in contact that a force pulls, since the smoother
        // has not lifted them yet.
        for (unsigned int i = 0; i < s.size(); ++i)
          active[i] = s(i) == contact.upper()(i) && force_s(i) >= 0.;
        free_force = force;
        contact.set_zero(active, free_force);
        const double residual = free_force.l2_norm();
        if (residual <= required)
          {
            result.status = SolverStatus::success;
            return result;
          }

        // Truncation costs products on the contact boundary at all levels, so
        // it is done only if T or E have changed.
        const bool is_changed = !is_prepared || cycle_active != active ||
                                (E.size() > 0 && (cycle_E - E).norm() != 0.);
        if (is_changed)
          {
            contact.truncate(E, active, cycle);
            cycle_E      = E;
            cycle_active = active;
            is_prepared  = true;
          }
        // While T or E change, a tenth of the residual is enough: the exact
        // minimum for a wrong contact set is worth nothing. Once they stay, the
        // tolerance itself is asked for, with some room for the difference
        // between recursive and true residual.
        const bool is_solved =
          solve_majorant(free_force,
                         std::max(0.9 * required,
                                  is_changed && s.size() > 0 ?
                                    linear_reduction * residual :
                                    0.),
                         correction,
                         result.linear_iterations);
        // A failure before the first step is not told by an exception.
        if (interruption.requested())
          return interrupted();
        if (!is_solved)
          return result;

        // The correction may go through the foundation. Components that would
        // are cut at their bounds for a step of 1, and a longer step ends where
        // the first node touches. On this line the majorant is a parabola,
        // whose minimum is the step.
        double                longest = infinity;
        const Eigen::VectorXd room    = contact.upper() - s;
        const Eigen::VectorXd allowed =
          contact.trace(correction).cwiseMin(room);
        for (unsigned int i = 0; i < s.size(); ++i)
          if (allowed(i) > 0.)
            longest = std::min(longest, room(i) / allowed(i));
        contact.set(allowed, correction);
        A.vmult(image, correction);
        const Eigen::VectorXd of_bonds = E * allowed;
        contact.add(of_bonds, image);
        // Cutting may have turned the correction into one that ascends, or
        // there may be rounding alone; both end the minimisation, and the
        // caller says so.
        const double slope     = force * correction;
        const double curvature = image * correction;
        if (!(slope > 0.) || !(curvature > 0.))
          {
            result.status = SolverStatus::stagnated;
            return result;
          }
        const double step = std::min(longest, slope / curvature);
        u.add(step, correction);
        force.add(-step, image);
        // The step ends at the bounds but for rounding, which must not count as
        // penetration.
        contact.set(contact.trace(u).cwiseMin(contact.upper()), u);
      }
    return result;
  }



  template DisplacementProblem::DisplacementProblem(const ElasticProblem<2> &,
                                                    const DofVector &,
                                                    const PiecewiseQuadratic &,
                                                    TruncatedMultigrid &,
                                                    DistributedVector &,
                                                    const Interruption &);
  template DisplacementProblem::DisplacementProblem(const ElasticProblem<3> &,
                                                    const DofVector &,
                                                    const PiecewiseQuadratic &,
                                                    TruncatedMultigrid &,
                                                    DistributedVector &,
                                                    const Interruption &);
} // namespace Debond
