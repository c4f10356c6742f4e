// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/instantiate.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/solve/minimum/contact_solver.h>
#include <debond/solve/minimum/refinement.h>
#include <debond/solve/minimum/solve.h>
#include <debond/solve/path/bond_change.h>
#include <debond/solve/path/global_branch.h>
#include <debond/solve/path/load_path.h>
#include <debond/solve/path/load_path_arc.h>

#include <numeric>
#include <set>

namespace Debond
{
  namespace
  {
    /// How often a step is done with new modes of its bonds.
    constexpr unsigned int most_modes = 10;

    /// What a step takes beside the minimisation, mostly for its verification:
    /// at least, and for each unknown, in the time of a factorisation's
    /// operations.
    constexpr double least_of_step = 1e7, of_step = 4000.;

    /// A step is halved so often at most for the largest force.
    constexpr unsigned int most_halvings = 16;

    /// The part of a step that tells the stiffness at its beginning.
    constexpr double part_for_stiffness = 1e-3;



    /// The table of a path in the log: the factors that vary, J, a number and
    /// the state.
    template <int dim>
    class PathTable
    {
    public:
      PathTable(const LoadPathParameters &parameters, std::ostream *const out)
        : parameters(parameters)
        , out(out)
      {}

      void
      titles(const std::string &number) const
      {
        if (out == nullptr)
          return;
        factors<const char *>("factor", "displacement factor");
        *out << std::setw(17) << "J" << std::setw(14) << number << "  state"
             << std::endl;
      }

      void
      row(const LoadFactors &of_row,
          const double       functional,
          const double       number,
          const std::string &word) const
      {
        if (out == nullptr)
          return;
        factors(of_row.loads, of_row.displacements);
        *out << std::scientific << std::setprecision(8) << std::setw(17)
             << functional << std::defaultfloat << std::setprecision(3)
             << std::setw(14) << number << std::setprecision(6) << "  " << word
             << std::endl;
      }

      void
      row(const LoadPathStep<dim> &step) const
      {
        row(step.factors(),
            step.state.functional,
            step.state.broken_part,
            step.state.minimum.empty() ? step.status : step.state.minimum);
      }

      /// A row without numbers.
      void
      row(const LoadFactors &of_row, const std::string &word) const
      {
        if (out == nullptr)
          return;
        factors(of_row.loads, of_row.displacements);
        *out << std::setw(17) << "" << std::setw(14) << ""
             << "  " << word << std::endl;
      }

      void
      section(const std::string &name) const
      {
        if (out != nullptr)
          *out << "  " << name << '\n';
      }

    private:
      /// Those that vary, or their titles.
      template <typename Entry>
      void
      factors(const Entry &of_loads, const Entry &of_displacements) const
      {
        if (!parameters.moves_only())
          *out << std::setw(11) << of_loads;
        if (!parameters.displacement_factors.empty())
          *out << std::setw(21) << of_displacements;
      }

      const LoadPathParameters &parameters;
      std::ostream *const       out;
    };



    template <int dim>
    class PathFollower
    {
    public:
      PathFollower(const LoadPathParameters &parameters,
                   const SolveSettings      &settings,
                   Answer<dim>               begun,
                   std::ostream             *out)
        : answer(std::move(begun))
        , parameters(parameters)
        , settings(settings)
        , scene(*answer.scene)
        , table(parameters, out)
        , inside_of_step(parameters)
      {
        inside_of_step.resolve = 0.;
        if (!steps.empty())
          return;
        // A path remembers from step to step the displacement, from which the
        // next minimisation starts; the bonds' memory, what each has reached;
        // and s of all steps, from which the global branch starts. To begin
        // with the body is at rest, and over a gap bonds may be stretched
        // beyond what they return from by that alone.
        const ElasticUnknowns<dim> &unknowns = scene.problem().unknowns();
        progress.u.reinit(unknowns.n_dofs());
        unknowns.contact().add(last_point(), progress.u);
        if (unknowns.has_gap() && !parameters.bonds_heal)
          {
            AdhesionIntegral<dim> at_rest = bonds_before();
            at_rest.break_for_good(last_point());
            progress.memory = at_rest.memory();
          }
      }

