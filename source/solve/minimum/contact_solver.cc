// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/base/processes.h>
#include <debond/contact/boundary_coarsening.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/elasticity/mesh_transfer.h>
#include <debond/elasticity/prolongations.h>
#include <debond/linear_algebra/aggregation.h>
#include <debond/linear_algebra/multigrid_factor.h>
#include <debond/optimization/bundle/metric_direction.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/solve/minimum/contact_solver.h>
#include <debond/solve/minimum/displacement_problem.h>
#include <debond/solve/minimum/solve.h>

#include <numeric>

namespace Debond
{
  namespace
  {
    /// Contact boundaries with more nodes take their start from coarser ones.
    constexpr unsigned int coarsest_contact_nodes = 50;

    /// The number of unknowns up to which a coarser mesh is factorised for the
    /// start: there a factorisation takes a small part of the time of the
    /// finest mesh, even in 3D.
    constexpr double largest_coarse_factorisation = 3e4;



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
      // solutions of A_ii. The contact normals are held in them, so that
      // A_ii is definite even where only bonds hold the body.
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
    ContactMinimum
    by_majorise_minimise(const MajoriseMinimiseParameters &parameters,
                         const double                      energy,
                         Progress                         &progress,
                         MajorantProblem                  &problem)
    {
      ContactMinimum result;
      static_cast<MajoriseMinimiseResult &>(result) =
        MajoriseMinimise(parameters)
          .minimize(problem,
                    progress.monitor<MajoriseMinimiseIteration>(energy));
      add_energy(energy, result);
      return result;
    }



    /// Minimises the condensed functional, 1/2 s'S s - g's + Phi(s) + c_0.
    template <int dim>
    class CondensedSolver : public ContactSolver<dim>
    {
    public:
      CondensedSolver(const MethodChoice &choice, const Scene<dim> &scene)
        : scene(scene)
        , problem(scene.problem())
        , contact(problem.unknowns().contact())
        , is_by_bundle(choice.method == SolverMethod::energy_bundle)
        , whole(condense(choice, scene))
        , free_motions(free_motions_of_contact(problem.unknowns()))
        , s(contact.at_rest())
      {}

      void
      start_from(const Eigen::VectorXd &point, const DofVector &) override
      {
        // A point from another mesh or load may miss the bounds by its
        // interpolation.
        s = point.cwiseMin(contact.boundary().upper_bounds());
      }

      void
      start_from_coarser(const SolverParameters &parameters,
                         SolveResult            &result) override
      {
        // Coarser spaces do not know the gaps of bodies at rest, and what only
        // bonds hold has to start with all of them. They have no tangents
        // either.
        if (is_by_bundle || problem.unknowns().has_gap() ||
            free_motions.cols() > 0 || scene.adhesion().shears())
          return;
        // Active sets and fronts of bonds move by few nodes a step. From
        // subspaces with half as many nodes each the finest one needs one or
        // two systems; the minimum that is found may be another one than that
        // of slow loading from rest.
        s = coarse_start(condensed_problem(whole, scene.adhesion()),
                         coarsen(contact.boundary(), coarsest_contact_nodes),
                         MajoriseMinimise(parameters.majorise_minimise),
                         result.notes);
      }

      ContactMinimum
      minimise(const LoadFactors            factors,
               const AdhesionIntegral<dim> &bonds,
               const SolverParameters      &parameters,
               Progress                    &progress) override
      {
        // All factors share one factorisation: another load costs its two
        // triangular solves.
        // Bonds that have broken for good have another energy at s = 0.
        const bool is_whole =
          factors == LoadFactors(1.) &&
          bonds.value_at_zero() == scene.adhesion().value_at_zero();
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
        return here->expand(s);
      }

