// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>
#include <deal.II/base/timer.h>

#include <debond/base/interrupt.h>
#include <debond/base/text.h>
#include <debond/contact/boundary_coarsening.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/elasticity/elastic_levels.h>
#include <debond/elasticity/level_problem.h>
#include <debond/elasticity/mesh_transfer.h>
#include <debond/elasticity/multigrid.h>
#include <debond/elasticity/multigrid_problem.h>
#include <debond/elasticity/refinement.h>
#include <debond/input/bad_input.h>
#include <debond/linear_algebra/eigen_view.h>
#include <debond/optimization/bundle/metric_direction.h>
#include <debond/optimization/majorise/coarse_start.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/optimization/majorise/restricted_function.h>
#include <debond/solve/front_search.h>
#include <debond/solve/progress.h>
#include <debond/solve/scene_size.h>
#include <debond/solve/solve.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <sstream>

namespace Debond
{
  namespace
  {
    using Vector = dealii::Vector<double>;



    /// Contact boundaries with more nodes take their start from coarser ones.
    constexpr unsigned int coarsest_contact_nodes = 50;

    /// With fewer unknowns nothing takes more than some seconds.
    constexpr unsigned int fewest_announced = 50000;

    /// On coarser meshes, where the time for a factorisation does not count.
    constexpr double largest_coarse_factorisation = 3e4;

    /// Each lowers J; fronts that are still moving then are left where they
    /// are.
    constexpr unsigned int most_front_rounds = 20;

    /// A level needs to be solved to what the next finer one makes of it.
    constexpr double coarse_level_tolerance = 1e-4;



    /// Prints iterations, if it has a stream, and ends the method on a signal.
    class Watch
    {
    public:
      /// Several ranks all do what the first one decides.
      explicit Watch(const InterruptGuard &guard,
                     const MPI_Comm        ranks = MPI_COMM_NULL)
        : guard(guard)
        , ranks(ranks)
      {}

      Watch(const InterruptGuard &guard,
            std::ostream         &out,
            const bool            terminal,
            const MPI_Comm        ranks)
        : guard(guard)
        , ranks(ranks)
        , progress(std::make_unique<Progress>(out, terminal))
        , log(&out)
      {}

      /// Prints no iterations, but what the other one announces.
      Watch(const InterruptGuard &guard, const Watch &other)
        : guard(guard)
        , log(other.log)
      {}

      /// Says what takes long now, if there are many unknowns.
      void
      announce(const std::string &what, const unsigned int n_unknowns) const
      {
        if (log != nullptr && n_unknowns > fewest_announced)
          *log << "  " << what << ", " << n_unknowns << " unknowns"
               << std::endl;
      }

      ~Watch()
      {
        if (progress)
          progress->finish();
      }

      Watch(const Watch &) = delete;

      /// The difference between J and the functional that the method sees.
      void
      add_energy(const double energy)
      {
        offset = energy;
      }

      template <typename Iteration>
      bool
      operator()(Iteration iteration)
      {
        iteration.functional += offset;
        if (progress)
          progress->report(iteration);
        return may_go_on();
      }

      bool
      may_go_on() const
      {
        const bool is_requested = guard.requested();
        return !(ranks == MPI_COMM_NULL ?
                   is_requested :
                   dealii::Utilities::MPI::broadcast(ranks, is_requested));
      }

    private:
      double                    offset = 0.;
      const InterruptGuard     &guard;
      const MPI_Comm            ranks = MPI_COMM_NULL;
      std::unique_ptr<Progress> progress;
      std::ostream             *log = nullptr;
    };



    void
    add_bundle_result(const ProximalBundleResult &bundle, SolveResult &result)
    {
      result.status                     = bundle.status;
      result.message                    = bundle.message;
      result.iterations                 = bundle.iterations();
      result.long_steps                 = bundle.long_steps;
      result.short_steps                = bundle.short_steps;
      result.null_steps                 = bundle.null_steps;
      result.criterion                  = bundle.v;
      result.largest_qp_residual        = bundle.largest_qp_residual;
      result.bundle_history             = bundle.history;
      result.parts["quadratic program"] = bundle.qp_seconds;
      result.parts["functional"]        = bundle.objective_seconds;
      result.parts["linear algebra"]    = bundle.linear_algebra_seconds;
    }



