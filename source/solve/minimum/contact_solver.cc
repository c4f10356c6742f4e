// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/base/processes.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/elasticity/prolongations.h>
#include <debond/linear_algebra/aggregation.h>
#include <debond/linear_algebra/multigrid_factor.h>
#include <debond/optimization/bundle/metric_direction.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/solve/minimum/contact_solver.h>
#include <debond/solve/minimum/displacement_problem.h>

#include <numeric>

namespace Debond
{
  namespace
  {
    /// Levels of the coarser meshes of the body, or of aggregates.
    template <int dim>
    std::unique_ptr<TruncatedMultigrid>
    make_cycle(const Scene<dim> &scene, const bool has_levels)
    {
      const Stage stage("multigrid setup");
      // Trilinos needs MPI even in one process; others need not wait for it.
      start_mpi();
      const auto &unknowns = scene.problem().unknowns();
      const auto &A        = scene.problem().distributed_matrix();
      // Geometric levels need the prolongations only; coarse matrices are
      // products P'AP. Other bodies have levels of aggregates, and these have
      // to contain the rigid motions, which smoothers hardly change.
      if (has_levels)
        return std::make_unique<TruncatedMultigrid>(
          A, dim, prolongations(scene.body(), unknowns));
      std::vector<DistributedVector> modes;
      for (const DofVector &mode : unknowns.rigid_body_modes())
        modes.push_back(distribute(mode,
                                   unknowns.dof_handler().locally_owned_dofs(),
                                   scene.ranks()));
      return std::make_unique<TruncatedMultigrid>(
        A, dim, aggregated_prolongations(A, dim, modes));
    }



    /// The scene condensed onto its contact normals, by a factorisation or by a
    /// multigrid solution for each of them.
    template <int dim>
    Condensation
    condense(const MethodChoice &choice, const Scene<dim> &scene)
    {
      const ElasticProblem<dim> &problem = scene.problem();
      if (choice.linear_solver != LinearSolver::multigrid)
        return condense_to_contact(problem, scene.adhesion());
      // The columns of S = A_cc - A_ci A_ii^{-1} A_ic are products with
      // solutions of A_ii. The contact normals are held in them, so that A_ii
      // is definite even if only bonds hold the body.
      const Stage                 stage("condensation by multigrid");
      const ElasticUnknowns<dim> &unknowns = problem.unknowns();
      const auto                 &normals  = unknowns.contact().dofs();
      return Condensation(
        make_multigrid_factor(problem.distributed_matrix(),
                              eliminate_all_but(
                                {normals.begin(), normals.end()},
                                unknowns.n_dofs(),
                                [&](const unsigned int i) {
                                  return unknowns.is_constrained(i);
                                },
                                !unknowns.is_held_by_supports()),
                              make_cycle(scene, choice.has_levels)),
        problem.load(),
        prescribed_energy(problem, scene.adhesion()));
    }



    /// The minimum of J, which is the functional of the problem and the @p
    /// energy of what is prescribed.
    Solution
    by_majorise_minimise(const MajoriseMinimiseParameters &parameters,
                         const double                      energy,
                         Progress                         &progress,
                         MajorantProblem                  &problem)
    {
      // What is printed at each iteration, and what is returned, is J: the
      // functional of the problem and the energy of what is prescribed, which
      // is the same at all points.
      MajoriseMinimiseResult result =
        MajoriseMinimise(parameters)
          .minimize(problem,
                    progress.monitor<MajoriseMinimiseIteration>(energy));
      add_energy(energy, result);
      return solution_of(result);
    }



    /// Minimises the condensed functional, 1/2 s'S s - g's + Phi(s) + c_0.
    template <int dim>
    class CondensedSolver : public ContactSolver<dim>
    {
    public:
      CondensedSolver(const MethodChoice     &choice,
                      const SolverParameters &parameters,
                      const Scene<dim>       &scene)
        : parameters(parameters)
        , scene(scene)
        , problem(scene.problem())
        , contact(problem.unknowns().contact())
        , is_by_bundle(choice.method == SolverMethod::energy_bundle)
        , whole(condense(choice, scene))
        , free_motions(free_motions_of_contact(problem.unknowns()))
        , s(contact.at_rest())
      {}

      void
      start_from(const DofVector &u) override
      {
        // A point from another mesh or load may miss the bounds by its
        // interpolation.
        s = contact.trace(u).cwiseMin(contact.boundary().upper_bounds());
      }