      /// Its members refer to each other.
      PathFollower(const PathFollower &) = delete;

      void
      follow(const LoadPathObserver<dim> &observer)
      {
        // The steps of an earlier run are told again and continued. A step that
        // has failed, or that is not verified, has a message, and ends the
        // path, since later ones would start from it.
        const bool is_repeated = steps.size() == parameters.factors.size();
        table.titles("broken part");
        for (const LoadPathStep<dim> &step : steps)
          table.row(step);
        if (!steps.empty())
          repeat_last_step(observer);
        if (steps.size() < parameters.factors.size())
          make_solver();
        const dealii::Timer timer;
        if (steps.size() == 1 && progress.stiffness == 0. && seeks_peak())
          probe_stiffness();
        while (steps.size() < parameters.factors.size() &&
               (steps.empty() || steps.back().message.empty()))
          {
            if (!steps.empty() && interruption.requested())
              {
                interrupt("the path is not complete");
                break;
              }
            if (!solve(parameters.at(static_cast<unsigned int>(steps.size())),
                       observer))
              break;
            table.row(steps.back());
          }
        result.parts["followed path"] += timer.wall_time();
        // What bonds take may depend on the mode in which they break. If it
        // changes within steps, by more than a part of the energy taken on the
        // whole path, the steps are too large for it.
        const BondMemory &memory = progress.memory;
        const double      taken =
          std::accumulate(memory.taken.begin(), memory.taken.end(), 0.);
        if (memory.lag > Tolerance::lag_of_mode * taken && !is_repeated)
          result.notes.push_back(words(
            "the mode of bonds changes within the steps in which they break, "
            "which moves what they take by up to ",
            std::round(1000. * memory.lag / taken) / 10.,
            " per cent of it: take smaller steps there"));
      }

      /// Whether there are steps and the last one is verified. The path may be
      /// shorter than the scene's: a signal, or a body that detaches, leaves no
      /// step.
      bool
      has_no_failure() const
      {
        return !steps.empty() && steps.back().message.empty();
      }

      /// If only bonds hold the body J may fall without end.
      bool
      has_global_branch() const
      {
        return (solver ? solver->condensed() != nullptr :
                         answer.choice.is_condensed) &&
               parameters.bonds_heal &&
               scene.problem().unknowns().is_held_by_supports();
      }

      /// Of a path without failures, condensed.
      void
      find_global_branch()
      {
        if (interruption.requested())
          {
            if (result.status == SolverStatus::success)
              interrupt("there is no global branch");
            return;
          }
        const Stage               stage("global branch");
        const CondensedScene<dim> condensed_scene = condensed();
        const dealii::Timer       timer;
        // The followed states are where the branch starts from. A path may come
        // to a factor several times, when it unloads, and then the lowest of
        // its states is taken.
        Branch followed;
        for (unsigned int k = 0; k < steps.size(); ++k)
          {
            const LoadFactors factors = steps[k].factors();
            const BranchPoint point   = {
                points[k],
                condensed_functional(
                condensed_problem(condensed_scene.at(factors),
                                  condensed_scene.bonds(factors)),
                points[k]),
                {}};
            const auto [entry, is_new] = followed.emplace(factors, point);
            if (!is_new && point.functional < entry->second.functional)
              entry->second = point;
          }

        table.section("global branch");
        const bool proves = parameters.global_branch == GlobalBranch::prove;
        table.titles(proves ? "gap" : "states tried");
        // A search that was not asked for takes no longer than the path. Its
        // work is counted in operations, so that its result does not depend on
        // the machine.
        SolverParameters limited = settings.parameters;
        if (parameters.global_branch == GlobalBranch::automatic)
          limited.search_operations = operations_of_path();
        const Branch branch = global_branch(
          parameters.global_branch,
          limited,
          condensed_scene,
          followed,
          interruption,
          [&](const LoadFactors factors, const BranchPoint &point) {
            table.row(
              factors,
              point.functional + condensed_scene.at(factors).energy_at_zero(),
              proves ?
                std::stod(scientific_above(point.which.relative_gap, 2)) :
                point.which.search_trials,
              to_string(point.which.kind));
          });
        // What limits of work have left undone is said once for all factors,
        // and what else a search or a proof notes once as well.
        unsigned int          n_cut = 0;
        std::set<std::string> others;
        for (const auto &[factors, point] : branch)
          if (point.which.is_cut)
            ++n_cut;
          else
            others.insert(point.which.notes.begin(), point.which.notes.end());
        result.notes.insert(result.notes.end(), others.begin(), others.end());
        if (n_cut > 0)
          table.section(words("the search had as much work as the path takes, "
                              "which was not enough at ",
                              n_cut,
                              " of ",
                              branch.size(),
                              " factors; Load path/Global branch = search has "
                              "no limit"));
        for (const auto &[factors, point] : branch)
          add_global(factors, point);
        if (interruption.requested())
          interrupt("the global branch is not complete");
        result.parts["global branch"] = timer.wall_time();
      }