    /// J(u), from the strains, on the first of several ranks.
    template <int dim>
    double
    functional_of(const Scene<dim> &scene, const Vector &u)
    {
      const ElasticProblem<dim> &problem = scene.problem();
      return (scene.piece() == nullptr ?
                problem.fields().elastic_functional(u) :
                scene.piece()->elastic_functional(
                  problem.fields(), problem.unknowns().dof_handler(), u)) +
             scene.adhesion().energy(eigen_view(scene.contact_trace(u)));
    }



    /// Refinement knows no ranks.
    template <int dim>
    std::string
    note_on_rounding(const Scene<dim> &scene, const Vector &u)
    {
      constexpr double largest_energy_rounding = 1e-9;

      const ProblemPiece<dim> &piece = *scene.piece();
      Vector                   terms = u;
      for (unsigned int i = 0; i < u.size(); ++i)
        terms(i) *= scene.problem().unknowns().is_constrained(i) ?
                      0. :
                      scene.problem().diagonal_entry(i);
      const Vector s = scene.contact_trace(u);
      const double energy =
        piece.nodes().product(scene.problem().load().begin(), u.begin()) -
        scene.adhesion().subgradient(eigen_view(s)).dot(eigen_view(s));
      const double rounding = std::numeric_limits<double>::epsilon() *
                              piece.nodes().product(terms.begin(), u.begin());
      if (rounding <= largest_energy_rounding * energy)
        return "";
      std::ostringstream note;
      note.precision(1);
      note << std::scientific << "in double precision rounding can change "
           << rounding / energy
           << " of the strain energy; only one rank would refine the result in "
              "extended precision.";
      return note.str();
    }



    template <int dim>
    void
    solve_by_euclidean_bundle(const ProximalBundleParameters &parameters,
                              const Scene<dim>               &scene,
                              Checkpoints                    *checkpoints,
                              Watch                          &watch,
                              SolveResult                    &result)
    {
      const double energy =
        prescribed_energy(scene.problem(), scene.adhesion());
      watch.add_energy(energy);
      result.u = scene.start();
      add_bundle_result(
        ProximalBundle<Vector>(parameters)
          .minimize(scene.functional(),
                    scene.problem().unknowns().contact().bounds(),
                    result.u,
                    std::ref(watch),
                    checkpoints),
        result);
      for (BundleIteration &iteration : result.bundle_history)
        iteration.functional += energy;
    }



    template <int dim>
    void
    solve_by_energy_bundle(ProximalBundleParameters bundle,
                           const Scene<dim>        &scene,
                           const Condensation      &condensed,
                           Checkpoints             *checkpoints,
                           Watch                   &watch,
                           Vector                  &s,
                           SolveResult             &result)
    {
      // The condensed functional has the same form on the normals alone.
      const ContactSpace<dim> contact =
        scene.problem().unknowns().contact().condensed();
      const Functional<dim, dealii::FullMatrix<double>, Vector> functional(
        condensed.schur_complement(),
        condensed.load(),
        contact,
        scene.adhesion());

      // Without loads any tolerance will do.
      bundle.epsilon_s =
        std::max(bundle.epsilon_s * condensed.energy_without_contact(),
                 std::numeric_limits<double>::min());
      MetricDirection<Vector> direction(symmetric_view(
                                          condensed.schur_complement()),
                                        scene.adhesion(),
                                        bundle.bundle_size);
      add_bundle_result(ProximalBundle<Vector>(bundle).minimize(functional,
                                                                direction,
                                                                s,
                                                                std::ref(watch),
                                                                checkpoints),
                        result);
      // The functional differs from J by the energy at s = 0.
      for (BundleIteration &iteration : result.bundle_history)
        iteration.functional += condensed.energy_at_zero();
    }



