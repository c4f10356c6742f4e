// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/instantiate.h>
#include <debond/base/memory.h>
#include <debond/elasticity/mesh_transfer.h>
#include <debond/input/bad_input.h>
#include <debond/mesh/bisected_body.h>
#include <debond/mesh/owned_cells.h>
#include <debond/solve/meshes/adaptive_loop.h>

namespace Debond
{
  namespace
  {
    /// The growth of the cells from mesh to mesh if a goal besides the estimate
    /// has not been reached. The goal does not say how fine its mesh will be,
    /// so the steps are small.
    constexpr double growth_for_goal = 1.7;



    template <int dim>
    const BisectedBody<dim> &
    bisected(const Scene<dim> &scene)
    {
      return dynamic_cast<const BisectedBody<dim> &>(scene.body());
    }



    /// Why there can be no mesh as large as that of @p body; empty if there
    /// can. @p limit: of memory in bytes; @p goal may be null.
    template <int dim>
    std::string
    too_large(const ProblemParameters   &problem,
              const AccuracyParameters  &accuracy,
              const MethodChoice        &wanted,
              const RefinementGoal<dim> *goal,
              const double               limit,
              const Body<dim>           &body)
    {
      // Of degree 2 edges have unknowns as well, their number by Euler's
      // formula for bodies without holes, in 3D about.
      const double n_nodes    = problem.degree == 1 ?
                                  body.n_vertices() :
                                  2. * body.n_vertices() + body.n_cells() - 1.;
      const double n_unknowns = dim * n_nodes;
      // A goal has a factorisation of its own (such as the problem for stresses
      // in equilibrium), which may need more unknowns than the displacements
      // do.
      const double memory =
        goal != nullptr ?
          memory_of_factorisation(dim,
                                  std::max(n_unknowns,
                                           goal->n_unknowns(body.n_cells()))) :
          least_memory(wanted, dim, n_unknowns);
      std::ostringstream text;
      text << "the next mesh would have " << std::fixed << std::setprecision(0)
           << n_unknowns << " unknowns, ";
      if (accuracy.maximum_unknowns > 0 &&
          n_unknowns > accuracy.maximum_unknowns)
        text << "Accuracy/Maximum unknowns is " << accuracy.maximum_unknowns;
      else if (memory > limit)
        text << "which need about " << std::setprecision(2)
             << memory / (1 << 30) << " GiB of memory, the limit is "
             << limit / (1 << 30) << " GiB";
      else
        return "";
      return text.str();
    }



    /// Returns the numbers of all cells, by their places in the whole mesh,
    /// from those that each rank has for its own. The mesh is divided by all
    /// ranks alike.
    template <int dim>
    std::vector<double>
    of_whole_mesh(const Scene<dim> &scene, const std::vector<double> &of_cells)
    {
      std::vector<double> result(scene.n_cells(), 0.);
      for (const auto &cell :
           owned_cells(scene.problem().unknowns().dof_handler()))
        result[cell->id().get_coarse_cell_id()] =
          of_cells[cell->active_cell_index()];
      dealii::Utilities::MPI::sum(result, scene.ranks(), result);
      return result;
    }



    template <int dim>
    class AdaptiveLoop
    {
    public:
      AdaptiveLoop(const SolveSettings              &settings,
                   const AccuracyParameters         &accuracy,
                   RefinementGoal<dim>              *goal,
                   const AdaptiveProgress           &begun,
                   const AdaptiveObserver<dim>      &observer,
                   std::shared_ptr<const Scene<dim>> first)
        : settings(settings)
        , accuracy(accuracy)
        , goal(goal)
        , observer(observer)
        , scene(std::move(first))
        , problem(scene->parameters())
        , ranks(scene->ranks())
        , wanted(choose_method(problem, settings.parameters))
        , progress(begun)
        , growth(accuracy, dim, problem.degree)
      {
        // The meshes of an interrupted run count as this one's: the observer
        // sees all of them, and the factor of the error is measured with them.
        for (unsigned int k = 0; k < progress.levels.size(); ++k)
          {
            observer.level_is_done(k, progress.levels[k]);
            growth.add(progress.levels[k]);
          }
      }