      /// From the state of the first factor, condensed.
      void
      find_arc()
      {
        const CondensedScene<dim> condensed_scene = condensed();
        const dealii::Timer       timer;
        const LoadPathArc<dim>    arc = follow_arc<dim>(condensed_scene,
                                                     points[0],
                                                     settings.tolerance,
                                                     interruption);
        if (arc.interrupted)
          interrupt("the arc is not complete");
        if (!arc.note.empty())
          result.notes.push_back(arc.note);
        result.parts["arc"] = timer.wall_time();
        answer.arc          = arc.steps;
      }

      /// The largest force at a step, or inside of one.
      void
      find_peak()
      {
        if (!seeks_peak() || !has_no_failure())
          return;
        const dealii::Timer timer;
        Peak                peak = {steps[0], 0.};
        for (const LoadPathStep<dim> &step : steps)
          if (force(step) > force(peak.step))
            peak.step = step;
        // Bonds depend on what was before, so that a step is done again from
        // where it began, with the memory that bonds had then.
        for (const UnresolvedStep &begun : progress.unresolved)
          if (begun.bound > (1. + parameters.resolve) * force(peak.step) &&
              !interruption.requested())
            from(begun.first, begun.u, begun.memory)
              ->walk(steps[begun.first + 1].factors(),
                     parameters.resolve,
                     most_halvings,
                     peak);
          else
            peak.bound = std::max(peak.bound, begun.bound);
        // There is no state at the factor at which the body detaches.
        if (result.comes_off_at)
          peak.bound =
            std::max(peak.bound,
                     bound_of_force(steps.back(), *result.comes_off_at));
        if (interruption.requested())
          interrupt("the largest force is not known");
        // Steps that were found to be resolved are bounded by the part that is
        // asked for.
        if (force(peak.step) > 0.)
          answer.peak = {peak.step,
                         std::max(parameters.resolve,
                                  peak.bound / force(peak.step) - 1.)};
        result.parts["peak"] = timer.wall_time();
      }

      /// What is found, with the numbers of the last factor. The state's word
      /// may come from the global branch.
      Answer<dim>
      take_answer()
      {
        if (steps.empty())
          {
            // A body that detaches at the first factor has neither a state nor
            // J.
            result.u.reinit(scene.problem().unknowns().n_dofs());
            result.functional = std::numeric_limits<double>::quiet_NaN();
          }
        else
          {
            result.u            = progress.u;
            result.load_factor  = steps.back().factors();
            result.functional   = steps.back().state.functional;
            result.minimum.kind = kinds.back();
          }
        return std::move(answer);
      }

    private:
      /// The largest force so far, and a bound of it inside of the steps that
      /// were done for it.
      struct Peak
      {
        LoadPathStep<dim> step;
        double            bound;
      };

      /// The force that belongs to the displacement factor, whatever its sign.
      static double
      force(const LoadPathStep<dim> &step)
      {
        return std::abs(step.state.unit_displacement_work);
      }