    /// @p energy is what J is more than the functional that the method saw. The
    /// iterations follow those that the result has.
    void
    add_majorise_result(const MajoriseMinimiseResult &minimum,
                        const double                  energy,
                        SolveResult                  &result)
    {
      result.status    = minimum.status;
      result.message   = minimum.message;
      result.criterion = minimum.residual;
      for (MajoriseMinimiseIteration iteration : minimum.history)
        {
          iteration.iteration = ++result.iterations;
          iteration.functional += energy;
          result.linear_iterations += iteration.linear_iterations;
          result.majorise_history.push_back(iteration);
        }
    }



    template <int dim>
    void
    solve_by_majorise_minimise(const MajoriseMinimise &method,
                               const Scene<dim>       &scene,
                               const Condensation     &condensed,
                               const bool              has_start,
                               Watch                  &watch,
                               Vector                 &s,
                               SolveResult            &result)
    {
      // Coarser spaces do not know the gaps of bodies at rest, and what only
      // bonds hold has to start with all of them.
      const ElasticUnknowns<dim> &unknowns = scene.problem().unknowns();
      const bool                  is_loose =
        unknowns.has_gap() || !unknowns.held_by_contact().motions.empty();
      const MatrixView S     = symmetric_view(condensed.schur_complement());
      const VectorView g     = eigen_view(condensed.load());
      Eigen::VectorXd  point = eigen_view(s);
      if (!has_start && is_loose)
        point = eigen_view(unknowns.contact().at_rest());
      else if (!has_start)
        point = coarse_start(S,
                             g,
                             scene.adhesion(),
                             coarsen(unknowns.contact().boundary(),
                                     coarsest_contact_nodes),
                             method,
                             result.notes,
                             [&watch](const MajoriseMinimiseIteration &) {
                               return watch.may_go_on();
                             });
      CondensedProblem problem(S,
                               g,
                               scene.adhesion(),
                               point,
                               free_motions_of_contact(unknowns),
                               stiffness_at_contact(scene.problem()));
      add_majorise_result(method.minimize(problem, std::ref(watch)),
                          condensed.energy_at_zero(),
                          result);
      s = from_eigen(point);
    }



    /// Refines a result if rounding has a say in it. Returns whether it has.
    template <int dim>
    bool
    refine_result(const Scene<dim> &scene,
                  CorrectionSolver &solver,
                  const Watch      &watch,
                  SolveResult      &result)
    {
      if (!can_be_verified(result.status))
        return false;
      if (scene.piece() != nullptr)
        {
          const std::string note = note_on_rounding(scene, result.u);
          if (!note.empty())
            result.notes.push_back(note);
          return !note.empty();
        }
      const dealii::Timer timer;
      const Vector        before =
        scene.problem().unknowns().contact().trace(result.u);
      const std::string note = refine_where_needed(
        scene.problem(),
        scene.adhesion(),
        1.,
        solver,
        [&watch]() { return watch.may_go_on(); },
        result.u);
      if (!note.empty())
        result.notes.push_back(note);
      // The search knows other bonds than the result has.
      const Vector after = scene.problem().unknowns().contact().trace(result.u);
      if (after.size() > 0 && (scene.adhesion().curvature(eigen_view(after)) -
                               scene.adhesion().curvature(eigen_view(before)))
                                  .norm() > 0.)
        result.minimum.kind =
          kind_without_search(scene.law(), scene.adhesion(), after);
      result.parts["refinement"] = timer.wall_time();
      return !note.empty();
    }



