// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/optimization/majorise/majorant.h>
#include <debond/solve/minimum/extended_operator.h>
#include <debond/solve/minimum/refinement.h>

namespace Debond
{
  namespace
  {
    constexpr unsigned int maximum_refinement_iterations = 2000;
    constexpr unsigned int maximum_refinement_systems    = 500;

    /// Forces of a body at rest beside Scene::least_force(), 1e-7 of the
    /// largest load: the rounding of that load, on the long levers of slender
    /// bodies.
    constexpr double forces_at_rest = 1e-5;
  } // namespace



  double
  allowed_energy_rounding(const unsigned int n_unknowns)
  {
    return std::clamp(100. * Tolerance::epsilon * n_unknowns,
                      Tolerance::least_energy_rounding,
                      Tolerance::largest_energy_rounding);
  }



  template <int dim>
  double
  rounding_of_energy(const ElasticProblem<dim> &problem,
                     const LoadFactors          factors,
                     const DofVector           &u)
  {
    // Of u itself, and of a lifting that w undoes, as a gap is undone if the
    // body stays at rest.
    const ElasticUnknowns<dim> &unknowns    = problem.unknowns();
    const bool                  has_lifting = unknowns.has_lifting();
    const DofVector             lifting =
      has_lifting ? unknowns.lifting(factors) : DofVector(u.size());
    const DofVector diagonal = problem.diagonal();
    double          terms    = 0.;
    for (unsigned int i = 0; i < u.size(); ++i)
      if (has_lifting || !unknowns.is_constrained(i))
        {
          // Each entry of u is rounded by epsilon times itself and by epsilon
          // times the parts that it is the sum of. The energy of that in the
          // diagonal of A is what a row of A u may lose, and is not seen by its
          // sum, in which these terms cancel.
          const double size =
            std::abs(u(i) + lifting(i)) + std::abs(lifting(i));
          terms += diagonal(i) * size * size;
        }
    return Tolerance::epsilon * terms;
  }



  namespace
  {
    /// The majorant of J at a point, in extended precision, and its minimum
    /// within the bounds. In the displacements themselves: if a gap is far
    /// larger than they are, nothing of them would remain in w.
    template <int dim>
    class ExtendedMajorant
    {
    public:
      ExtendedMajorant(const ElasticProblem<dim> &elastic_problem,
                       const PiecewiseQuadratic  &phi,
                       const LoadFactors          factors,
                       CorrectionSolver          &correction_solver,
                       const Interruption        &interrupted_by,
                       const DofVector           &start)
        : A(elastic_problem)
        , problem(elastic_problem)
        , phi(phi)
        , solver(correction_solver)
        , interruption(interrupted_by)
        , normals(problem.unknowns().contact().dofs())
        , bounds(Bounds(problem.unknowns().contact().boundary().upper_bounds(),
                        phi.kinks())
                   .with_pairs_as_at(problem.unknowns().contact().trace(start)))
        , lifting(to_extended(problem.unknowns().lifting(factors)))
        , u(to_extended(start) + lifting)
        , f(load_at(problem, factors))
      {
        // The contact set of the result in double precision is the first guess,
        // and mostly the last one.
        const Eigen::VectorXd s = problem.unknowns().contact().trace(start);
        for (unsigned int i = 0; i < s.size(); ++i)
          active.push_back(bounds.state(i, s));
        // The energy that rounding of w leaves of a lifting that w undoes.
        constexpr long double epsilon  = Tolerance::epsilon;
        const DofVector       diagonal = problem.diagonal();
        for (unsigned int i = 0; i < lifting.size(); ++i)
          least_energy +=
            diagonal(i) * epsilon * lifting(i) * epsilon * lifting(i);
      }

      RefinementResult result;