      /// What the force may become on the way from the state @p before to @p
      /// last: as much more as with the largest stiffness so far. On the way
      /// back it becomes smaller first. Bonds that do not heal give no more
      /// than they have left, and a body without other loads, whose force is
      /// proportional to the factor as long as no more of them break, no more
      /// than its secant stiffness.
      double
      bound_of_force(const LoadPathStep<dim> &before,
                     const LoadFactors        last) const
      {
        const double way   = last.displacements - before.displacement_factor;
        double       slope = progress.stiffness;
        if (!parameters.bonds_heal &&
            before.displacement_factor * last.displacements > 0. &&
            !scene.problem().unknowns().has_gap() &&
            scene.problem().fields().applied_nodal_forces().linfty_norm() == 0.)
          slope = std::min(slope,
                           before.state.unit_displacement_work /
                             before.displacement_factor);
        return (way < 0. ? -1. : 1.) * before.state.unit_displacement_work +
               slope * std::abs(way);
      }

      static LoadFactors
      middle(const LoadFactors first, const LoadFactors last)
      {
        return {0.5 * (first.loads + last.loads),
                0.5 * (first.displacements + last.displacements)};
      }

      /// Whether the largest force is sought: it belongs to the factor of
      /// displacements, so that only this one may change. There has to be a
      /// step.
      bool
      seeks_peak() const
      {
        return parameters.resolve > 0. && parameters.moves_only() &&
               !steps.empty();
      }

      /// A path of its own from a step of this one, by the same solver.
      std::unique_ptr<PathFollower>
      from(const unsigned int step,
           const DofVector   &u,
           const BondMemory  &memory)
      {
        make_solver();
        Answer<dim> begun;
        begun.scene          = answer.scene;
        begun.choice         = answer.choice;
        begun.path.steps     = {steps[step]};
        begun.path.points    = {points[step]};
        begun.path.kinds     = {kinds[step]};
        begun.path.u         = u;
        begun.path.memory    = memory;
        begun.path.stiffness = progress.stiffness;
        auto inside          = std::make_unique<PathFollower>(inside_of_step,
                                                     settings,
                                                     std::move(begun),
                                                     nullptr);
        inside->solver       = solver;
        solver->start_from(u);
        return inside;
      }

      /// The stiffness at the first factor, by a small part of the way to the
      /// second one, on which hardly any bonds break.
      void
      probe_stiffness()
      {
        if (parameters.factors.size() < 2)
          return;
        const LoadFactors first = steps[0].factors(), next = parameters.at(1);
        LoadFactors       near = first;
        near.displacements +=
          part_for_stiffness * (next.displacements - first.displacements);
        const auto inside = from(0, progress.u, progress.memory);
        if (inside->solve(near, [](const auto &, const auto &) {}))
          progress.stiffness = inside->stiffness_of_last_step();
        solver->start_from(progress.u);
      }

      /// The larger one of that so far and of the last step.
      double
      stiffness_of_last_step() const
      {
        const LoadPathStep<dim> &now    = steps.back();
        const LoadPathStep<dim> &before = steps[steps.size() - 2];
        const double way = now.displacement_factor - before.displacement_factor;
        return way == 0. ? progress.stiffness :
                           std::max(progress.stiffness,
                                    (now.state.unit_displacement_work -
                                     before.state.unit_displacement_work) /
                                      way);
      }

      /// Keeps what the last step started from, if the force may have been
      /// larger inside of it than at all steps so far.
      void
      keep_if_unresolved(UnresolvedStep begun)
      {
        progress.stiffness = stiffness_of_last_step();
        double largest     = 0.;
        for (const LoadPathStep<dim> &step : steps)
          largest = std::max(largest, force(step));
        begun.bound =
          bound_of_force(steps[begun.first], steps.back().factors());
        progress.unresolved.push_back(std::move(begun));
        progress.unresolved.erase(
          std::remove_if(progress.unresolved.begin(),
                         progress.unresolved.end(),
                         [&](const UnresolvedStep &step) {
                           return step.bound <=
                                  (1. + parameters.resolve) * largest;
                         }),
          progress.unresolved.end());
      }

