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

    /// Of a step on which the direction of friction turns.
    constexpr unsigned int bisections_of_step = 30;
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
    , bounds(contact.upper(), phi.kinks())
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
      active[i] = bounds.is_at(i, s);
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
    // On a node in contact only a force that pulls violates the law, and on one
    // that sticks what is beyond the bound of friction.
    const Eigen::VectorXd force_s = contact.trace(violation) - xi;
    const Eigen::VectorXd left    = beyond_hold(s, force_s);
    state.n_active                = 0;
    for (unsigned int i = 0; i < s.size(); ++i)
      state.n_active += bounds.is_at(i, s) && !bounds.kinks.has(i);
    contact.set(left, violation);
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



  Eigen::VectorXd
  DisplacementProblem::beyond_hold(const Eigen::VectorXd &s,
                                   const Eigen::VectorXd &force) const
  {
    Eigen::VectorXd left = force - bounds.kinks.gradient(s);
    for (unsigned int i = 0; i < s.size(); ++i)
      if (bounds.is_at(i, s))
        {
          const double held  = bounds.hold(i, force);
          const double whole = bounds.kinks.size(i, force);
          if (held >= 0.)
            left(i) = 0.;
          else if (bounds.kinks.has(i))
            left(i) = force(i) * (-held / whole);
        }
      else
        left(i) -= std::clamp(left(i),
                              -bounds.kinks.rounding(i, s),
                              bounds.kinks.rounding(i, s));
    return left;
  }



  void
  DisplacementProblem::smooth_contact(Vector &force)
  {
    // A projected Gauss-Seidel sweep over the contact normals and tangents, and
    // pairs of these, each to where the majorant is least with all else held.
    // It finds the contact set locally before the coarse levels see it, and
    // keeps J from rising. It is sequential, and short beside a product with A;
    // so each rank does the whole of it and then adds what that does to its own
    // unknowns.
    using Entry                   = Eigen::SparseMatrix<double>::InnerIterator;
    const auto           &E       = majorant.E;
    Eigen::VectorXd       s       = contact.trace(u);
    const Eigen::VectorXd old_s   = s;
    Eigen::VectorXd       force_s = contact.trace(force);
    const auto stiffness = [&](const unsigned int i, const unsigned int j) {
      return contact_block.coeff(i, j) + E.coeff(i, j);
    };
    const auto move = [&](const unsigned int i, const double to) {
      s(i) = to;
      if (s(i) == old_s(i))
        return;
      for (Entry entry(contact_block, i); entry; ++entry)
        force_s(entry.row()) += (old_s(i) - s(i)) * entry.value();
      for (Entry entry(E, i); entry; ++entry)
        force_s(entry.row()) += (old_s(i) - s(i)) * entry.value();
    };
    const Kinks &kinks = bounds.kinks;
    for (unsigned int i = 0; i < s.size(); ++i)
      if (kinks.is_paired(i))
        {
          const unsigned int j = static_cast<unsigned int>(kinks.partner[i]);
          if (j < i)
            continue;
          Eigen::Matrix2d block;
          block << stiffness(i, i), stiffness(i, j), stiffness(j, i),
            stiffness(j, j);
          const Eigen::Vector2d place(kinks.place(i), kinks.place(j));
          const Eigen::Vector2d v = Eigen::Vector2d(s(i), s(j)) - place;
          const Eigen::Vector2d next =
            place +
            least_on_pair(block,
                          Eigen::Vector2d(force_s(i), force_s(j)) + block * v,
                          kinks.weight(i));
          move(i, next(0));
          move(j, next(1));
        }
      else
        {
          // The majorant is a parabola in s_i, least at s_i + force_i /
          // stiffness_i or at the bound before it; with a kink it is least
          // there, or by what friction takes before it.
          const double k    = stiffness(i, i);
          const double free = s(i) + force_s(i) / k;
          const double way  = free - bounds.place(i);
          const double slip = kinks.has(i) ? kinks.weight(i) / k : 0.;
          move(i,
               !kinks.has(i)         ? std::min(bounds.place(i), free) :
               std::abs(way) <= slip ? bounds.place(i) :
                                       free - std::copysign(slip, way));
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
    const Kinks &kinks = bounds.kinks;
    // Minus the majorant's gradient at u, without kinks.
    force = f;
    force -= internal;
    const Eigen::VectorXd bond_forces =
      majorant.b - majorant.E * contact.trace(u);
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
        // Nodes that are in contact and pressed do not move, nor do those that
        // stick. All others are free, also those in contact that a force pulls,
        // since the smoother has not lifted them yet; it is the smoother alone
        // that lets go what sticks.
        for (unsigned int i = 0; i < s.size(); ++i)
          active[i] = bounds.is_at(i, s) && (kinks.has(i) || force_s(i) >= 0.);
        free_force = force;
        contact.set(beyond_hold(s, force_s), free_force);
        const double residual = free_force.l2_norm();
        contact.set_zero(active, free_force);
        // Pairs that slide as in ConeQP.
        const Eigen::SparseMatrix<double> E = majorant.E + kinks.curvature(s);
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
        // Nor does it pass kinks.
        double                longest = infinity;
        const Eigen::VectorXd room    = bounds.place - s;
        Eigen::VectorXd       allowed = contact.trace(correction);
        for (unsigned int i = 0; i < s.size(); ++i)
          if (!kinks.has(i))
            allowed(i) = std::min(allowed(i), room(i));
          else if (kinks.is_paired(i) && kinks.partner[i] < i)
            continue;
          else if (bounds.way_to(i, s, allowed) < 1.)
            for (const Eigen::Index j : kinks.group(i))
              allowed(j) = room(j);
        for (unsigned int i = 0; i < s.size(); ++i)
          longest = std::min(longest, bounds.way_to(i, s, allowed));
        contact.set(allowed, correction);
        A.vmult(image, correction);
        const Eigen::VectorXd of_bonds = majorant.E * allowed;
        contact.add(of_bonds, image);
        // Cutting may have turned the correction into one that ascends, or
        // there may be rounding alone; both end the minimisation, and the
        // caller says so.
        const double slope =
          force * correction - kinks.gradient(s).dot(allowed);
        const double curvature = image * correction;
        if (!(slope > 0.) || !(curvature > 0.))
          {
            result.status = SolverStatus::stagnated;
            return result;
          }
        // Friction of pairs, whose directions turn, may end it before.
        double step = std::min(longest, slope / curvature);
        if (!kinks.pairs().empty())
          {
            const double work  = force * correction;
            const auto   falls = [&](const double t) {
              return work - t * curvature >
                     kinks.gradient(s + t * allowed).dot(allowed);
            };
            double low = 0.;
            for (unsigned int k = 0; k < bisections_of_step && !falls(step);
                 ++k)
              {
                const double middle          = 0.5 * (low + step);
                (falls(middle) ? low : step) = middle;
              }
          }
        u.add(step, correction);
        force.add(-step, image);
        // The step ends at the bounds but for rounding, which must not count as
        // penetration. At kinks the smoother sees to that.
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
