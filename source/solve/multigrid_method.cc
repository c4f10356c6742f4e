// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/processes.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/elasticity/mesh_transfer.h>
#include <debond/elasticity/prolongations.h>
#include <debond/linear_algebra/aggregation.h>
#include <debond/linear_algebra/multigrid_factor.h>
#include <debond/solve/condensed_methods.h>
#include <debond/solve/displacement_problem.h>
#include <debond/solve/multigrid_method.h>
#include <debond/solve/refine_result.h>

#include <functional>
#include <memory>

namespace Debond
{
  namespace
  {
    /// On coarser meshes, where the time for a factorisation does not count.
    constexpr double largest_coarse_factorisation = 3e4;



    /// The minimum on the first coarser mesh that is factorised, with the
    /// search of the scene, at the scene's unknowns; zero if there is none. @p
    /// result gets its counts and notes. Each rank does the same.
    template <int dim>
    DofVector
    start_from_coarser_mesh(const SolverParameters &parameters,
                            const Scene<dim>       &scene,
                            const Watch            &fine_watch,
                            SolveResult            &result)
    {
      std::shared_ptr<const Body<dim>> body = scene.body().coarser();
      while (body && dim * body->n_vertices() > largest_coarse_factorisation)
        body = body->coarser();
      if (body == nullptr)
        return DofVector(scene.problem().unknowns().n_dofs());
      const Scene<dim> coarse_scene(scene.parameters(), body);
      SolverParameters coarse = parameters;
      coarse.prove            = false;
      Watch       watch(fine_watch.without_iterations());
      SolveResult start;
      solve_condensed({SolverMethod::majorise_minimise,
                       LinearSolver::direct,
                       ""},
                      coarse,
                      coarse_scene,
                      nullptr,
                      watch,
                      start);
      result.notes                   = start.notes;
      result.minimum                 = start.minimum;
      result.minimum.proof_attempted = false;
      if (!can_be_verified(start.status))
        result.notes.push_back(
          "start on the mesh of " + std::to_string(coarse_scene.n_cells()) +
          (dim == 2 ? " triangles: " : " tetrahedra: ") + start.message);
      return interpolate_displacement(coarse_scene.body(),
                                      coarse_scene.problem(),
                                      start.u,
                                      scene.problem());
    }



    /// Of the coarser levels of the body, or of aggregates.
    template <int dim>
    std::unique_ptr<TruncatedMultigrid>
    make_cycle(const Scene<dim> &scene, const bool has_levels)
    {
      // Trilinos needs MPI even in one process; others need not wait for it.
      start_mpi();
      const auto &unknowns = scene.problem().unknowns();
      const auto &A        = scene.problem().distributed_matrix();
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



    template <int dim>
    class MultigridSolver : public ContactSolver<dim>
    {
    public:
      using typename ContactSolver<dim>::MayGoOn;

      MultigridSolver(const Scene<dim> &scene,
                      const bool        has_levels,
                      const DofVector  &start)
        : problem(scene.problem())
        , cycle(make_cycle(scene, has_levels))
      {
        start_from({}, start);
      }

      void
      start_from(const Eigen::VectorXd &, const DofVector &start) override
      {
        const auto &unknowns = problem.unknowns();
        u                    = distribute(start,
                       unknowns.dof_handler().locally_owned_dofs(),
                       unknowns.communicator());
      }

      MajoriseMinimiseResult
      minimise(const LoadFactors                factors,
               const AdhesionIntegral<dim>     &bonds,
               const SolverParameters          &parameters,
               const MajoriseMinimise::Monitor &monitor,
               const MayGoOn                   &may_go_on) override
      {
        const DofVector load = problem.load(factors);
        // Then rest is the minimum, and residuals have nothing to be relative
        // to on the way.
        if (load.all_zero())
          u = 0.;
        DisplacementProblem minimised(problem, load, bonds, *cycle, u);
        minimised.may_go_on = may_go_on;
        MajoriseMinimiseResult result =
          MajoriseMinimise(parameters.majorise_minimise)
            .minimize(minimised, monitor);
        const double energy = prescribed_energy(problem, bonds, factors);
        result.functional += energy;
        for (MajoriseMinimiseIteration &iteration : result.history)
          iteration.functional += energy;
        return result;
      }

      Eigen::VectorXd
      point() const override
      {
        return ContactUnknowns(problem).trace(u);
      }

      DofVector
      displacement(const LoadFactors            factors,
                   const AdhesionIntegral<dim> &bonds,
                   const MayGoOn               &may_go_on,
                   Refined                     &refined) override
      {
        DofVector           result = gather(u);
        MultigridCorrection correction(problem, *cycle);
        refined = refine_where_needed(
          problem, bonds, factors, correction, may_go_on, result);
        return result;
      }

      const DistributedVector &
      displacements() const
      {
        return u;
      }

      TruncatedMultigrid &
      preconditioner()
      {
        return *cycle;
      }

    private:
      const ElasticProblem<dim>                &problem;
      const std::unique_ptr<TruncatedMultigrid> cycle;
      DistributedVector                         u;
    };
  } // namespace