      /// Goes to @p last in steps that are halved as long as the force inside
      /// of one may be larger than that of the @p peak by more than the part @p
      /// resolve of it, at most @p halvings times. The peak gets what they
      /// find. Returns whether there is a state at @p last.
      bool
      walk(const LoadFactors  last,
           const double       resolve,
           const unsigned int halvings,
           Peak              &peak)
      {
        const PathProgress<dim> begun = progress;
        const double            bound = bound_of_force(steps.back(), last);
        const auto              is_resolved = [&]() {
          return bound <= (1. + resolve) * force(peak.step);
        };
        const bool may_halve = halvings > 0 && !interruption.requested();
        if (may_halve && !is_resolved() && bound <= 2. * force(peak.step))
          return walk_halves(last, resolve, halvings, peak);
        // The whole step, which tells most as long as no force is known that
        // comes near to the bound.
        const bool has_state = solve(last, [](const auto &, const auto &) {}) &&
                               steps.back().message.empty();
        if (has_state)
          {
            progress.stiffness = stiffness_of_last_step();
            if (force(steps.back()) > force(peak.step))
              peak.step = steps.back();
          }
        if (may_halve && !is_resolved())
          {
            progress = begun;
            solver->start_from(progress.u);
            return walk_halves(last, resolve, halvings, peak);
          }
        peak.bound = std::max(peak.bound, bound);
        return has_state;
      }

      bool
      walk_halves(const LoadFactors  last,
                  const double       resolve,
                  const unsigned int halvings,
                  Peak              &peak)
      {
        if (walk(middle(steps.back().factors(), last),
                 resolve,
                 halvings - 1,
                 peak))
          return walk(last, resolve, halvings - 1, peak);
        // Nothing is known beyond a state that was not found.
        peak.bound = std::max(peak.bound, bound_of_force(steps.back(), last));
        return false;
      }

      /// Made when it is needed: not if all steps are done, and there is no
      /// more to do.
      void
      make_solver()
      {
        if (solver)
          return;
        const dealii::Timer timer;
        // A factorisation, or the levels of multigrid, serve all remaining
        // steps.
        solver = make_contact_solver(answer.choice, settings.parameters, scene);
        if (!steps.empty())
          solver->start_from(progress.u);
        // If only bonds hold the body, S is semidefinite and has no condition.
        if (const Condensation *const condensed = solver->condensed();
            condensed && scene.problem().unknowns().is_held_by_supports())
          result.condition_estimate = condensed->condition_estimate();
        result.parts["condensation"] += timer.wall_time();
      }

      /// The scene on its contact normals, if the method has it so.
      CondensedScene<dim>
      condensed()
      {
        make_solver();
        Assert(solver->condensed() != nullptr, dealii::ExcInternalError());
        return {scene, *solver->condensed()};
      }

      /// The last step, of an earlier run or of the loop over meshes, is told
      /// as if it had been done now.
      void
      repeat_last_step(const LoadPathObserver<dim> &observer)
      {
        const AdhesionIntegral<dim> bonds = bonds_before();
        const VerifiedState<dim>    last(scene,
                                      bonds,
                                      steps.back().factors(),
                                      progress.u);
        tell(bonds, last.verification, observer);
      }

      void
      tell(const AdhesionIntegral<dim> &bonds,
           const Verification<dim>     &verification,
           const LoadPathObserver<dim> &observer)
      {
        // The observer gets the bonds as the step has left them, since the
        // estimate of the error and the files are of these.
        answer.path_bonds =
          std::make_shared<const AdhesionIntegral<dim>>(bonds);
        observer(answer, verification);
      }