    template <int dim>
    void
    solve_condensed(const std::string      &method,
                    const SolverParameters &parameters,
                    const Scene<dim>       &scene,
                    Checkpoints            *checkpoints,
                    const Vector           *start,
                    Watch                  &watch,
                    SolveResult            &result)
    {
      dealii::Timer              timer;
      const ElasticProblem<dim> &problem = scene.problem();
      watch.announce("factorisation", problem.unknowns().n_free_dofs());
      const Condensation condensed =
        condense_to_contact(problem, scene.adhesion());
      const bool is_held = problem.unknowns().held_by_contact().motions.empty();
      result.parts["condensation"] = timer.wall_time();

      if (!std::isfinite(condensed.energy_at_zero()))
        {
          result.status  = SolverStatus::not_finite;
          result.message = "condensation: the energy of the loads is not a "
                           "finite number. Check the data of the scene.";
          result.u.reinit(problem.unknowns().n_dofs());
          return;
        }
      watch.add_energy(condensed.energy_at_zero());
      timer.restart();
      Vector s(problem.unknowns().contact().size());
      if (start != nullptr)
        {
          s = problem.unknowns().contact().trace(*start);
          for (double &opening : s)
            opening = std::min(opening, 0.);
        }
      // If no contact node is free, there is no metric either.
      if (method == SolverMethod::energy_bundle && s.size() > 0)
        solve_by_energy_bundle(parameters.energy_bundle,
                               scene,
                               condensed,
                               checkpoints,
                               watch,
                               s,
                               result);
      else
        solve_by_majorise_minimise(MajoriseMinimise(
                                     parameters.majorise_minimise),
                                   scene,
                                   condensed,
                                   start != nullptr,
                                   watch,
                                   s,
                                   result);
      result.parts["contact"] = timer.wall_time();

      // Where nothing else holds the body J may fall without end.
      if (can_be_verified(result.status) && !is_held)
        result.minimum.kind =
          kind_without_search(scene.law(), scene.adhesion(), s);
      else if (can_be_verified(result.status))
        {
          timer.restart();
          const Vector followed = s;
          result.minimum        = find_better_minimum(
            parameters,
            problem.unknowns().contact().boundary(),
            scene.law(),
            scene.adhesion(),
            condensed,
            [&]() { return watch.may_go_on(); },
            s);
          result.parts["search and proof"] = timer.wall_time();
          if (result.minimum.search_trials > 0 ||
              result.minimum.proof_attempted)
            {
              result.functional_from_start =
                functional_of(scene, condensed.expand(followed));
              result.is_replaced = s != followed;
            }
        }

      timer.restart();
      result.u                  = condensed.expand(s);
      result.parts["expansion"] = timer.wall_time();

      // On small meshes the estimate takes 2 % of the solve.
      CondensedCorrection solver(condensed);
      if (refine_result(scene, solver, watch, result) && is_held)
        result.condition_estimate = condensed.condition_estimate();
    }



    template <int dim>
    void
    solve_by_multigrid(const SolverParameters &parameters,
                       const Scene<dim>       &scene,
                       const InterruptGuard   &guard,
                       Watch                  &watch,
                       SolveResult            &result);



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

      const std::set<std::string> &contact =
        scene.parameters().contact_boundaries;
      const bool factorised = scene_size(*coarse_body, dim, contact).unknowns <=
                              largest_coarse_factorisation;
      const Scene<dim> coarse_scene(scene.parameters(),
                                    std::move(coarse_body),
                                    factorised ? MatrixStorage::serial :
                                                 MatrixStorage::trilinos);
      Watch            watch(guard, fine_watch);
      SolveResult      result;
      if (factorised)
        solve_condensed(SolverMethod::majorise_minimise,
                        coarse,
                        coarse_scene,
                        nullptr,
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



    void
    end_at_start(SolveResult &result)
    {
      result.status  = SolverStatus::interrupted;
      result.message = "multigrid: the start from coarser meshes was "
                       "interrupted, and is the result.";
    }



    /// Majorise-minimise on all unknowns from result.u, which @p problem refers
    /// to. @p energy is that of what is prescribed, which the problem does not
    /// know.
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
      const double energy =
        prescribed_energy(scene.problem(), scene.adhesion());
      watch.add_energy(energy);
      watch.announce("multigrid", scene.problem().unknowns().n_free_dofs());
      const Multigrid multigrid(scene.problem(), held);
      result.parts["multigrid setup"] = timer.wall_time();

      MultigridProblem<dim> problem(scene.problem(),
                                    scene.adhesion(),
                                    multigrid,
                                    result.u,
                                    [&watch]() { return watch.may_go_on(); });
      MultigridCorrection   solver(multigrid, normals);
      minimise_on_all_unknowns(parameters, energy, problem, watch, result);
      refine_result(scene, solver, watch, result);
    }



