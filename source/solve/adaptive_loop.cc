// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/interrupt.h>
#include <debond/base/memory.h>
#include <debond/elasticity/mesh_transfer.h>
#include <debond/input/bad_input.h>
#include <debond/mesh/bisected_body.h>
#include <debond/mesh/owned_cells.h>
#include <debond/solve/adaptive_loop.h>
#include <debond/solve/load_path.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <queue>
#include <sstream>

namespace Debond
{
  namespace
  {
    /// The next mesh has at most, and unless it would be too large at least, so
    /// many times the cells, without those that have to be cut for others. The
    /// error of a mesh with so many cells does not depend on how many meshes
    /// led to it with linear displacements; with quadratic ones it does
    /// (doc/notes/speed.md).
    constexpr double
    largest_growth(const unsigned int degree)
    {
      return degree == 1 ? 4. : 1.4;
    }

    constexpr double
    least_growth(const unsigned int degree)
    {
      return degree == 1 ? 1.25 : 1.1;
    }

    /// The same if a goal besides the estimate has not been reached.
    constexpr double growth_for_goal = 1.7;

    /// The part of Accuracy/Target that a mesh is made for.
    constexpr double aim = 0.9;

    /// Cells that are cut for others.
    constexpr double closure = 1.1;



    /// How the estimate falls from mesh to mesh.
    class MeshGrowth
    {
    public:
      MeshGrowth(const AccuracyParameters &accuracy,
                 const unsigned int        dim,
                 const unsigned int        degree)
        : accuracy(accuracy)
        , least(least_growth(degree))
        , largest(largest_growth(degree))
        , smooth_rate(2. * degree / dim)
        , rate(smooth_rate)
      {}

      /// A mesh has been estimated.
      void
      add(const double n_unknowns, const double relative_error)
      {
        if (unknowns > 0. && error > 0. && relative_error > 0.)
          rate = std::clamp(std::log(error / relative_error) /
                              std::log(n_unknowns / unknowns),
                            0.5 * smooth_rate,
                            1.5 * smooth_rate);
        unknowns = n_unknowns;
        error    = relative_error;
      }

      /// That of the next mesh: equal steps to the mesh that meets the target,
      /// or to the largest one that is allowed.
      double
      next() const
      {
        double whole = std::numeric_limits<double>::infinity();
        if (accuracy.target > 0.)
          whole = std::pow(error / (aim * accuracy.target), 1. / rate);
        if (accuracy.maximum_unknowns > 0)
          whole =
            std::min(whole, accuracy.maximum_unknowns / (closure * unknowns));
        if (!std::isfinite(whole))
          return largest;
        const double steps =
          std::max(1., std::ceil(std::log(whole) / std::log(largest)));
        return std::max(least, std::pow(whole, 1. / steps));
      }

    private:
      const AccuracyParameters &accuracy;
      const double              least;
      const double              largest;
      const double              smooth_rate;
      double                    rate; ///< error ~ unknowns^-rate
      double                    unknowns = 0.;
      double                    error    = 0.;
    };



    /// How often each cell is to be cut. The cell with the largest part of the
    /// estimate is next until there are enough; where the solution is smooth, a
    /// half has 2^(-(2 + dim) / dim) of its part, and at corners more: with
    /// less for quadratic displacements those are cut too little where a mesh
    /// may grow but once.
    std::vector<unsigned int>
    divisions(const std::vector<double> &parts,
              const unsigned int         dim,
              const double               growth)
    {
      struct Piece
      {
        double       part;
        unsigned int cell;

        bool
        operator<(const Piece &other) const
        {
          return part != other.part ? part < other.part : cell > other.cell;
        }
      };
      std::priority_queue<Piece> pieces;
      for (unsigned int cell = 0; cell < parts.size(); ++cell)
        pieces.push({parts[cell], cell});

      const double              of_a_half = std::pow(2., -(2. + dim) / dim);
      std::vector<unsigned int> times(parts.size(), 0);
      double                    n    = static_cast<double>(parts.size());
      const double              goal = growth * n;
      while (n < goal && pieces.top().part > 0.)
        {
          const Piece largest = pieces.top();
          pieces.pop();
          n += std::ldexp(1., static_cast<int>(times[largest.cell]++));
          pieces.push({largest.part * of_a_half, largest.cell});
        }
      return times;
    }



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



    /// Of numbers for the cells that a rank has those of all cells, by their
    /// places in the whole mesh.
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
    ErrorEstimate
    estimate_of(const Scene<dim>            &scene,
                const AdhesionIntegral<dim> &bonds,
                const DofVector             &u,
                const double                 functional,
                const LoadFactors            factors)
    {
      return estimate_error<dim>({scene.problem(),
                                  bonds,
                                  scene.conditions(),
                                  scene.supports(),
                                  scene.loads(),
                                  &scene.dead_loads()},
                                 u,
                                 functional,
                                 factors);
    }



