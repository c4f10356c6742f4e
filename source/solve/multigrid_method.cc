// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>
#include <deal.II/base/timer.h>

#include <debond/elasticity/contact_condensation.h>
#include <debond/elasticity/level_problem.h>
#include <debond/elasticity/mesh_transfer.h>
#include <debond/elasticity/multigrid_problem.h>
#include <debond/input/bad_input.h>
#include <debond/optimization/piecewise_quadratic.h>
#include <debond/solve/condensed_methods.h>
#include <debond/solve/multigrid_method.h>
#include <debond/solve/refine_result.h>
#include <debond/solve/solve.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

namespace Debond
{
  namespace
  {
    using Vector = DofVector;



    /// On coarser meshes, where the time for a factorisation does not count.
    constexpr double largest_coarse_factorisation = 3e4;

    /// A level needs to be solved to what the next finer one makes of it.
    constexpr double coarse_level_tolerance = 1e-4;



    void
    keep_admissible(const std::vector<unsigned int> &normals, Vector &u)
    {
      for (const unsigned int normal : normals)
        if (normal != dealii::numbers::invalid_unsigned_int)
          u(normal) = std::min(u(normal), 0.);
    }



    /// The first coarser mesh that is factorised, null if there is none, and
    /// its level.
    template <int dim>
    std::pair<std::shared_ptr<const Body<dim>>, unsigned int>
    factorised_body(const Scene<dim> &scene)
    {
      std::shared_ptr<const Body<dim>> body  = scene.body().coarser();
      unsigned int                     level = 1;
      for (; body && dim * body->n_vertices() > largest_coarse_factorisation;
           ++level)
        body = body->coarser();
      return {body, level};
    }



    /// The minimum on a coarser mesh, with the search of the scene; @p result
    /// gets its counts and notes.
    template <int dim>
    Vector
    solve_factorised(const SolverParameters &parameters,
                     const Scene<dim>       &scene,
                     const InterruptGuard   &guard,
                     const Watch            &fine_watch,
                     SolveResult            &result)
    {
      SolverParameters coarse = parameters;
      coarse.prove            = false;
      Watch       watch(guard, fine_watch);
      SolveResult start;
      solve_condensed(
        SolverMethod::majorise_minimise, coarse, scene, nullptr, watch, start);
      result.notes                   = start.notes;
      result.minimum                 = start.minimum;
      result.minimum.proof_attempted = false;
      if (!can_be_verified(start.status))
        result.notes.push_back(
          "start on the mesh of " + std::to_string(scene.n_cells()) +
          (dim == 2 ? " triangles: " : " tetrahedra: ") + start.message);
      return start.u;
    }



    /// From the first coarser mesh that is factorised; zero if there is none.
    template <int dim>
    Vector
    start_without_levels(const SolverParameters &parameters,
                         const Scene<dim>       &scene,
                         const InterruptGuard   &guard,
                         const Watch            &watch,
                         SolveResult            &result)
    {
      const std::shared_ptr<const Body<dim>> body =
        factorised_body(scene).first;
      if (body == nullptr)
        return Vector(scene.problem().unknowns().n_dofs());
      const Scene<dim> coarse_scene(scene.parameters(), body);
      return interpolate_displacement(
        coarse_scene.body(),
        coarse_scene.problem(),
        solve_factorised(parameters, coarse_scene, guard, watch, result),
        scene.problem());
    }



    /// The minimum of J on a coarser level, from @p u.
    template <int dim>
    void
    minimise_on_level(const SolverParameters &parameters,
                      const Scene<dim>       &scene,
                      ElasticLevels<dim>     &levels,
                      const unsigned int      l,
                      const Watch            &watch,
                      Vector                 &u,
                      SolveResult            &result)
    {
      MajoriseMinimiseParameters of_level = parameters.majorise_minimise;
      of_level.tolerance = std::max(of_level.tolerance, coarse_level_tolerance);
      const auto may_go_on = [&watch]() { return watch.may_go_on(); };
      const RestrictedFunction     phi(scene.adhesion(),
                                   levels.trace_prolongation(l));
      LevelCorrection<dim>         cycle(levels, l);
      LevelProblem<dim>            problem(cycle, phi, u, may_go_on);
      const MajoriseMinimiseResult minimum =
        MajoriseMinimise(of_level).minimize(
          problem,
          [&](const MajoriseMinimiseIteration &) { return may_go_on(); });
      if (!can_be_verified(minimum.status))
        result.notes.push_back("start on " +
                               std::to_string(levels.n_whole_unknowns(l)) +
                               " unknowns: " + minimum.message);
    }