    void
    keep_admissible(const std::vector<unsigned int> &normals, Vector &u)
    {
      for (const unsigned int normal : normals)
        if (normal != dealii::numbers::invalid_unsigned_int)
          u(normal) = std::min(u(normal), 0.);
    }



    /// Minima on the coarser levels, each the start of the next finer one, from
    /// that of the first coarser mesh that is factorised, on which the search
    /// of the scene is done; @p result gets its counts and notes. Returns that
    /// of the level @p last_level > 0, or the start on the finest one.
    template <int dim>
    Vector
    start_from_levels(const MethodChoice     &choice,
                      const SolverParameters &parameters,
                      const Scene<dim>       &scene,
                      ElasticLevels<dim>     &levels,
                      const unsigned int      last_level,
                      const InterruptGuard   &guard,
                      const Watch            &fine_watch,
                      SolveResult            &result)
    {
      std::shared_ptr<const Body<dim>> body = scene.body().coarser();
      unsigned int                     l    = 1;
      for (;
           body && scene_size(*body, dim, scene.parameters().contact_boundaries)
                       .unknowns > largest_coarse_factorisation;
           ++l)
        body = body->coarser();

      Vector     u;
      const bool is_solved = body != nullptr;
      if (is_solved)
        {
          SolverParameters coarse = parameters;
          coarse.prove            = false;
          const Scene<dim> coarse_scene(scene.parameters(),
                                        body,
                                        MatrixStorage::serial);
          // A piece does not know what holds the whole.
          check_supports_of_method(choice, parameters, coarse_scene);
          Watch       watch(guard, fine_watch);
          SolveResult start;
          solve_condensed(SolverMethod::majorise_minimise,
                          coarse,
                          coarse_scene,
                          nullptr,
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
          // The subspaces are those of what is zero where it is prescribed.
          if (scene.problem().unknowns().has_lifting() ||
              l >= levels.n_levels())
            return interpolate_displacement(coarse_scene.body(),
                                            coarse_scene.problem(),
                                            start.u,
                                            scene.problem());
          u = levels.from_vertex_displacements(
            l,
            body->interpolate(coarse_scene.problem()
                                .unknowns()
                                .dof_handler()
                                .get_triangulation(),
                              vertex_displacements(coarse_scene.problem(),
                                                   start.u),
                              levels.vertices(l)));
          keep_admissible(levels.normals(l), u);
        }
      else
        {
          l = levels.n_levels() - 1;
          u.reinit(levels.n_unknowns(l));
        }

      MajoriseMinimiseParameters coarse_parameters =
        parameters.majorise_minimise;
      coarse_parameters.tolerance =
        std::max(coarse_parameters.tolerance, coarse_level_tolerance);
      const unsigned int solved_level = is_solved ? l : levels.n_levels();
      for (;; --l)
        {
          if (l > 0 && l != solved_level && fine_watch.may_go_on())
            {
              const RestrictedFunction     phi(scene.adhesion(),
                                           levels.trace_prolongation(l));
              LevelProblem<dim>            problem(levels, l, phi, u, [&]() {
                return fine_watch.may_go_on();
              });
              const MajoriseMinimiseResult minimum =
                MajoriseMinimise(coarse_parameters)
                  .minimize(problem, [&](const MajoriseMinimiseIteration &) {
                    return fine_watch.may_go_on();
                  });
              if (!can_be_verified(minimum.status))
                result.notes.push_back("start on " +
                                       std::to_string(levels.n_unknowns(l)) +
                                       " unknowns: " + minimum.message);
            }
          if (l == last_level)
            return u;
          u = levels.prolongate(l, u);
          keep_admissible(levels.normals(l - 1), u);
        }
    }



    /// The same where ranks share the finest level: the root has the others.
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
                                  1,
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
      u = levels.prolongate(1, u);
      keep_admissible(levels.normals(0), u);
      return u;
    }