    template <int dim>
    class AdaptiveLoop
    {
    public:
      using Report = std::function<void(const AdaptiveLevel &)>;

      AdaptiveLoop(const SolveSettings               &settings,
                   const AccuracyParameters          &accuracy,
                   RefinementGoal<dim>               *goal,
                   const Report                      &report,
                   std::shared_ptr<const Scene<dim>> &scene)
        : settings(settings)
        , accuracy(accuracy)
        , goal(goal)
        , report(report)
        , scene(scene)
        , problem(scene->parameters())
        , ranks(scene->ranks())
        , wanted(choose_method(problem, settings.parameters))
        , growth(accuracy, dim, problem.degree)
      {}

      AdaptiveResult<dim>
      run()
      {
        seconds = scene->mesh_seconds() + scene->assembly_seconds();
        solve_on(scene, without_proof(settings.choice));
        while (!is_finished())
          {
            timer.restart();
            seconds = 0.;
            std::string                                    limit;
            const std::shared_ptr<const BisectedBody<dim>> body =
              next_body(limit);
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
                choose_linear_solver(*next,
                                     settings.parameters,
                                     on_next.choice);
              }
            catch (const BadInput &error)
              {
                say_what_is_missing(error.what());
                break;
              }
            if (guard.requested())
              {
                interrupt();
                break;
              }
            start = std::make_unique<const DofVector>(
              divided_displacement(scene->problem(),
                                   result.solve.u,
                                   body->ancestors(),
                                   next->problem()));
            // Its memory is for the next mesh; the state of a path knows it.
            const std::shared_ptr<const Body<dim>> finished = latest;
            latest                                          = body;
            if (finished && result.path.steps.empty())
              scene.reset();
            if (!solve_on(next, on_next))
              {
                if (!scene)
                  scene = std::make_shared<const Scene<dim>>(problem,
                                                             finished,
                                                             "",
                                                             ranks);
                break;
              }
          }
        if (settings.parameters.prove &&
            result.solve.status == SolverStatus::success)
          result.solve = solve(choice,
                               settings.parameters,
                               *scene,
                               nullptr,
                               false,
                               &result.solve.u);
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