      /// Returns whether there is a next step: not if the body detaches.
      bool
      solve(const LoadFactors factors, const LoadPathObserver<dim> &observer)
      {
        const Stage           stage("load path, step " +
                          std::to_string(steps.size() + 1) + ", " +
                          parameters.name(factors));
        AdhesionIntegral<dim> bonds =
          scene.adhesion().at(factors.displacements);
        bonds.set_memory(progress.memory);
        // The bonds are those of this step: with the prescribed displacements
        // at its factor, and with the memory of all steps before.
        const Solution minimum = minimise(factors, bonds);
        // A signal within a step discards it, and the state is that of the step
        // before. Of the first step there is nothing but what was reached.
        if (minimum.status == SolverStatus::interrupted && !steps.empty())
          {
            interrupt("the path is not complete");
            return false;
          }
        result.add(minimum);
        result.message.clear();
        // The body detaches, so that there is no state at this factor. The
        // result remains that of the factor before.
        if (minimum.status == SolverStatus::comes_off)
          {
            result.comes_off_at = factors;
            result.message      = minimum.message;
            table.row(factors, to_string(minimum.status));
            return false;
          }
        add_step(factors, minimum, bonds, observer);
        return true;
      }

      /// The minimum from the state before. The fracture energy of bonds may
      /// depend on the mode at which they are damaged, which only the minimum
      /// tells: it is sought again with the modes found, until they hold.
      Solution
      minimise(const LoadFactors factors, AdhesionIntegral<dim> &bonds)
      {
        const AdhesionIntegral<dim> last = bonds_before();
        for (unsigned int k = 1;; ++k)
          {
            // The modes that bonds have are fixed while J is minimised, as
            // their energy has no potential otherwise. If what they take then
            // depends on the modes found by more than a small part, the step is
            // done again from the same start with these. The number of such
            // repetitions is limited.
            Progress silent;
            bonds.freeze_mode();
            Solution minimum = solver->minimise(factors, bonds, silent);
            if (!can_be_verified(minimum.status) ||
                bonds.adapt_mode(last, last_point(), solver->point()) <=
                  Tolerance::lag_of_mode ||
                k == most_modes)
              return minimum;
            solver->start_from(progress.u);
          }
      }

      Eigen::VectorXd
      last_point() const
      {
        return points.empty() ? scene.problem().unknowns().contact().at_rest() :
                                points.back();
      }

      /// The bonds of the last step. To begin with the body is at rest, where
      /// gaps may stretch them beyond what they return from.
      AdhesionIntegral<dim>
      bonds_before() const
      {
        AdhesionIntegral<dim> bonds = scene.adhesion().at(
          steps.empty() ? 0. : steps.back().factors().displacements);
        bonds.set_memory(progress.memory);
        return bonds;
      }

      /// The step to a minimum. Bonds that do not heal break where it is.
      void
      add_step(const LoadFactors            factors,
               const Solution              &minimum,
               AdhesionIntegral<dim>       &bonds,
               const LoadPathObserver<dim> &observer)
      {
        // The first change on the way from the last step is one of the bonds as
        // they were before it. It takes S, and is not known without it.
        std::optional<double>     change_factor;
        const Condensation *const condensed = solver->condensed();
        if (!steps.empty() && condensed != nullptr)
          change_factor =
            first_bond_change<dim>({scene, *condensed},
                                   bonds,
                                   {steps.back().factors(), points.back()},
                                   factors,
                                   interruption);
        // The order matters: the displacement is refined before bonds break for
        // good by it, and the verification is of the bonds as they are then.
        std::optional<UnresolvedStep> begun;
        if (seeks_peak())
          begun = {static_cast<unsigned int>(steps.size() - 1),
                   0.,
                   progress.u,
                   progress.memory};
        progress.u = solver->displacement();
        refine(bonds, factors, *solver->correction(), progress.u);
        points.push_back(solver->point());
        if (!parameters.bonds_heal)
          bonds.break_for_good(scene.contact_trace(progress.u));
        progress.memory = bonds.memory();

        const VerifiedState<dim> state(scene, bonds, factors, progress.u);
        LoadPathStep<dim>        step =
          step_of(state, static_cast<unsigned int>(steps.size() + 1), factors);
        step.change_factor = change_factor;
        step.iterations    = minimum.iterations;
        step.status        = to_string(minimum.status);
        // The kind of the minimum follows from the pieces of the law alone,
        // unless bonds soften: then the second-order condition needs S, and g
        // at this factor.
        std::optional<Condensation> at_step;
        if (condensed != nullptr && bonds.softens())
          at_step = CondensedScene<dim>{scene, *condensed}.at(factors);
        kinds.push_back(kind_without_search(bonds,
                                            points.back(),
                                            at_step ? &*at_step : nullptr));
        judge(minimum, state.verification, step);
        steps.push_back(step);
        if (begun && step.message.empty())
          keep_if_unresolved(std::move(*begun));
        else if (steps.size() == 1 && step.message.empty() && seeks_peak())
          probe_stiffness();
        tell(bonds, state.verification, observer);
      }

