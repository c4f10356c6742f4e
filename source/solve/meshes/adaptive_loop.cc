// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/instantiate.h>
#include <debond/base/memory.h>
#include <debond/elasticity/mesh_transfer.h>
#include <debond/input/bad_input.h>
#include <debond/mesh/bisected_body.h>
#include <debond/mesh/owned_cells.h>
#include <debond/solve/meshes/adaptive_loop.h>
#include <debond/solve/minimum/solve.h>

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
              const LinearSolver         wanted,
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
      // Each rank enters the numbers of its own cells, all others being zero,
      // so that the sum over the ranks is the list of the whole mesh on each of
      // them.
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
      AdaptiveLoop(const SolveSettings         &settings,
                   const AccuracyParameters    &accuracy,
                   RefinementGoal<dim>         *goal,
                   const AdaptiveObserver<dim> &observer,
                   Answer<dim>                  begun)
        : settings(settings)
        , of_mesh(without_proof(settings.parameters))
        , accuracy(accuracy)
        , goal(goal)
        , observer(observer)
        , problem(begun.scene->parameters())
        , ranks(begun.scene->ranks())
        , answer(std::move(begun))
        , growth(accuracy, dim, problem.degree)
      {
        // The meshes of an interrupted run count as this one's: the observer
        // sees all of them, and the factor of the error is measured with them.
        for (unsigned int k = 0; k < meshes.levels.size(); ++k)
          {
            observer.level_is_done(k, meshes.levels[k]);
            growth.add(meshes.levels[k]);
          }
      }

      Answer<dim>
      run()
      {
        // Each pass of the loop takes one mesh further: cells are divided where
        // the estimate is large, the scene is evaluated anew, and the state of
        // the mesh before is the start.
        seconds =
          answer.scene->mesh_seconds() + answer.scene->assembly_seconds();
        solve_on(answer);
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
            Answer<dim> next;
            next.scene =
              std::make_shared<const Scene<dim>>(problem, body, "", ranks);
            next.choice = answer.choice;
            try
              {
                // The choice depends on the size, so that a sequence may begin
                // with a factorisation and end with multigrid. What does not
                // fit ends the sequence, not the run: the result of the mesh
                // before stays.
                choose_linear_solver(*next.scene,
                                     settings.parameters,
                                     next.choice);
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
            meshes.start = divided_displacement(answer.scene->problem(),
                                                answer.solution.u,
                                                body->ancestors(),
                                                next.scene->problem());
            next.meshes  = meshes;
            observer.next_mesh_is_made(next);
            const std::shared_ptr<const Body<dim>> finished = latest;
            latest                                          = body;
            // Mesh and matrix of the old scene would lie beside the new
            // factorisation at the peak of the memory. The state of a path
            // refers to its scene, which then has to stay.
            if (finished && answer.path.steps.empty())
              answer.scene.reset();
            if (!solve_on(std::move(next)))
              {
                // A signal has ended the work on the new mesh; the files are
                // written for the old one, which has to be made again.
                if (!answer.scene)
                  answer.scene = std::make_shared<const Scene<dim>>(problem,
                                                                    finished,
                                                                    "",
                                                                    ranks);
                break;
              }
          }
        // The proof is about one mesh, so it waits for the last one and starts
        // from its result.
        if (settings.parameters.prove &&
            answer.solution.status == SolverStatus::success)
          answer.solution = solve(answer.choice,
                                  settings.parameters,
                                  *answer.scene,
                                  {},
                                  &answer.solution.u);
        // From here on a restart stays on this mesh.
        meshes.is_last = true;
        return std::move(answer);
      }

    private:
      /// Only the last mesh has a proof.
      static SolverParameters
      without_proof(SolverParameters parameters)
      {
        parameters.prove = false;
        return parameters;
      }

      /// Solves on the mesh of @p begun. Returns whether there is a result on
      /// it, which a finer one may replace, or which is the last word; if a
      /// signal came before, the result of the mesh before stays.
      bool
      solve_on(Answer<dim> begun)
      {
        // The largest force, global branch and arc belong to the last mesh
        // alone.
        estimate          = {};
        Answer<dim> found = std::move(begun);
        try
          {
            found = solve_on_mesh<dim>(
              problem.load_path,
              {of_mesh, settings.tolerance},
              found,
              [this](const Answer<dim>       &state,
                     const Verification<dim> &verification) {
                observer.step_is_done(state, verification);
                estimate_step(state);
              },
              {},
              /*only_steps=*/true);
            if (problem.load_path.factors.empty())
              estimate_minimum(found);
          }
        // The data of the scene are evaluated at points that the solve does not
        // ask for, and may be wrong there. The result is none the worse, but
        // there is nothing to refine by.
        catch (const std::invalid_argument &error)
          {
            found.meshes.shortfall =
              std::string("The error of the mesh is not known, ") +
              error.what() + '.';
          }
        // Half a solve on a finer mesh is worth less than a finished one on a
        // coarser mesh.
        const bool has_result = answer.solution.u.size() > 0;
        if (has_result && found.solution.status == SolverStatus::interrupted)
          {
            interrupt();
            return false;
          }
        // From here on the result is that of this mesh, whatever it is worth;
        // only a signal leaves that of the mesh before in its place.
        answer = std::move(found);
        // If the body detaches on the way, the factors before that count.
        const Solution &solution = answer.solution;
        const bool      comes_off_later =
          solution.status == SolverStatus::comes_off &&
          !answer.path.steps.empty();
        const bool is_usable =
          (can_be_verified(solution.status) || comes_off_later) &&
          !solution.minimum.interrupted;
        if (is_usable && meshes.shortfall.empty())
          look_at_goal(false);
        ended = !is_usable || !meshes.shortfall.empty();
        if (!ended)
          add_level();
        return true;
      }

      /// An estimate of what is no equilibrium would measure the residual of
      /// the solver and not the error of the mesh.
      void
      estimate_minimum(const Answer<dim> &found)
      {
        const Solution &solution = found.solution;
        functional               = solution.functional;
        if (can_be_verified(solution.status) && !solution.minimum.interrupted)
          estimate = estimate_error(found.scene->estimated(found.bonds()),
                                    solution.u,
                                    solution.functional);
      }

      /// Of a load path the estimate is that of the state that has the largest
      /// error relative to its J.
      void
      estimate_step(const Answer<dim> &state)
      {
        const LoadPathStep<dim> &step = state.path.steps.back();
        ErrorEstimate            of_step =
          estimate_error(state.scene->estimated(state.bonds()),
                         state.path.u,
                         step.state.functional,
                         step.factors());
        // Rounding does not choose between steps that are as good.
        if (!estimate.cells.empty() &&
            of_step.relative() <=
              (1. + Tolerance::decimals) * estimate.relative())
          return;
        estimate       = std::move(of_step);
        functional     = step.state.functional;
        estimated_step = step.step;
      }

      /// Lists the mesh, for later ones that are compared with it.
      void
      add_level()
      {
        const ElasticUnknowns<dim> &unknowns =
          answer.scene->problem().unknowns();
        // What a search has lowered J by on this mesh is no gain of
        // refinement, and is left out of the measured factor.
        const double search_gain =
          answer.solution.functional_from_start.value_or(functional) -
          functional;
        // What later meshes are compared with, and what log and summary say
        // of this one. add() sets its error_factor.
        AdaptiveLevel level = {answer.scene->n_cells(),
                               unknowns.n_free_dofs(),
                               static_cast<unsigned int>(
                                 answer.scene->contact_boundary().nodes.size()),
                               answer.solution.iterations,
                               estimated_step,
                               functional,
                               estimate.relative(),
                               estimate.scale,
                               search_gain,
                               {},
                               goal_here.width,
                               seconds + timer.wall_time()};
        growth.add(level);
        observer.level_is_done(static_cast<unsigned int>(meshes.levels.size()),
                               level);
        meshes.levels.push_back(level);
      }

      void
      look_at_goal(const bool is_last)
      {
        if (goal == nullptr)
          return;
        // A goal that cannot be looked at on this mesh ends the refinement with
        // its reason.
        goal_here        = goal->look(answer.scene, answer.solution, is_last);
        meshes.shortfall = goal_here.failure;
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
        meshes.divisions.emplace_back();
        // If the mesh would be too large, smaller ones are tried, down to one
        // that is hardly worth the solve. Each try starts from the same cells.
        while (true)
          {
            meshes.divisions.back() =
              divisions(by_goal ? goal_here.parts :
                                  of_whole_mesh(*answer.scene, estimate.cells),
                        dim,
                        times);
            std::shared_ptr<const BisectedBody<dim>> body =
              bisected(*answer.scene).refined(meshes.divisions.back());
            limit =
              too_large<dim>(problem,
                             accuracy,
                             of_mesh.linear_solver,
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
        if (!meshes.shortfall.empty())
          return;
        // Goal and target may both be missed, and each is named with the limit
        // that is in its way.
        if (goal && !goal_here.is_reached)
          meshes.shortfall = goal_here.shortfall + ": " + limit + '.';
        if (!growth.meets_target() && accuracy.target > 0.)
          {
            const double       error = meshes.levels.back().estimated_error();
            std::ostringstream text;
            text << (meshes.shortfall.empty() ? "" : " ")
                 << "The estimated error of " << std::setprecision(2) << error
                 << (error > accuracy.target ?
                       " is above" :
                       " has not been checked by a finer mesh, as it has to be "
                       "for")
                 << " Accuracy/Target = " << accuracy.target << ": " << limit
                 << '.';
            meshes.shortfall += text.str();
          }
      }

      void
      interrupt()
      {
        answer.solution.status = SolverStatus::interrupted;
        answer.solution.message =
          "The result is that of the last mesh that was finished.";
      }

      const SolveSettings         &settings;
      const SolverParameters       of_mesh;
      const AccuracyParameters    &accuracy;
      RefinementGoal<dim> *const   goal; ///< null without one
      const AdaptiveObserver<dim> &observer;

      // These are the same on all meshes.
      const ProblemParameters problem;
      const MPI_Comm          ranks;
      const Interruption     &interruption = Interruption::by_signal();

      /// The last mesh on which there is a result; before the first solve what
      /// there is to begin with.
      Answer<dim>   answer;
      MeshProgress &meshes = answer.meshes;
      bool          ended  = false; ///< by no result, or no estimate
      ErrorEstimate estimate;
      double        functional     = 0.; ///< that it is relative to
      unsigned int  estimated_step = 0;  ///< of the path
      MeshGrowth    growth;
      GoalOnMesh    goal_here;
      dealii::Timer timer;
      double        seconds = 0.; ///< before the timer started

      std::shared_ptr<const Body<dim>> latest;
    };
  } // namespace



  template <int dim>
  Answer<dim>
  solve_adaptively(const SolveSettings         &settings,
                   const AccuracyParameters    &accuracy,
                   RefinementGoal<dim>         *goal,
                   const AdaptiveObserver<dim> &observer,
                   Answer<dim>                  begun)
  {
    return AdaptiveLoop<dim>(
             settings, accuracy, goal, observer, std::move(begun))
      .run();
  }



  DEBOND_INSTANTIATE(solve_adaptively);
} // namespace Debond