      /// Whether there is a result on this mesh that a finer one may replace,
      /// or the last word; if a signal came before, that of the mesh before
      /// stays.
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
                solution   = solve(on_mesh.choice,
                                 on_mesh.parameters,
                                 *here,
                                 nullptr,
                                 false,
                                 start.get());
                functional = solution.functional;
                if (can_be_verified(solution.status) &&
                    !solution.minimum.interrupted)
                  estimate = estimate_of(*here,
                                         here->adhesion(),
                                         solution.u,
                                         solution.functional,
                                         1.);
              }
            else
              {
                path     = follow(*here, on_mesh);
                solution = std::move(path.result);
              }
          }
        catch (const std::invalid_argument &error)
          {
            result.shortfall =
              std::string("The error of the mesh is not known, ") +
              error.what() + '.';
          }
        const bool is_first = !start;
        if (!is_first && solution.status == SolverStatus::interrupted)
          {
            interrupt();
            return false;
          }
        result.solve = std::move(solution);
        result.path  = std::move(path);
        scene        = here;
        choice       = on_mesh.choice;
        // Where the body comes off on the way, the factors before that count.
        const bool comes_off_later =
          result.solve.status == SolverStatus::comes_off &&
          !result.path.steps.empty();
        const bool is_usable =
          (can_be_verified(result.solve.status) || comes_off_later) &&
          !result.solve.minimum.interrupted;
        if (is_usable && result.shortfall.empty())
          look_at_goal(false);
        ended = !is_usable || !result.shortfall.empty();
        if (!ended)
          {
            const ElasticUnknowns<dim> &unknowns = scene->problem().unknowns();
            report({scene->n_cells(),
                    unknowns.n_free_dofs(),
                    unknowns.contact().size(),
                    result.solve.iterations,
                    functional,
                    estimate.relative(),
                    goal_here.width,
                    seconds + timer.wall_time()});
            growth.add(unknowns.n_free_dofs(), estimate.relative());
          }
        return true;
      }

      /// The states that the load path leads to, with the estimate of the one
      /// that has the largest error relative to its J.
      FollowedPath<dim>
      follow(const Scene<dim> &here, const SolveSettings &on_mesh)
      {
        LoadPathParameters followed = problem.load_path;
        followed.global_branch      = GlobalBranch::none;
        followed.arc                = false;
        return follow_load_path<dim>(
          followed,
          on_mesh,
          here,
          {},
          [&](const PathProgress<dim> &progress,
              const Verification<dim> &,
              const AdhesionIntegral<dim> &bonds) {
            const LoadPathStep<dim> &step = progress.steps.back();
            ErrorEstimate            own  = estimate_of(
              here, bonds, progress.u, step.state.functional, step.factors());
            if (estimate.cells.empty() || own.relative() > estimate.relative())
              {
                estimate   = std::move(own);
                functional = step.state.functional;
              }
          },
          nullptr);
      }

      void
      look_at_goal(const bool is_last)
      {
        if (goal == nullptr)
          return;
        goal_here        = goal->look(scene, result.solve, is_last);
        result.shortfall = goal_here.failure;
      }

      bool
      is_accurate() const
      {
        return estimate.relative() <= accuracy.target;
      }

      bool
      is_finished()
      {
        if (ended)
          return true;
        if (goal == nullptr)
          return is_accurate();
        // Its look may have been cut short.
        if (guard.requested())
          {
            interrupt();
            return true;
          }
        return goal_here.is_reached && (is_accurate() || accuracy.target == 0.);
      }

      /// @p limit becomes why there can be none.
      std::shared_ptr<const BisectedBody<dim>>
      next_body(std::string &limit)
      {
        const bool by_goal = !goal_here.is_reached && !goal_here.parts.empty();
        double     times   = goal ? growth_for_goal : growth.next();
        while (true)
          {
            std::shared_ptr<const BisectedBody<dim>> body =
              bisected(*scene).refined(
                divisions(by_goal ? goal_here.parts :
                                    of_whole_mesh(*scene, estimate.cells),
                          dim,
                          times));
            limit =
              too_large<dim>(problem,
                             accuracy,
                             wanted,
                             goal,
                             memory_left(settings.parameters.memory_limit),
                             *body);
            if (limit.empty() || times <= least_growth(problem.degree))
              return body;
            times = std::max(least_growth(problem.degree), 0.75 * times);
          }
      }

      void
      say_what_is_missing(const std::string &limit)
      {
        look_at_goal(true);
        if (!result.shortfall.empty())
          return;
        if (goal && !goal_here.is_reached)
          result.shortfall = goal_here.shortfall + ": " + limit + '.';
        if (!is_accurate() && accuracy.target > 0.)
          {
            std::ostringstream text;
            text << (result.shortfall.empty() ? "" : " ")
                 << "The estimated error of " << std::setprecision(2)
                 << estimate.relative()
                 << " is above Accuracy/Target = " << accuracy.target << ": "
                 << limit << '.';
            result.shortfall += text.str();
          }
      }

      void
      interrupt()
      {
        result.solve.status = SolverStatus::interrupted;
        result.solve.message =
          "The result is that of the last mesh that was finished.";
      }

      const SolveSettings               &settings;
      const AccuracyParameters          &accuracy;
      RefinementGoal<dim> *const         goal; ///< null without one
      const Report                      &report;
      std::shared_ptr<const Scene<dim>> &scene;

      // Of all meshes.
      const ProblemParameters problem;
      const MPI_Comm          ranks;
      const MethodChoice      wanted; ///< the linear solver may be automatic
      const InterruptGuard    guard;

      AdaptiveResult<dim> result;
      bool                ended = false; ///< by no result, or no estimate
      ErrorEstimate       estimate;
      double              functional = 0.; ///< that it is relative to
      MeshGrowth          growth;
      GoalOnMesh          goal_here;
      dealii::Timer       timer;
      double              seconds = 0.; ///< before the timer started

      MethodChoice                     choice; ///< on the mesh of the result
      std::shared_ptr<const Body<dim>> latest;
      std::unique_ptr<const DofVector> start; ///< on the next mesh
    };
  } // namespace



  template <int dim>
  std::shared_ptr<const Scene<dim>>
  make_first_scene(const ProblemParameters  &problem,
                   const AccuracyParameters &accuracy,
                   const std::string        &start)
  {
    if (!accuracy.is_adaptive())
      return std::make_shared<const Scene<dim>>(problem, start, MPI_COMM_WORLD);
    std::shared_ptr<const Body<dim>> body;
    try
      {
        body = std::make_shared<const BisectedBody<dim>>(
          std::dynamic_pointer_cast<const Body<dim>>(problem.body));
      }
    catch (const PartError &)
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
  solve_adaptively(const SolveSettings                              &settings,
                   const AccuracyParameters                         &accuracy,
                   RefinementGoal<dim>                              *goal,
                   const std::function<void(const AdaptiveLevel &)> &report,
                   std::shared_ptr<const Scene<dim>>                &scene)
  {
    return AdaptiveLoop<dim>(settings, accuracy, goal, report, scene).run();
  }



  template decltype(make_first_scene<2>) make_first_scene<2>;
  template decltype(make_first_scene<3>) make_first_scene<3>;
  template decltype(solve_adaptively<2>) solve_adaptively<2>;
  template decltype(solve_adaptively<3>) solve_adaptively<3>;
} // namespace Debond