      /// Returns false if the majorant is the one of before.
      bool
      majorise()
      {
        const Eigen::VectorXd s = to_foundation().template cast<double>();
        // If Phi softens, majorants come to a minimum in the limit only. Next
        // to it Newton steps with Phi'' get there, and if Phi does not soften
        // both are the same.
        // So do they with friction whose direction turns.
        const Eigen::VectorXd of_kinks = phi.kinks().gradient(s);
        Eigen::VectorXd       slope    = phi.subgradient(s);
        for (Eigen::Index i = 0; i < s.size(); ++i)
          if (phi.kinks().is_paired(i))
            slope(i) += of_kinks(i);
        return majorant.touch(
          s, slope, phi.second_derivative(s) + phi.kinks().curvature(s));
      }

      bool
      minimise()
      {
        // Active sets for s <= 0: each pass solves for equilibrium with the
        // active nodes at the foundation, then releases nodes that the
        // foundation would have to pull and takes nodes that would penetrate
        // it. With friction the same is done for what sticks.
        ActiveSetRule rule;
        while (result.systems < maximum_refinement_systems)
          {
            ++result.systems;
            for (unsigned int i = 0; i < normals.size(); ++i)
              if (is_active(active[i]))
                u(normals[i]) = lifting(normals[i]) + bounds.place(i);
            // The preconditioner is made anew for each active set, while u
            // stays where the last one has led it.
            ActiveSet held_at_contact;
            for (const char state : active)
              held_at_contact.push_back(is_active(state));
            solver.prepare(majorant.E, held_at_contact);
            if (!solve())
              return false;

            // A penetration counts only above a hundredth of the rounding of
            // double precision, and a force only above the largest residual
            // that the free unknowns have kept.
            const ExtendedVector  exact    = to_foundation();
            const Eigen::VectorXd s        = exact.template cast<double>();
            const ExtendedVector &r        = last_force;
            long double           residual = 0.;
            std::vector<char>     held(static_cast<std::size_t>(u.size()), 0);
            for (unsigned int i = 0; i < normals.size(); ++i)
              if (is_active(active[i]))
                held[normals[i]] = 1;
            for (unsigned int i = 0; i < r.size(); ++i)
              if (held[i] == 0)
                residual = std::max(residual, std::abs(r(i)));
            // All wrong nodes are exchanged at once, and one by one if that
            // continues for too long, which ends after finitely many steps.
            if (rule.update(bounds,
                            s,
                            at_contact(r).template cast<double>(),
                            0.01 * Tolerance::epsilon *
                              s.lpNorm<Eigen::Infinity>(),
                            static_cast<double>(residual),
                            active) == 0)
              return true;
          }
        return false;
      }

      DofVector
      rounded() const
      {
        DofVector point(static_cast<unsigned int>(u.size()));
        // The result is w = u - G, which is rounded only here and made
        // admissible again.
        for (unsigned int i = 0; i < point.size(); ++i)
          point(i) = static_cast<double>(u(i) - lifting(i));
        for (unsigned int i = 0; i < normals.size(); ++i)
          {
            double &s = point(normals[i]);
            if (is_active(active[i]) || bounds.excess(i, s, active[i]) > 0.)
              s = bounds.place(i);
          }
        return point;
      }

    private:
      static ExtendedVector
      to_extended(const DofVector &v)
      {
        return Eigen::Map<const Eigen::VectorXd>(v.begin(), v.size())
          .template cast<long double>();
      }

      /// Cartesian forces are data, so that double precision is enough.
      static ExtendedVector
      load_at(const ElasticProblem<dim> &problem, const LoadFactors factors)
      {
        // The load without A G, since u itself is the unknown here.
        DofVector load = problem.unknowns().basis().forces_to_unknowns(
          problem.fields().applied_nodal_forces(factors));
        problem.unknowns().constraints().set_zero(load);
        return to_extended(load);
      }

      ExtendedVector
      at_contact(const ExtendedVector &v) const
      {
        ExtendedVector v_nu(normals.size());
        for (unsigned int i = 0; i < normals.size(); ++i)
          v_nu(i) = v(normals[i]);
        return v_nu;
      }

      /// s of the contact nodes.
      ExtendedVector
      to_foundation() const
      {
        return at_contact(u) - at_contact(lifting);
      }

      ExtendedVector
      E_times(const ExtendedVector &s) const
      {
        return majorant.E.cast<long double>() * s;
      }