      AdaptiveResult<dim>
      run()
      {
        // Each pass of the loop takes one mesh further: cells are divided where
        // the estimate is large, the scene is evaluated anew, and the state of
        // the mesh before is the start.
        seconds = scene->mesh_seconds() + scene->assembly_seconds();
        solve_on(scene, without_proof(settings.choice));
        while (!is_finished())
          {
            timer.restart();
            seconds = 0.;
            std::string limit;
            // The next mesh is made before it is known to be affordable, since
            // closure cuts more cells than are asked for; the body alone is
            // small.
            const std::shared_ptr<const BisectedBody<dim>> body =
              next_body(limit);
            // An estimate relative to J = 0 is no aim either.
            if (!limit.empty() || estimate.functional == 0.)
              {
                say_what_is_missing(limit);
                break;
              }
            const auto next =
              std::make_shared<const Scene<dim>>(problem, body, "", ranks);
            SolveSettings on_next = without_proof(wanted);
            try
              {
                // The choice depends on the size, so that a sequence may begin
                // with a factorisation and end with multigrid. What does not
                // fit ends the sequence, not the run: the result of the mesh
                // before stays.
                choose_linear_solver(*next,
                                     settings.parameters,
                                     on_next.choice);
              }
            catch (const BadInput &error)
              {
                say_what_is_missing(error.what());
                break;
              }
            if (interruption.requested())
              {
                interrupt();
                break;
              }
            // The interpolated state keeps the fronts of the bonds, so that a
            // finer mesh stays with the same minimum and needs few steps.
            progress.start = divided_displacement(scene->problem(),
                                                  result.path.result.u,
                                                  body->ancestors(),
                                                  next->problem());
            observer.next_mesh_is_made(progress, *next);
            const std::shared_ptr<const Body<dim>> finished = latest;
            latest                                          = body;
            // Mesh and matrix of the old scene would lie beside the new
            // factorisation at the peak of the memory. The state of a path
            // refers to its scene, which then has to stay.
            if (finished && result.path.progress.steps.empty())
              scene.reset();
            if (!solve_on(next, on_next))
              {
                // A signal has ended the work on the new mesh; the files are
                // written for the old one, which has to be made again.
                if (!scene)
                  scene = std::make_shared<const Scene<dim>>(problem,
                                                             finished,
                                                             "",
                                                             ranks);
                break;
              }
          }
        // The proof is about one mesh, so it waits for the last one and starts
        // from its result.
        if (settings.parameters.prove &&
            result.path.result.status == SolverStatus::success)
          result.path.result = solve(result.choice,
                                     settings.parameters,
                                     *scene,
                                     nullptr,
                                     false,
                                     &result.path.result.u);
        result.scene  = scene;
        result.levels = progress.levels;
        return std::move(result);
      }

    private:
      /// Only the last mesh has a proof.
      SolveSettings
      without_proof(const MethodChoice &choice_of_mesh) const
      {
        SolveSettings result    = settings;
        result.choice           = choice_of_mesh;
        result.parameters.prove = false;
        return result;
      }

      /// Solves on one mesh. Returns whether there is a result on it, which a
      /// finer one may replace, or which is the last word; if a signal came
      /// before, the result of the mesh before stays.
      bool
      solve_on(const std::shared_ptr<const Scene<dim>> &here,
               const SolveSettings                     &on_mesh)
      {
        estimate = {};
        FollowedPath<dim> path;
        SolveResult       solution;
        try
          {
            if (problem.load_path.factors.empty())
              {
                solution =
                  solve(on_mesh.choice,
                        on_mesh.parameters,
                        *here,
                        nullptr,
                        false,
                        progress.start.size() > 0 ? &progress.start : nullptr);
                functional = solution.functional;
                // An estimate of what is no equilibrium would measure the
                // residual of the solver and not the error of the mesh.
                if (can_be_verified(solution.status) &&
                    !solution.minimum.interrupted)
                  estimate = estimate_error(here->estimated(here->adhesion()),
                                            solution.u,
                                            solution.functional);
              }
            else
              {
                path     = follow(*here, on_mesh);
                solution = std::move(path.result);
              }
          }
        // The data of the scene are evaluated at points that the solve does not
        // ask for, and may be wrong there. The result is none the worse, but
        // there is nothing to refine by.
        catch (const std::invalid_argument &error)
          {
            result.shortfall =
              std::string("The error of the mesh is not known, ") +
              error.what() + '.';
          }
        // Half a solve on a finer mesh is worth less than a finished one on a
        // coarser mesh.
        const bool has_result = result.path.result.u.size() > 0;
        if (has_result && solution.status == SolverStatus::interrupted)
          {
            interrupt();
            return false;
          }
        // From here on the result is that of this mesh, whatever it is worth;
        // only a signal leaves that of the mesh before in its place.
        path.result   = std::move(solution);
        result.path   = std::move(path);
        scene         = here;
        result.choice = on_mesh.choice;
        // Where the body comes off on the way, the factors before that count.
        const bool comes_off_later =
          result.path.result.status == SolverStatus::comes_off &&
          !result.path.progress.steps.empty();
        const bool is_usable =
          (can_be_verified(result.path.result.status) || comes_off_later) &&
          !result.path.result.minimum.interrupted;
        if (is_usable && result.shortfall.empty())
          look_at_goal(false);
        ended = !is_usable || !result.shortfall.empty();
        if (!ended)
          add_level();
        return true;
      }