      std::unique_ptr<CorrectionSolver>
      correction() override
      {
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
      ContactMinimum
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

        ContactMinimum result;
        result.status     = bundle.status;
        result.functional = bundle.functional;
        // The log of an iteration has the same columns for all methods: v_k
        // takes the place of the residual, and QP steps that of active set
        // steps.
        result.residual = bundle.v;
        result.message  = bundle.message;
        for (const BundleIteration &iteration : bundle.history)
          result.history.push_back({iteration.iteration,
                                    iteration.functional,
                                    iteration.v,
                                    iteration.qp_steps,
                                    0,
                                    0});
        result.bundle = std::move(bundle);
        return result;
      }

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
      MultigridSolver(const Scene<dim> &scene, const bool has_levels)
        : scene(scene)
        , problem(scene.problem())
        , cycle(make_cycle(scene, has_levels))
      {
        const ElasticUnknowns<dim> &unknowns = problem.unknowns();
        DofVector                   rest(unknowns.n_dofs());
        unknowns.contact().add(unknowns.contact().at_rest(), rest);
        start_from({}, rest);
      }

      void
      start_from(const Eigen::VectorXd &, const DofVector &start) override
      {
        const auto              &unknowns = problem.unknowns();
        const ContactSpace<dim> &contact  = unknowns.contact();
        DofVector                v        = start;
        // Interpolation from a coarser mesh may go through the foundation: what
        // is above zero of s is taken away from the normal displacement alone.
        contact.enforce_bounds(v);
        u = distribute(v,
                       unknowns.dof_handler().locally_owned_dofs(),
                       unknowns.communicator());
      }

      /// The first coarser mesh that is factorised has the search of the scene.
      /// Each rank does the same.
      void
      start_from_coarser(const SolverParameters &parameters,
                         SolveResult            &result) override
      {
        // This mesh decides which of the minima is found, so it is the finest
        // one that can have the whole search. Its proof would say nothing about
        // the finest mesh.
        std::shared_ptr<const Body<dim>> body = scene.body().coarser();
        while (body && dim * body->n_vertices() > largest_coarse_factorisation)
          body = body->coarser();
        if (body == nullptr)
          return;
        // The coarse mesh is a scene of its own, on which loads, supports and
        // bonds are evaluated anew. What its search found is told with the
        // result.
        const Scene<dim> coarse_scene(scene.parameters(), body);
        SolverParameters coarse = parameters;
        coarse.prove            = false;
        MethodChoice choice;
        choice.method        = SolverMethod::majorise_minimise;
        choice.linear_solver = LinearSolver::direct;
        choice.is_condensed  = true;
        Progress    silent;
        SolveResult start;
        solve_contact(choice, coarse, coarse_scene, nullptr, silent, start);
        result.notes                   = start.notes;
        result.minimum                 = start.minimum;
        result.minimum.proof_attempted = false;
        // Even a failure leaves a displacement that is nearer to the minimum
        // than rest, so it is used, and a note says so.
        if (!can_be_verified(start.status))
          result.notes.push_back(
            "start on the mesh of " + std::to_string(coarse_scene.n_cells()) +
            (dim == 2 ? " triangles: " : " tetrahedra: ") + start.message);
        start_from({},
                   interpolate_displacement(coarse_scene.problem(),
                                            start.u,
                                            problem));
      }

      ContactMinimum
      minimise(const LoadFactors            factors,
               const AdhesionIntegral<dim> &bonds,
               const SolverParameters      &parameters,
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
        return std::make_unique<MultigridCorrection>(problem, *cycle);
      }

    private:
      const Scene<dim>                         &scene;
      const ElasticProblem<dim>                &problem;
      const std::unique_ptr<TruncatedMultigrid> cycle;
      DistributedVector                         u;
    };
  } // namespace



  template <int dim>
  std::unique_ptr<ContactSolver<dim>>
  make_contact_solver(const MethodChoice &choice, const Scene<dim> &scene)
  {
    // Both are one interface to the caller, but only the first one has S and g.
    if (choice.is_condensed)
      return std::make_unique<CondensedSolver<dim>>(choice, scene);
    return std::make_unique<MultigridSolver<dim>>(scene, choice.has_levels);
  }



  DEBOND_INSTANTIATE(make_contact_solver);
} // namespace Debond