      /// Twice the energy of u and of the bonds' curvature, without what
      /// supports move.
      long double
      energy() const
      {
        ExtendedVector v = u;
        for (unsigned int i = 0; i < v.size(); ++i)
          if (problem.unknowns().is_constrained(i))
            v(i) = 0.;
        const ExtendedVector s = to_foundation();
        // A body that is at rest on its foundation has no energy to be relative
        // to. What w leaves of a lifting that it undoes is the least that can
        // be resolved.
        return std::max(v.dot(A * v) + s.dot(E_times(s)), least_energy);
      }

      /// (A + E) v.
      ExtendedVector
      product(const ExtendedVector &v) const
      {
        ExtendedVector       A_v = A * v;
        const ExtendedVector E_v = E_times(at_contact(v));
        for (unsigned int i = 0; i < normals.size(); ++i)
          A_v(normals[i]) += E_v(i);
        return A_v;
      }

      /// Minus the majorant's gradient.
      ExtendedVector
      force() const
      {
        ExtendedVector       r   = f - A * u;
        const ExtendedVector E_s = E_times(to_foundation());
        for (unsigned int i = 0; i < normals.size(); ++i)
          r(normals[i]) += majorant.b(i) - E_s(i) + bounds.force(i, active[i]);
        return r;
      }

      void
      release_held(ExtendedVector &v) const
      {
        for (unsigned int i = 0; i < normals.size(); ++i)
          if (is_active(active[i]))
            v(normals[i]) = 0.;
      }

      ExtendedVector
      precondition(const ExtendedVector &r) const
      {
        // The preconditioner works in double precision, whose exponents have a
        // smaller range. The residual is scaled to 1, so that neither the units
        // of the scene nor the last steps, where it is tiny, make it underflow.
        const long double scale = r.template lpNorm<Eigen::Infinity>();
        DofVector         rounded_r(static_cast<unsigned int>(r.size()));
        if (scale == 0.)
          return ExtendedVector::Zero(r.size());
        for (unsigned int i = 0; i < rounded_r.size(); ++i)
          rounded_r(i) = static_cast<double>(r(i) / scale);
        return scale * to_extended(solver.solve(rounded_r));
      }

      /// Equilibrium with the nodes of the active set held.
      bool
      solve()
      {
        // Iterative refinement outside, conjugate gradients inside: the
        // recursive residual of conjugate gradients drifts from the true one,
        // so u is corrected and the residual computed again until the true one
        // is small. rho = r'z is the square of the error in the energy norm as
        // the preconditioner sees it. The factors of A are wrong in a few
        // directions only, such as the bending of a slender body, so few steps
        // do.
        long double error = std::numeric_limits<long double>::infinity();
        while (true)
          {
            last_force       = force();
            ExtendedVector r = last_force;
            release_held(r);
            ExtendedVector z   = precondition(r);
            long double    rho = r.dot(z);
            // The first rho may exceed the energy of a poor start.
            const long double all = std::max(energy(), rho);
            const long double target =
              all * (Tolerance::refinement * Tolerance::refinement);
            result.error =
              all == 0. ? 0. : static_cast<double>(std::sqrt(rho / all));
            if (rho <= target)
              return true;
            // A correction that gains less than a digit has come to what
            // extended precision can resolve. That is accepted if it is nearly
            // good enough.
            if (!(rho < 0.01 * error))
              return result.error <= 1e3 * Tolerance::refinement;
            error = rho;

            ExtendedVector correction = ExtendedVector::Zero(u.size());
            ExtendedVector p          = z;
            for (unsigned int step = 0;
                 rho > 0.1 * target && step < maximum_refinement_iterations;
                 ++step)
              {
                if (interruption.requested())
                  return false;
                ++result.linear_iterations;
                ExtendedVector q = product(p);
                release_held(q);
                const long double curvature = p.dot(q);
                // Rounding alone makes the curvature of a definite matrix
                // vanish or turn into a NaN; what has been corrected so far is
                // kept.
                if (!(curvature > 0.))
                  break;
                const long double alpha = rho / curvature;
                correction += alpha * p;
                r -= alpha * q;
                z = precondition(r);
                // Flexible: a preconditioner in double precision is not quite
                // symmetric.
                const long double beta = -alpha * q.dot(z) / rho;
                rho                    = r.dot(z);
                p                      = z + beta * p;
              }
            u += correction;
          }
      }