    /// The search on coarser meshes knows fronts to the size of their elements.
    template <int dim>
    void
    improve_fronts(const SolverParameters &parameters,
                   const Scene<dim>       &scene,
                   const double            energy,
                   MajorantProblem        &problem,
                   Watch                  &watch,
                   SolveResult            &result)
    {
      if (scene.law().curvature(0.) == 0.)
        return;
      const MajoriseMinimise method(parameters.majorise_minimise);
      WhichMinimum          &minimum = result.minimum;
      for (unsigned int round = 1; can_be_verified(result.status); ++round)
        {
          const dealii::Timer     timer;
          const FrontSearchResult search = search_fronts(
            scene, method, [&]() { return watch.may_go_on(); }, result.u);
          result.parts["fronts"] += timer.wall_time();
          minimum.front_windows += search.windows;
          minimum.front_trials += search.trials;
          minimum.search_improvements += search.improvements;
          minimum.search_failures += search.failures;
          minimum.interrupted = !watch.may_go_on();
          const bool is_last  = !search.complete || round == most_front_rounds;
          if (is_last && (!search.complete || search.improvements > 0))
            result.notes.push_back("the search for better fronts of bonds was "
                                   "ended before it had tried all of them");
          if (search.improvements > 0)
            minimise_on_all_unknowns(
              parameters, energy, problem, watch, result);
          if (is_last || search.improvements == 0)
            return;
        }
    }



    /// By the coarser levels of the body, one truncated cycle for each
    /// majorant.
    template <int dim>
    void
    solve_by_levels(const MethodChoice     &choice,
                    const SolverParameters &parameters,
                    const Scene<dim>       &scene,
                    const InterruptGuard   &guard,
                    Watch                  &watch,
                    SolveResult            &result)
    {
      dealii::Timer timer;
      const double  energy =
        prescribed_energy(scene.problem(), scene.adhesion());
      watch.add_energy(energy);
      watch.announce("multigrid", scene.problem().unknowns().n_free_dofs());
      const auto levels =
        scene.piece() == nullptr ?
          ElasticLevels<dim>::make(scene.body(), scene.problem()) :
          ElasticLevels<dim>::make(*scene.piece(), scene.problem());
      result.parts["multigrid setup"] = timer.wall_time();

      timer.restart();
      result.u =
        scene.piece() == nullptr ?
          start_from_levels(
            choice, parameters, scene, *levels, 0, guard, watch, result) :
          start_from_root(
            choice, parameters, scene, *levels, guard, watch, result);
      result.parts["coarser meshes"] = timer.wall_time();
      if (!watch.may_go_on())
        {
          end_at_start(result);
          return;
        }

      LevelProblem<dim>    problem(*levels,
                                0,
                                scene.adhesion(),
                                result.u,
                                [&watch]() { return watch.may_go_on(); });
      LevelCorrection<dim> solver(*levels);
      minimise_on_all_unknowns(parameters, energy, problem, watch, result);
      // Windows are cut out of a whole mesh.
      if (wants_search(parameters) && scene.piece() == nullptr)
        improve_fronts(parameters, scene, energy, problem, watch, result);
      refine_result(scene, solver, watch, result);
    }
  } // namespace