      /// Lists the mesh, for later ones that are compared with it.
      void
      add_level()
      {
        const ElasticUnknowns<dim> &unknowns = scene->problem().unknowns();
        // What a search has lowered J by on this mesh is no gain of
        // refinement, and is left out of the measured factor.
        const double search_gain =
          result.path.result.functional_from_start.value_or(functional) -
          functional;
        // What later meshes are compared with, and what log and summary say
        // of this one. add() sets its error_factor.
        AdaptiveLevel level = {scene->n_cells(),
                               unknowns.n_free_dofs(),
                               static_cast<unsigned int>(
                                 scene->contact_boundary().nodes.size()),
                               result.path.result.iterations,
                               estimated_step,
                               functional,
                               estimate.relative(),
                               estimate.scale,
                               search_gain,
                               {},
                               goal_here.width,
                               seconds + timer.wall_time()};
        growth.add(level);
        observer.level_is_done(
          static_cast<unsigned int>(progress.levels.size()), level);
        progress.levels.push_back(level);
      }

      /// The states that the load path leads to, with the estimate of the one
      /// that has the largest error relative to its J.
      FollowedPath<dim>
      follow(const Scene<dim> &here, const SolveSettings &on_mesh)
      {
        // Global branch and arc belong to the last mesh alone.
        LoadPathParameters followed = problem.load_path;
        followed.global_branch      = GlobalBranch::none;
        followed.arc                = false;
        return follow_load_path<dim>(
          followed,
          on_mesh,
          here,
          {},
          [&](const PathProgress<dim>     &progress,
              const Verification<dim>     &verification,
              const AdhesionIntegral<dim> &bonds) {
            observer.step_is_done(progress, verification, bonds);
            const LoadPathStep<dim> &step = progress.steps.back();
            ErrorEstimate            own = estimate_error(here.estimated(bonds),
                                               progress.u,
                                               step.state.functional,
                                               step.factors());
            // Rounding does not choose between steps that are as good.
            if (estimate.cells.empty() ||
                own.relative() >
                  (1. + Tolerance::decimals) * estimate.relative())
              {
                estimate       = std::move(own);
                functional     = step.state.functional;
                estimated_step = step.step;
              }
          },
          nullptr);
      }

      void
      look_at_goal(const bool is_last)
      {
        if (goal == nullptr)
          return;
        // A goal that cannot be looked at on this mesh ends the refinement with
        // its reason.
        goal_here        = goal->look(scene, result.path.result, is_last);
        result.shortfall = goal_here.failure;
      }

      bool
      is_finished()
      {
        if (ended)
          return true;
        if (goal == nullptr)
          return growth.meets_target();
        // A signal may have cut the goal's look short.
        if (interruption.requested())
          {
            interrupt();
            return true;
          }
        // A target of zero stands for none: then only the goal counts.
        return goal_here.is_reached &&
               (growth.meets_target() || accuracy.target == 0.);
      }

      /// Returns the body of the next mesh, and adds its divisions to those of
      /// progress. If there can be none, @p limit says why.
      std::shared_ptr<const BisectedBody<dim>>
      next_body(std::string &limit)
      {
        // A goal may know better than the estimate which cells keep it from
        // being reached.
        const bool by_goal = !goal_here.is_reached && !goal_here.parts.empty();
        double     times   = goal ? growth_for_goal : growth.next();
        progress.divisions.emplace_back();
        // If the mesh would be too large, smaller ones are tried, down to one
        // that is hardly worth the solve. Each try starts from the same cells.
        while (true)
          {
            progress.divisions.back() =
              divisions(by_goal ? goal_here.parts :
                                  of_whole_mesh(*scene, estimate.cells),
                        dim,
                        times);
            std::shared_ptr<const BisectedBody<dim>> body =
              bisected(*scene).refined(progress.divisions.back());
            limit =
              too_large<dim>(problem,
                             accuracy,
                             wanted,
                             goal,
                             memory_left(settings.parameters.memory_limit),
                             *body);
            if (limit.empty() || times <= growth.least())
              return body;
            times = std::max(growth.least(), 0.75 * times);
          }
      }

