// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/elasticity/contact_condensation.h>
#include <debond/elasticity/mesh_transfer.h>
#include <debond/elasticity/multigrid.h>
#include <debond/elasticity/multigrid_problem.h>
#include <debond/elasticity/refinement.h>
#include <debond/solve/condensed_methods.h>
#include <debond/solve/method_choice.h>
#include <debond/solve/multigrid_method.h>
#include <debond/solve/refine_result.h>

#include <functional>
#include <memory>
#include <set>

namespace Debond
{
  namespace
  {
    using Vector = DofVector;



    /// The solution on a mesh of half as many cells in each direction, at the
    /// nodes of the scene's mesh; zero if that mesh is the coarsest. The search
    /// of the scene is done on the first mesh that is factorised; @p search
    /// gets its counts.
    template <int dim>
    Vector
    solution_on_coarser_mesh(const SolverParameters   &parameters,
                             const Scene<dim>         &scene,
                             const InterruptGuard     &guard,
                             const Watch              &fine_watch,
                             std::vector<std::string> &notes,
                             WhichMinimum             &search)
    {
      std::unique_ptr<const Body<dim>> coarse_body = scene.body().coarser();
      if (!coarse_body)
        return Vector(scene.problem().unknowns().n_dofs());
      SolverParameters coarse = parameters;
      coarse.prove            = false;

      const bool factorised =
        dim * coarse_body->n_vertices() <= largest_coarse_factorisation;
      const Scene<dim> coarse_scene(scene.parameters(), std::move(coarse_body));
      Watch            watch(guard, fine_watch);
      SolveResult      result;
      if (factorised)
        solve_condensed(SolverMethod::majorise_minimise,
                        coarse,
                        coarse_scene,
                        nullptr,
                        watch,
                        result);
      else
        solve_by_multigrid(coarse, coarse_scene, guard, watch, result);
      notes.insert(notes.end(), result.notes.begin(), result.notes.end());
      search                 = result.minimum;
      search.proof_attempted = false;
      if (!can_be_verified(result.status))
        notes.push_back(
          "start on the mesh of " + std::to_string(coarse_scene.n_cells()) +
          (dim == 2 ? " triangles: " : " tetrahedra: ") + result.message);
      return interpolate_displacement(coarse_scene.body(),
                                      coarse_scene.problem(),
                                      result.u,
                                      scene.problem());
    }
  } // namespace



  void
  minimise_on_all_unknowns(const SolverParameters &parameters,
                           const double            energy,
                           MajorantProblem        &problem,
                           Watch                  &watch,
                           SolveResult            &result)
  {
    const dealii::Timer timer;
    add_majorise_result(MajoriseMinimise(parameters.majorise_minimise)
                          .minimize(problem, std::ref(watch)),
                        energy,
                        result);
    result.parts["contact"] += timer.wall_time();
  }



  void
  end_at_start(SolveResult &result)
  {
    result.status  = SolverStatus::interrupted;
    result.message = "multigrid: the start from coarser meshes was "
                     "interrupted, and is the result.";
  }



  template <int dim>
  void
  solve_by_multigrid(const SolverParameters &parameters,
                     const Scene<dim>       &scene,
                     const InterruptGuard   &guard,
                     Watch                  &watch,
                     SolveResult            &result)
  {
    dealii::Timer timer;
    result.u = solution_on_coarser_mesh(
      parameters, scene, guard, watch, result.notes, result.minimum);
    result.parts["coarser meshes"] = timer.wall_time();
    if (!watch.may_go_on())
      {
        end_at_start(result);
        return;
      }

    timer.restart();
    // Most of the nodes that are in contact on the coarser mesh will be here.
    // To know them saves a third of the iterations in 2D (640x64), but costs
    // a quarter more in 3D (80x8x8), where few aggregates lie inside.
    std::vector<dealii::types::global_dof_index> held;
    const auto &normals = scene.problem().unknowns().contact().normals();
    if (dim == 2)
      for (const auto normal : normals)
        if (result.u(normal) == 0.)
          held.push_back(normal);
    const double energy = prescribed_energy(scene.problem(), scene.adhesion());
    watch.add_energy(energy);
    watch.announce("multigrid", scene.problem().unknowns().n_free_dofs());
    const Multigrid multigrid(scene.problem(), held);
    result.parts["multigrid setup"] = timer.wall_time();

    MultigridCorrection   cycle(multigrid, normals);
    MultigridProblem<dim> problem(scene.problem(),
                                  scene.adhesion(),
                                  cycle,
                                  result.u,
                                  [&watch]() { return watch.may_go_on(); });
    minimise_on_all_unknowns(parameters, energy, problem, watch, result);
    refine_result(scene, cycle, watch, result);
  }



  template decltype(solve_by_multigrid<2>) solve_by_multigrid<2>;
  template decltype(solve_by_multigrid<3>) solve_by_multigrid<3>;
} // namespace Debond