      const ExtendedOperator<dim>                         A;
      const ElasticProblem<dim>                          &problem;
      const PiecewiseQuadratic                           &phi;
      CorrectionSolver                                   &solver;
      const Interruption                                 &interruption;
      const std::vector<dealii::types::global_dof_index> &normals;
      const Bounds                                        bounds;

      const ExtendedVector lifting;
      ExtendedVector       u; ///< the displacements, lifting and all
      const ExtendedVector f;
      ExtendedVector       last_force; ///< at u, after solve()
      long double          least_energy = 0.;

      Majorant  majorant;
      ActiveSet active;
    };
  } // namespace



  template <int dim>
  RefinementResult
  refine(const ElasticProblem<dim> &problem,
         const PiecewiseQuadratic  &phi,
         const LoadFactors          factors,
         CorrectionSolver          &solver,
         const Interruption        &interruption,
         DofVector                 &u)
  {
    ExtendedMajorant<dim> majorant(
      problem, phi, factors, solver, interruption, u);
    // The outer loop of majorise-minimise, which ends when the bonds stay on
    // their pieces.
    while (majorant.majorise())
      if (!majorant.minimise())
        return majorant.result;
    RefinementResult result = majorant.result;
    u                       = majorant.rounded();
    result.converged        = true;
    return result;
  }



  template <int dim>
  Refined
  refine_where_needed(const Scene<dim>         &scene,
                      const PiecewiseQuadratic &phi,
                      const LoadFactors         factors,
                      CorrectionSolver         &solver,
                      const Interruption       &interruption,
                      DofVector                &u)
  {
    const ElasticProblem<dim> &problem = scene.problem();
    // All that remains of a body at rest is rounding, over which active sets
    // would wander.
    DofVector forces = problem.diagonal();
    forces.scale(u);
    if (forces.linfty_norm() <= forces_at_rest * scene.least_force())
      {
        u = 0.;
        return {};
      }
    // What rounding may have changed is compared with twice the strain energy,
    // so that refinement is done only if digits are at stake that are printed.
    double energy = 0.;
    if (problem.unknowns().has_lifting())
      energy = 2. * problem.fields().strain_energy(u, factors);
    else
      {
        // <A u, u> = <f, u> - <xi, s> at a minimum: contact forces do no work.
        const Eigen::VectorXd s = problem.unknowns().contact().trace(u);
        energy = problem.load(factors) * u - phi.subgradient(s).dot(s);
      }
    // If nothing of the energy is known, there is every reason to refine.
    const double rounding =
      energy > 0. ? rounding_of_energy(problem, factors, u) / energy : infinity;
    if (rounding <= allowed_energy_rounding(problem.unknowns().n_free_dofs()))
      return {};

    // u stays as it is if the refinement fails, and a note says how many digits
    // to trust.
    const RefinementResult refined =
      refine(problem, phi, factors, solver, interruption, u);
    std::ostringstream note;
    note.precision(1);
    note << std::scientific;
    // All stresses of a body at rest, or of one that has detached, are
    // rounding: nothing is lost.
    const bool has_stresses =
      !problem.unknowns().has_lifting() ||
      rounding * Tolerance::epsilon < Tolerance::no_stresses;
    if (!refined.converged && has_stresses)
      note
        << "in double precision rounding can change " << rounding
        << " of the strain energy, for the body is slender, nearly "
           "incompressible, or moves far more than it is strained, as over a "
           "gap, and the refinement in extended precision ended at a relative "
           "error of "
        << refined.error << " after " << refined.linear_iterations
        << " iterations: do not trust more digits than that.";
    return {refined.converged, note.str()};
  }



  DEBOND_INSTANTIATE(rounding_of_energy);
  DEBOND_INSTANTIATE(refine_where_needed);
  DEBOND_INSTANTIATE(refine);
} // namespace Debond