      void
      say_what_is_missing(const std::string &limit)
      {
        // The goal may reach on the last mesh what it has put off, and is asked
        // before anything is called missing.
        look_at_goal(true);
        if (!result.shortfall.empty())
          return;
        // Goal and target may both be missed, and each is named with the limit
        // that is in its way.
        if (goal && !goal_here.is_reached)
          result.shortfall = goal_here.shortfall + ": " + limit + '.';
        if (!growth.meets_target() && accuracy.target > 0.)
          {
            const double       error = progress.levels.back().estimated_error();
            std::ostringstream text;
            text << (result.shortfall.empty() ? "" : " ")
                 << "The estimated error of " << std::setprecision(2) << error
                 << (error > accuracy.target ?
                       " is above" :
                       " has not been checked by a finer mesh, as it has to be "
                       "for")
                 << " Accuracy/Target = " << accuracy.target << ": " << limit
                 << '.';
            result.shortfall += text.str();
          }
      }

      void
      interrupt()
      {
        result.path.result.status = SolverStatus::interrupted;
        result.path.result.message =
          "The result is that of the last mesh that was finished.";
      }

      const SolveSettings              &settings;
      const AccuracyParameters         &accuracy;
      RefinementGoal<dim> *const        goal; ///< null without one
      const AdaptiveObserver<dim>      &observer;
      std::shared_ptr<const Scene<dim>> scene;

      // These are the same on all meshes.
      const ProblemParameters problem;
      const MPI_Comm          ranks;
      const MethodChoice      wanted; ///< the linear solver may be automatic
      const Interruption     &interruption = Interruption::by_signal();

      AdaptiveResult<dim> result;
      bool                ended = false; ///< by no result, or no estimate
      AdaptiveProgress    progress;
      ErrorEstimate       estimate;
      double              functional     = 0.; ///< that it is relative to
      unsigned int        estimated_step = 0;  ///< of the path
      MeshGrowth          growth;
      GoalOnMesh          goal_here;
      dealii::Timer       timer;
      double              seconds = 0.; ///< before the timer started

      std::shared_ptr<const Body<dim>> latest;
    };
  } // namespace



  template <int dim>
  std::shared_ptr<const Scene<dim>>
  make_first_scene(const ProblemParameters                      &problem,
                   const AccuracyParameters                     &accuracy,
                   const std::string                            &start,
                   const std::vector<std::vector<unsigned int>> &divisions)
  {
    if (!accuracy.is_adaptive())
      return std::make_shared<const Scene<dim>>(problem, start, MPI_COMM_WORLD);
    std::shared_ptr<const BisectedBody<dim>> body;
    try
      {
        // The first mesh becomes one that bisection can refine, which most
        // tetrahedra from files cannot.
        body = std::make_shared<const BisectedBody<dim>>(
          std::dynamic_pointer_cast<const Body<dim>>(problem.body));
        for (const std::vector<unsigned int> &times : divisions)
          {
            // Divisions of an earlier run are replayed cell by cell, so that
            // the mesh and the numbers of its cells are those of that run.
            if (static_cast<double>(times.size()) != body->n_cells())
              throw std::invalid_argument("the mesh is not that of the run "
                                          "before; run without --restart");
            body = body->refined(times);
          }
      }
    catch (const EntryError &)
      {
        // The scene without refinement says which entry that is.
        return std::make_shared<const Scene<dim>>(problem,
                                                  start,
                                                  MPI_COMM_WORLD);
      }
    catch (const std::invalid_argument &error)
      {
        throw BadInput({problem.scene + ": Accuracy: " + error.what()});
      }
    return std::make_shared<const Scene<dim>>(problem,
                                              body,
                                              start,
                                              MPI_COMM_WORLD);
  }



  template <int dim>
  AdaptiveResult<dim>
  solve_adaptively(const SolveSettings              &settings,
                   const AccuracyParameters         &accuracy,
                   RefinementGoal<dim>              *goal,
                   const AdaptiveProgress           &begun,
                   const AdaptiveObserver<dim>      &observer,
                   std::shared_ptr<const Scene<dim>> scene)
  {
    return AdaptiveLoop<dim>(
             settings, accuracy, goal, begun, observer, std::move(scene))
      .run();
  }



  DEBOND_INSTANTIATE(make_first_scene);
  DEBOND_INSTANTIATE(solve_adaptively);
} // namespace Debond