      /// Status and message of a step, by what the solver and the verification
      /// say. If rounding kept the solver from its tolerance, the verification
      /// decides.
      void
      judge(const Solution          &minimum,
            const Verification<dim> &verification,
            LoadPathStep<dim>       &step)
      {
        const std::string own = location(step) + minimum.message;
        // Either the method has failed, or what it found is not verified, or it
        // is a minimum. A step of the first two kinds has a message, which ends
        // the path. A method that has stagnated by rounding counts as a success
        // if the verification holds, with one note for the whole path.
        if (!can_be_verified(minimum.status))
          step.message = result.message = own;
        else if (!is_verified(verification))
          {
            step.message = location(step) + failure(verification);
            if (minimum.status == SolverStatus::success)
              step.status = "not verified";
            else
              result.message = own;
          }
        else
          {
            step.state.minimum = to_string(kinds.back());
            if (minimum.status == SolverStatus::stagnated)
              {
                result.status = SolverStatus::success;
                step.status   = to_string(result.status);
                if (result.notes.empty())
                  result.notes.push_back(own);
              }
          }
      }

      void
      refine(const AdhesionIntegral<dim> &bonds,
             const LoadFactors            factors,
             CorrectionSolver            &correction,
             DofVector                   &u)
      {
        const Refined refined = refine_where_needed(
          scene, bonds, factors, correction, interruption, u);
        result.is_refined = refined.is_refined;
        if (!refined.note.empty() && result.notes.empty())
          result.notes.push_back(refined.note);
      }

      bool
      is_verified(const Verification<dim> &verification) const
      {
        return verification.error() <= settings.tolerance;
      }

      std::string
      failure(const Verification<dim> &verification) const
      {
        return verification.failure(settings.tolerance,
                                    solver->condensed() == nullptr);
      }

      std::string
      location(const LoadPathStep<dim> &step) const
      {
        return Debond::location(parameters, step);
      }

      /// As a factorisation, a factor of S for each majorant, and what steps
      /// take besides. It is the same if the path was cut in two runs.
      double
      operations_of_path() const
      {
        double n_majorants = 0.;
        for (const LoadPathStep<dim> &step : steps)
          n_majorants += step.iterations;
        return answer.choice.operations +
               n_majorants / 3. * std::pow(double(points[0].size()), 3.) +
               double(steps.size()) *
                 (least_of_step +
                  of_step * double(scene.problem().unknowns().n_dofs()));
      }