      Solution
      minimise(const LoadFactors            factors,
               const AdhesionIntegral<dim> &bonds,
               Progress                    &progress) override
      {
        // All factors share one factorisation: another load costs its two
        // triangular solves. The whole load costs none, unless bonds have a
        // memory, with which their energy at s = 0 is another one.
        const bool is_whole =
          factors == LoadFactors(1.) && bonds.memory().empty();
        here.emplace(is_whole ? whole :
                                at_factors(whole, problem, bonds, factors));
        // The bundle's epsilon_s is a part of the energy of the body without
        // contact. Without loads there is none, and without contact nodes there
        // is no metric S; majorise-minimise then ends at once.
        if (is_by_bundle && s.size() > 0 && here->energy_without_contact() > 0.)
          return by_bundle(parameters.energy_bundle, bonds, progress);
        // Along motions that only bonds hold, elimination leaves rounding in
        // N'g, which would lift the body or press it on; g gets the exact
        // resultants R'f of the loads. The proximal terms of these motions are
        // scaled by the body's stiffness.
        const Eigen::VectorXd g =
          load_at_contact(problem, *here, factors, free_motions);
        CondensedProblem condensed(condensed_problem(whole, bonds, g),
                                   s,
                                   free_motions,
                                   stiffness_at_contact(problem));
        // From one load to the next few nodes change their contact or the piece
        // of their bond, so that the factor of the last majorant is kept and
        // bordered instead of made anew.
        condensed.factorise_by(factor);
        return by_majorise_minimise(scene.minimisation(
                                      parameters.majorise_minimise),
                                    here->energy_at_zero(),
                                    progress,
                                    condensed);
      }

      Eigen::VectorXd
      point() const override
      {
        return s;
      }

      DofVector
      displacement() const override
      {
        // All other unknowns are at equilibrium with s under the last load: u_i
        // = A_ii^{-1} (f_i - A_ic s).
        return (here ? *here : whole).expand(s);
      }

      std::unique_ptr<CorrectionSolver>
      correction() override
      {
        // The refinement uses the factors of A again, which do not depend on
        // the load.
        return std::make_unique<CondensedCorrection>(whole);
      }

      const Condensation *
      condensed() const override
      {
        return &whole;
      }

    private:
      /// The paper's method in the metric of S: the condensed functional has
      /// the same form on the normals alone.
      Solution
      by_bundle(ProximalBundleParameters     parameters,
                const AdhesionIntegral<dim> &bonds,
                Progress                    &progress)
      {
        // The bundle method works on deal.II's vectors, so that s is copied
        // into one. J(s) has the form of the paper's functional, with S for A
        // and g for f.
        std::vector<unsigned int> normals(s.size());
        std::iota(normals.begin(), normals.end(), 0);
        const MatrixView                 S = whole.schur_complement();
        const dealii::FullMatrix<double> matrix(S.rows(), S.cols(), S.data());
        const DofVector  load(here->load().begin(), here->load().end());
        const Functional functional(
          [&matrix](DofVector &dst, const DofVector &src) {
            matrix.vmult(dst, src);
          },
          load,
          normals,
          bonds);
        // The stop criterion of the paper, v_k >= -epsilon_s, relative to the
        // energy, so that it does not depend on the units of the scene.
        parameters.epsilon_s *= here->energy_without_contact();
        MetricDirection      direction(condensed_problem(whole, bonds),
                                  parameters.bundle_size);
        DofVector            x(s.begin(), s.end());
        const double         energy = here->energy_at_zero();
        ProximalBundleResult bundle =
          ProximalBundle(parameters)
            .minimize(functional,
                      direction,
                      x,
                      progress.monitor<BundleIteration>(energy));
        add_energy(energy, bundle);
        s = eigen_view(x);

        return solution_of(bundle);
      }

      const SolverParameters    &parameters;
      const Scene<dim>          &scene;
      const ElasticProblem<dim> &problem;
      const ContactSpace<dim>   &contact;
      const bool                 is_by_bundle;
      const Condensation         whole;
      const Eigen::MatrixXd      free_motions;
      Eigen::VectorXd            s;
      BorderedCholesky           factor; ///< of the last majorant

      std::optional<Condensation> here; ///< at the last factors
    };



    /// Minimises J on all unknowns by truncated multigrid.
    template <int dim>
    class MultigridSolver : public ContactSolver<dim>
    {
    public:
      MultigridSolver(const bool              has_levels,
                      const SolverParameters &parameters,
                      const Scene<dim>       &scene)
        : parameters(parameters)
        , scene(scene)
        , problem(scene.problem())
        , cycle(make_cycle(scene, has_levels))
      {
        const ElasticUnknowns<dim> &unknowns = problem.unknowns();
        // At rest only contact normals over a gap are not zero.
        DofVector rest(unknowns.n_dofs());
        unknowns.contact().add(unknowns.contact().at_rest(), rest);
        MultigridSolver::start_from(rest);
      }