  template <int dim>
  void
  solve_by_multigrid(const MethodChoice     &choice,
                     const SolverParameters &parameters,
                     const Scene<dim>       &scene,
                     const DofVector        *start,
                     Watch                  &watch,
                     SolveResult            &result)
  {
    const ElasticProblem<dim> &problem = scene.problem();
    watch.add_energy(prescribed_energy(problem, scene.adhesion()));
    watch.announce("multigrid", scene.n_unknowns());
    dealii::Timer timer;
    result.u                         = start != nullptr ?
                                         *start :
                                         start_from_coarser_mesh(parameters, scene, watch, result);
    const ContactSpace<dim> &contact = problem.unknowns().contact();
    contact.add_normal(-contact.trace(result.u).cwiseMax(0.), result.u);
    result.parts["coarser meshes"] = timer.wall_time();
    if (!watch.may_go_on())
      {
        result.status  = SolverStatus::interrupted;
        result.message = "multigrid: the start from coarser meshes was "
                         "interrupted, and is the result.";
        return;
      }

    timer.restart();
    MultigridSolver<dim> solver(scene, choice.has_levels, result.u);
    result.parts["multigrid setup"] = timer.wall_time();

    timer.restart();
    const auto may_go_on = [&watch]() { return watch.may_go_on(); };
    add_majorise_result(solver.minimise(1.,
                                        scene.adhesion(),
                                        parameters,
                                        std::ref(watch),
                                        may_go_on),
                        0.,
                        result);
    result.u = gather(solver.displacements());
    result.parts["contact"] += timer.wall_time();
    // The search was done on a coarser mesh.
    if (choice.has_levels && start == nullptr && wants_search(parameters) &&
        scene.law().branches().size() > 1)
      result.notes.push_back(
        "fronts of bonds are as the search on coarser meshes left them; with "
        "Solver/Linear solver = direct it is done on the finest one");
    MultigridCorrection correction(problem, solver.preconditioner());
    refine_result(scene, correction, watch, result);
  }



  template <int dim>
  Condensation
  condense_by_multigrid(const Scene<dim> &scene, const bool has_levels)
  {
    const Stage                 stage("condensation by multigrid");
    const ElasticProblem<dim>  &problem  = scene.problem();
    const ElasticUnknowns<dim> &unknowns = problem.unknowns();
    const auto                 &normals  = unknowns.contact().normal_dofs();
    return Condensation(
      make_multigrid_factor(problem.distributed_matrix(),
                            eliminate_all_but(
                              {normals.begin(), normals.end()},
                              unknowns.n_dofs(),
                              [&](const unsigned int i) {
                                return unknowns.is_constrained(i);
                              },
                              !unknowns.held_by_contact().motions.empty()),
                            make_cycle(scene, has_levels)),
      problem.load(),
      prescribed_energy(problem, scene.adhesion()));
  }



  template <int dim>
  std::unique_ptr<ContactSolver<dim>>
  make_multigrid_solver(const Scene<dim> &scene, const bool has_levels)
  {
    const ContactSpace<dim> &contact = scene.problem().unknowns().contact();
    DofVector                u(scene.problem().unknowns().n_dofs());
    contact.add_normal(contact.at_rest(), u);
    return std::make_unique<MultigridSolver<dim>>(scene, has_levels, u);
  }



  template decltype(solve_by_multigrid<2>)    solve_by_multigrid<2>;
  template decltype(solve_by_multigrid<3>)    solve_by_multigrid<3>;
  template decltype(condense_by_multigrid<2>) condense_by_multigrid<2>;
  template decltype(condense_by_multigrid<3>) condense_by_multigrid<3>;
  template decltype(make_multigrid_solver<2>) make_multigrid_solver<2>;
  template decltype(make_multigrid_solver<3>) make_multigrid_solver<3>;
} // namespace Debond