    /// Minima on the coarser levels that the process has alone, each the start
    /// of the next finer one, from that of the first coarser mesh that is
    /// factorised, on which the search of the scene is done; @p result gets its
    /// counts and notes. Returns that of the last of these levels, or the start
    /// on the finest one.
    template <int dim>
    Vector
    start_from_levels(const MethodChoice     &choice,
                      const SolverParameters &parameters,
                      const Scene<dim>       &scene,
                      ElasticLevels<dim>     &levels,
                      const InterruptGuard   &guard,
                      const Watch            &fine_watch,
                      SolveResult            &result)
    {
      auto [body, l] = factorised_body(scene);

      Vector     u;
      const bool is_solved = body != nullptr;
      if (is_solved)
        {
          const Scene<dim> coarse_scene(scene.parameters(), body);
          // A piece does not know what holds the whole.
          check_supports_of_method(choice, parameters, coarse_scene);
          u = solve_factorised(
            parameters, coarse_scene, guard, fine_watch, result);
          // The subspaces are those of what is zero where it is prescribed.
          if (scene.problem().unknowns().has_lifting() ||
              l >= levels.n_levels())
            return interpolate_displacement(coarse_scene.body(),
                                            coarse_scene.problem(),
                                            u,
                                            scene.problem());
          u = levels.from_vertex_displacements(
            l,
            body->interpolate(coarse_scene.problem()
                                .unknowns()
                                .dof_handler()
                                .get_triangulation(),
                              vertex_displacements(coarse_scene.problem(), u),
                              levels.vertices(l)));
          keep_admissible(levels.normals(l), u);
        }
      else
        {
          l = levels.n_levels() - 1;
          u.reinit(levels.n_unknowns(l));
        }

      const unsigned int solved_level = is_solved ? l : levels.n_levels();
      for (;; --l)
        {
          if (l > 0 && l != solved_level && fine_watch.may_go_on())
            minimise_on_level(
              parameters, scene, levels, l, fine_watch, u, result);
          if (l == levels.n_shared_levels())
            return u;
          u = levels.prolongate(l, u);
          keep_admissible(levels.normals(l - 1), u);
        }
    }



    /// The same where ranks share levels: the root has the others.
    template <int dim>
    Vector
    start_from_root(const MethodChoice     &choice,
                    const SolverParameters &parameters,
                    const Scene<dim>       &scene,
                    ElasticLevels<dim>     &levels,
                    const InterruptGuard   &guard,
                    const Watch            &fine_watch,
                    SolveResult            &result)
    {
      Vector                   u;
      std::vector<std::string> errors;
      if (levels.is_root())
        try
          {
            u = start_from_levels(choice,
                                  parameters,
                                  scene,
                                  levels,
                                  guard,
                                  Watch(guard, fine_watch),
                                  result);
          }
        catch (const BadInput &error)
          {
            errors = error.lines;
          }
      errors =
        dealii::Utilities::MPI::broadcast(scene.piece()->nodes().communicator(),
                                          errors);
      if (!errors.empty())
        throw BadInput(errors);
      for (unsigned int l = levels.n_shared_levels(); l > 0; --l)
        {
          u = levels.prolongate(l, u);
          keep_admissible(levels.normals(l - 1), u);
          if (l > 1 && fine_watch.may_go_on())
            minimise_on_level(
              parameters, scene, levels, l - 1, fine_watch, u, result);
        }
      return u;
    }



    /// Majorise-minimise on all unknowns from result.u.
    template <int dim>
    void
    minimise(const SolverParameters &parameters,
             const Scene<dim>       &scene,
             DisplacementProblem    &problem,
             Watch                  &watch,
             SolveResult            &result)
    {
      const dealii::Timer timer;
      add_majorise_result(MajoriseMinimise(parameters.majorise_minimise)
                            .minimize(problem, std::ref(watch)),
                          prescribed_energy(scene.problem(), scene.adhesion()),
                          result);
      result.parts["contact"] += timer.wall_time();
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
    const auto may_go_on = [&watch]() { return watch.may_go_on(); };
    watch.add_energy(prescribed_energy(scene.problem(), scene.adhesion()));
    watch.announce("multigrid", scene.n_unknowns());
    dealii::Timer                       timer;
    std::unique_ptr<ElasticLevels<dim>> levels;
    if (choice.has_levels)
      levels = scene.piece() == nullptr ?
                 ElasticLevels<dim>::make(scene.body(), scene.problem()) :
                 ElasticLevels<dim>::make(*scene.piece(),
                                          scene.problem(),
                                          factorised_body(scene).second);
    result.parts["multigrid setup"] = timer.wall_time();

    timer.restart();
    if (!choice.has_levels)
      result.u = start_without_levels(parameters, scene, guard, watch, result);
    else if (scene.piece() == nullptr)
      result.u = start_from_levels(
        choice, parameters, scene, *levels, guard, watch, result);
    else
      result.u = start_from_root(
        choice, parameters, scene, *levels, guard, watch, result);
    result.parts["coarser meshes"] = timer.wall_time();
    if (!watch.may_go_on())
      {
        result.status  = SolverStatus::interrupted;
        result.message = "multigrid: the start from coarser meshes was "
                         "interrupted, and is the result.";
        return;
      }

    if (choice.has_levels)
      {
        LevelCorrection<dim> cycle(*levels);
        LevelProblem<dim> problem(cycle, scene.adhesion(), result.u, may_go_on);
        minimise(parameters, scene, problem, watch, result);
        // The search was done on a coarser mesh.
        if (wants_search(parameters) && scene.law().branches().size() > 1)
          result.notes.push_back(
            "fronts of bonds are as the search on coarser meshes left them; with "
            "Solver/Linear solver = direct it is done on the finest one");
        refine_result(scene, cycle, watch, result);
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
    const Multigrid multigrid(scene.problem(), held);
    result.parts["multigrid setup"] = timer.wall_time();
    MultigridCorrection   cycle(multigrid, normals);
    MultigridProblem<dim> problem(
      scene.problem(), scene.adhesion(), cycle, result.u, may_go_on);
    minimise(parameters, scene, problem, watch, result);
    refine_result(scene, cycle, watch, result);
  }



  template decltype(solve_by_multigrid<2>) solve_by_multigrid<2>;
  template decltype(solve_by_multigrid<3>) solve_by_multigrid<3>;
} // namespace Debond