  template <int dim>
  void
  check_supports_of_method(const MethodChoice     &choice,
                           const SolverParameters &parameters,
                           const Scene<dim>       &scene)
  {
    const std::vector<std::string> &motions =
      scene.problem().unknowns().held_by_contact().names;
    if (motions.empty())
      return;
    const ProblemParameters &problem = scene.parameters();
    const auto               refuse  = [&](const std::string &entry,
                            const std::string &wanted) {
      throw BadInput({problem.scene + ": Solver/" + entry +
                      ": only bonds and the foundation hold the body (" +
                      join(motions, ", ") + "), which needs " + wanted});
    };
    if (choice.method != SolverMethod::majorise_minimise)
      refuse("Method", "majorise minimise or automatic");
    if (choice.linear_solver != LinearSolver::direct)
      refuse("Linear solver",
             "the Schur complement of a factorisation: direct");
    if (parameters.prove)
      refuse("Prove",
             "false: J may fall without end, and then there is no global "
             "minimum");
    if (parameters.search == BondSearchChoice::quick ||
        parameters.search == BondSearchChoice::full)
      refuse("Search", "none: J may fall without end");
    if (!problem.load_path.factors.empty() &&
        problem.load_path.global_branch == GlobalBranch::prove)
      throw BadInput({problem.scene +
                      ": Load path/Global branch: only bonds and the "
                      "foundation hold the body (" +
                      join(motions, ", ") +
                      "): J may fall without end, and then there is no "
                      "global minimum"});
  }



  MatrixStorage
  matrix_storage(const MethodChoice &choice)
  {
    return choice.linear_solver == LinearSolver::multigrid &&
               !choice.has_levels ?
             MatrixStorage::trilinos :
             MatrixStorage::serial;
  }



  template <int dim>
  SolveResult
  solve(const MethodChoice     &choice,
        const SolverParameters &parameters,
        const Scene<dim>       &scene,
        std::ostream           *out,
        const bool              terminal,
        Checkpoints            *checkpoints,
        const Vector           *start)
  {
    SolveResult result;
    {
      const InterruptGuard guard;
      const MPI_Comm       ranks = scene.piece() == nullptr ?
                                     MPI_COMM_NULL :
                                     scene.piece()->nodes().communicator();
      const bool           is_logged =
        out != nullptr &&
        (scene.piece() == nullptr ||
         dealii::Utilities::MPI::this_mpi_process(ranks) == 0);
      const auto watch =
        is_logged ? std::make_unique<Watch>(guard, *out, terminal, ranks) :
                    std::make_unique<Watch>(guard, ranks);
      if (choice.method == SolverMethod::euclidean_bundle)
        solve_by_euclidean_bundle(
          parameters.bundle, scene, checkpoints, *watch, result);
      else if (choice.has_levels)
        solve_by_levels(choice, parameters, scene, guard, *watch, result);
      else if (choice.linear_solver == LinearSolver::multigrid)
        solve_by_multigrid(parameters, scene, guard, *watch, result);
      else
        solve_condensed(
          choice.method, parameters, scene, checkpoints, start, *watch, result);
    }
    if (choice.linear_solver != LinearSolver::direct)
      result.minimum.kind = kind_without_search(scene.law(),
                                                scene.adhesion(),
                                                scene.contact_trace(result.u));
    result.functional = result.status == SolverStatus::comes_off ?
                          std::numeric_limits<double>::quiet_NaN() :
                          functional_of(scene, result.u);
    return result;
  }



  template void
  check_supports_of_method(const MethodChoice &,
                           const SolverParameters &,
                           const Scene<2> &);
  template void
  check_supports_of_method(const MethodChoice &,
                           const SolverParameters &,
                           const Scene<3> &);



  template SolveResult
  solve(const MethodChoice &,
        const SolverParameters &,
        const Scene<2> &,
        std::ostream *,
        const bool,
        Checkpoints *,
        const Vector *);
  template SolveResult
  solve(const MethodChoice &,
        const SolverParameters &,
        const Scene<3> &,
        std::ostream *,
        const bool,
        Checkpoints *,
        const Vector *);
} // namespace Debond