      /// Enters a point of the global branch at all steps with its factors.
      void
      add_global(const LoadFactors factors, const BranchPoint &point)
      {
        // A point of the branch is refined and verified as a state of the path
        // is. Its bonds have no memory, as there is a branch only for bonds
        // that heal.
        const CondensedScene<dim>   condensed_scene = condensed();
        const AdhesionIntegral<dim> bonds_there =
          condensed_scene.bonds(factors);
        DofVector u = condensed_scene.at(factors).expand(point.s);
        refine(bonds_there, factors, *solver->correction(), u);
        VerifiedState<dim>  state(scene, bonds_there, factors, u);
        LoadPathState<dim> &global   = state.state;
        const bool          verified = is_verified(state.verification);
        if (verified)
          global.minimum = to_string(point.which.kind);
        // Both energies are sums that are rounded relative to J at the largest
        // factor: without loads J is nothing but that rounding.
        double rounding = 0.;
        for (const LoadPathStep<dim> &step : steps)
          rounding =
            std::max(rounding,
                     Tolerance::epsilon * std::abs(step.state.functional));
        for (unsigned int k = 0; k < steps.size(); ++k)
          if (steps[k].factors() == factors)
            {
              LoadPathStep<dim> &step = steps[k];
              step.global             = global;
              if (point.which.proof_attempted)
                step.relative_gap = point.which.relative_gap;
              if (!verified && step.message.empty())
                step.message = location(step) +
                               "global branch: " + failure(state.verification);
              // The followed state is this one, or as good: it gets the word of
              // the search or of the proof.
              if (step.message.empty() &&
                  step.state.functional <=
                    global.functional + rounding +
                      settings.parameters.proof.tolerance *
                        std::abs(global.functional))
                {
                  kinds[k]           = point.which.kind;
                  step.state.minimum = global.minimum;
                }
            }
      }

      void
      interrupt(const std::string &what)
      {
        result.status  = SolverStatus::interrupted;
        result.message = location(steps.back()) + "interrupted, " + what;
      }

      Answer<dim>                     answer;
      PathProgress<dim>              &progress = answer.path;
      Solution                       &result   = answer.solution;
      std::vector<LoadPathStep<dim>> &steps    = progress.steps;
      std::vector<Eigen::VectorXd>   &points   = progress.points;
      std::vector<MinimumKind>       &kinds    = progress.kinds;
      const LoadPathParameters       &parameters;
      const SolveSettings            &settings;
      const Scene<dim>               &scene;
      const PathTable<dim>            table;
      const Interruption             &interruption = Interruption::by_signal();

      /// For the paths that look for the largest force inside of steps.
      LoadPathParameters inside_of_step;

      std::shared_ptr<ContactSolver<dim>> solver; ///< see make_solver()
    };
  } // namespace



  template <int dim>
  Answer<dim>
  follow_load_path(const LoadPathParameters    &parameters,
                   const SolveSettings         &settings,
                   Answer<dim>                  begun,
                   const LoadPathObserver<dim> &observer,
                   std::ostream                *out,
                   const bool                   only_steps)
  {
    PathFollower<dim> path(parameters, settings, std::move(begun), out);
    path.follow(observer);
    if (only_steps)
      return path.take_answer();
    path.find_peak();
    // The order matters: first the followed path, whose states the branch
    // begins with. A path that has failed has neither branch nor arc.
    const bool wants_branch = parameters.global_branch != GlobalBranch::none;
    const bool has_branch   = path.has_global_branch();
    if (wants_branch && has_branch && path.has_no_failure())
      path.find_global_branch();
    if (parameters.arc && path.has_no_failure())
      path.find_arc();
    Answer<dim> answer = path.take_answer();
    if (parameters.asks_for_branch && wants_branch && !has_branch)
      answer.solution.notes.push_back(
        "There is no global branch: it is for bonds that heal, a direct linear "
        "solver and bodies that not only bonds and the foundation hold.");
    return answer;
  }



  template <int dim>
  Answer<dim>
  solve_on_mesh(const LoadPathParameters    &parameters,
                const SolveSettings         &settings,
                Answer<dim>                  begun,
                const LoadPathObserver<dim> &observer,
                const ProgressLog            log,
                const bool                   only_steps)
  {
    if (!parameters.factors.empty())
      return follow_load_path(
        parameters, settings, std::move(begun), observer, log.out, only_steps);
    // On a refined mesh the minimum is sought from the state of the mesh
    // before; without one the start is rest, or what coarser spaces give.
    const DofVector &start = begun.meshes.start;
    begun.solution         = solve(begun.choice,
                           settings.parameters,
                           *begun.scene,
                           log,
                           start.size() > 0 ? &start : nullptr);
    return begun;
  }



  DEBOND_INSTANTIATE(follow_load_path);
  DEBOND_INSTANTIATE(solve_on_mesh);
} // namespace Debond