      void
      start_from(const DofVector &start) override
      {
        const auto              &unknowns = problem.unknowns();
        const ContactSpace<dim> &contact  = unknowns.contact();
        DofVector                v        = start;
        // Interpolation from a coarser mesh may go through the foundation: what
        // is above the bound of s is taken away from the normal displacement
        // alone.
        contact.enforce_bounds(v);
        u = distribute(v,
                       unknowns.dof_handler().locally_owned_dofs(),
                       unknowns.communicator());
      }

      Solution
      minimise(const LoadFactors            factors,
               const AdhesionIntegral<dim> &bonds,
               Progress                    &progress) override
      {
        const DofVector load = problem.load(factors);
        // J on all unknowns, where each majorant is minimised only as exactly
        // as is of use for the next one.
        DisplacementProblem minimised(
          problem, load, bonds, *cycle, u, progress.interruption);
        return by_majorise_minimise(scene.minimisation(
                                      parameters.majorise_minimise),
                                    prescribed_energy(problem, bonds, factors),
                                    progress,
                                    minimised);
      }

      Eigen::VectorXd
      point() const override
      {
        return ContactUnknowns(problem).trace(u);
      }

      DofVector
      displacement() const override
      {
        return gather(u);
      }

      std::unique_ptr<CorrectionSolver>
      correction() override
      {
        // The refinement truncates the same cycle for its own contact set, and
        // the next minimisation prepares it anew.
        return std::make_unique<MultigridCorrection>(problem, *cycle);
      }

    private:
      const SolverParameters                   &parameters;
      const Scene<dim>                         &scene;
      const ElasticProblem<dim>                &problem;
      const std::unique_ptr<TruncatedMultigrid> cycle;
      DistributedVector                         u;
    };



    template <int dim>
    std::unique_ptr<ContactSolver<dim>>
    make(const MethodChoice     &choice,
         const SolverParameters &parameters,
         const Scene<dim>       &scene)
    {
      // Only the first one has S and g.
      if (choice.is_condensed)
        return std::make_unique<CondensedSolver<dim>>(choice,
                                                      parameters,
                                                      scene);
      return std::make_unique<MultigridSolver<dim>>(choice.has_levels,
                                                    parameters,
                                                    scene);
    }



    /// Multigrid that stagnates says nothing about the scene, since materials
    /// or cells may be too much for its smoother. So a factorisation begins
    /// anew, from where this minimisation began and not from where multigrid
    /// was left, and the reader is told.
    template <int dim>
    class MultigridOrFactorisation : public ContactSolver<dim>
    {
    public:
      MultigridOrFactorisation(const MethodChoice     &choice,
                               const SolverParameters &parameters,
                               const Scene<dim>       &scene)
        : choice(choice)
        , parameters(parameters)
        , scene(scene)
        , solver(make(choice, parameters, scene))
      {}

      void
      start_from(const DofVector &u) override
      {
        solver->start_from(u);
      }

      Solution
      minimise(const LoadFactors            factors,
               const AdhesionIntegral<dim> &bonds,
               Progress                    &progress) override
      {
        const auto &unknowns = scene.problem().unknowns();
        DofVector   start(unknowns.n_dofs());
        unknowns.contact().add(solver->point(), start);
        // Only s of the start is kept, since the factorisation finds all other
        // unknowns by elimination.
        Solution   result = solver->minimise(factors, bonds, progress);
        const auto direct =
          factorisation_instead(scene, parameters, choice, result.status);
        if (!direct)
          return result;
        const std::string note =
          "multigrid did not converge, and a factorisation has taken its "
          "place: " +
          result.message;
        choice = *direct;
        // The levels need not lie beside the factor in memory.
        solver.reset();
        solver = make(choice, parameters, scene);
        solver->start_from(start);
        result = solver->minimise(factors, bonds, progress);
        result.notes.push_back(note);
        return result;
      }

      Eigen::VectorXd
      point() const override
      {
        return solver->point();
      }

      DofVector
      displacement() const override
      {
        return solver->displacement();
      }

      std::unique_ptr<CorrectionSolver>
      correction() override
      {
        return solver->correction();
      }

      const Condensation *
      condensed() const override
      {
        return solver->condensed();
      }

    private:
      MethodChoice                        choice;
      const SolverParameters             &parameters;
      const Scene<dim>                   &scene;
      std::unique_ptr<ContactSolver<dim>> solver;
    };
  } // namespace



  template <int dim>
  std::unique_ptr<ContactSolver<dim>>
  make_contact_solver(const MethodChoice     &choice,
                      const SolverParameters &parameters,
                      const Scene<dim>       &scene)
  {
    // A factorisation has nothing that could stand in for it. Multigrid may
    // stagnate, and then has one.
    if (choice.linear_solver == LinearSolver::multigrid)
      return std::make_unique<MultigridOrFactorisation<dim>>(choice,
                                                             parameters,
                                                             scene);
    return make(choice, parameters, scene);
  }



  DEBOND_INSTANTIATE(make_contact_solver);
} // namespace Debond
