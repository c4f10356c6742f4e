// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/elasticity/contact_condensation.h>
#include <debond/elasticity/displacement_problem.h>
#include <debond/elasticity/mesh_transfer.h>
#include <debond/elasticity/prolongations.h>
#include <debond/solve/condensed_methods.h>
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
                            const InterruptGuard   &guard,
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
      Watch       watch(guard, fine_watch);
      SolveResult start;
      solve_condensed(SolverMethod::majorise_minimise,
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
      DofVector                u = interpolate_displacement(coarse_scene.body(),
                                             coarse_scene.problem(),
                                             start.u,
                                             scene.problem());
      const ContactSpace<dim> &contact = scene.problem().unknowns().contact();
      contact.add_normal(-contact.trace(u).cwiseMax(0.), u);
      return u;
    }



    /// Of the coarser levels of the body, or of aggregates.
    template <int dim>
    std::unique_ptr<TruncatedMultigrid>
    make_cycle(const Scene<dim> &scene, const bool has_levels)
    {
      const auto &unknowns = scene.problem().unknowns();
      const auto &A        = scene.problem().trilinos_matrix();
      if (has_levels)
        return std::make_unique<TruncatedMultigrid>(A,
                                                    prolongations(scene.body(),
                                                                  unknowns));
      std::vector<DistributedVector> modes;
      for (const DofVector &mode : unknowns.rigid_body_modes())
        modes.push_back(distribute(mode,
                                   unknowns.dof_handler().locally_owned_dofs(),
                                   scene.ranks()));
      return std::make_unique<TruncatedMultigrid>(A, dim, modes);
    }
  } // namespace



  template <int dim>
  void
  solve_by_multigrid(const MethodChoice     &choice,
                     const SolverParameters &parameters,
                     const Scene<dim>       &scene,
                     const InterruptGuard   &guard,
                     Watch                  &watch,
                     SolveResult            &result)
  {
    const ElasticProblem<dim> &problem = scene.problem();
    watch.add_energy(prescribed_energy(problem, scene.adhesion()));
    watch.announce("multigrid", scene.n_unknowns());
    dealii::Timer timer;
    result.u = start_from_coarser_mesh(parameters, scene, guard, watch, result);
    result.parts["coarser meshes"] = timer.wall_time();
    if (!watch.may_go_on())
      {
        result.status  = SolverStatus::interrupted;
        result.message = "multigrid: the start from coarser meshes was "
                         "interrupted, and is the result.";
        return;
      }

    timer.restart();
    const std::unique_ptr<TruncatedMultigrid> cycle =
      make_cycle(scene, choice.has_levels);
    result.parts["multigrid setup"] = timer.wall_time();

    timer.restart();
    DistributedVector u =
      distribute(result.u,
                 problem.unknowns().dof_handler().locally_owned_dofs(),
                 scene.ranks());
    DisplacementProblem minimised(problem, scene.adhesion(), *cycle, u);
    minimised.may_go_on = [&watch]() { return watch.may_go_on(); };
    add_majorise_result(MajoriseMinimise(parameters.majorise_minimise)
                          .minimize(minimised, std::ref(watch)),
                        prescribed_energy(problem, scene.adhesion()),
                        result);
    result.u = gather(u);
    result.parts["contact"] += timer.wall_time();
    // The search was done on a coarser mesh.
    if (choice.has_levels && wants_search(parameters) &&
        scene.law().branches().size() > 1)
      result.notes.push_back(
        "fronts of bonds are as the search on coarser meshes left them; with "
        "Solver/Linear solver = direct it is done on the finest one");
    MultigridCorrection correction(problem, *cycle);
    refine_result(scene, correction, watch, result);
  }



  template decltype(solve_by_multigrid<2>) solve_by_multigrid<2>;
  template decltype(solve_by_multigrid<3>) solve_by_multigrid<3>;
} // namespace Debond
