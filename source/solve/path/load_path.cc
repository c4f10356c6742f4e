// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/instantiate.h>
#include <debond/solve/minimum/contact_solver.h>
#include <debond/solve/minimum/refinement.h>
#include <debond/solve/minimum/solve.h>
#include <debond/solve/path/branch_of_path.h>
#include <debond/solve/path/coulomb.h>
#include <debond/solve/path/largest_force.h>
#include <debond/solve/path/load_path.h>
#include <debond/solve/path/load_path_arc.h>
#include <debond/solve/path/path_table.h>

#include <numeric>
#include <utility>

namespace Debond
{
  namespace
  {
    /// How often a step is done with new modes of its bonds.
    constexpr unsigned int most_modes = 10;



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
        , force(scene,
                [this](const PathEnd<dim> &from, const LoadFactors factors) {
                  return state_inside(from, factors);
                })
      {
        if (!steps.empty())
          return;
        // A path remembers from step to step the displacement, from which the
        // next minimisation starts; the bonds' memory, what each has reached;
        // and s of all steps, from which the global branch starts. To begin
        // with the body is at rest.
        const ElasticUnknowns<dim> &unknowns = scene.problem().unknowns();
        progress.u.reinit(unknowns.n_dofs());
        unknowns.contact().add(unknowns.contact().at_rest(), progress.u);
        if (!parameters.bonds_heal)
          progress.memory = memory_at_rest(scene);
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
        // An earlier run may not have looked for it.
        if (!steps.empty() && seeks_force() && !progress.peak)
          progress.peak = peak_of_steps(steps);
        const dealii::Timer timer;
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
        if (seconds_of_force > 0.)
          result.parts["largest force"] += seconds_of_force;
        result.parts["followed path"] += timer.wall_time() - seconds_of_force;
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

      /// If only bonds hold the body J may fall without end, and with an energy
      /// that depends on the mode there is no J.
      bool
      has_global_branch() const
      {
        return (solver ? solver->condensed() != nullptr :
                         answer.choice.is_condensed) &&
               !scene.adhesion().points().depends_on_mode() &&
               scene.adhesion().friction().empty() &&
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
        CondensedScene<dim> condensed_scene = condensed();
        if (!parameters.bonds_heal)
          condensed_scene.memory = memory_at_rest(scene);
        enter_global_branch(
          condensed_scene, settings, table, *solver->correction(), answer);
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
      /// What a step has led to.
      struct Reached
      {
        PathEnd<dim>      end;
        Verification<dim> verification;
      };

      /// Whether the largest force is sought: it belongs to the factor of
      /// displacements, so that only this one may change.
      bool
      seeks_force() const
      {
        return parameters.resolve > 0. && parameters.moves_only();
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
        VerifiedState<dim> last(scene,
                                bonds_of(this->last()),
                                steps.back().factors(),
                                progress.u);
        last.verification.breaks = progress.breaks;
        tell(last.verification, observer);
      }

      void
      tell(const Verification<dim>     &verification,
           const LoadPathObserver<dim> &observer)
      {
        // The observer gets the bonds as the step has left them, since the
        // estimate of the error and the files are of these.
        answer.path_bonds =
          std::make_shared<const AdhesionIntegral<dim>>(bonds_of(last()));
        observer(answer, verification);
      }

      /// Where the path is, to begin with at rest.
      PathEnd<dim>
      last() const
      {
        if (!steps.empty())
          return {steps.back(),
                  points.back(),
                  kinds.back(),
                  progress.u,
                  progress.memory};
        PathEnd<dim> rest = {};
        rest.step.factor  = parameters.at(0).loads;
        rest.point        = scene.problem().unknowns().contact().at_rest();
        rest.u            = progress.u;
        rest.memory       = progress.memory;
        return rest;
      }

      /// The bonds as a step has left them. At rest gaps may stretch them
      /// beyond what they return from.
      AdhesionIntegral<dim>
      bonds_of(const PathEnd<dim> &end) const
      {
        AdhesionIntegral<dim> bonds =
          scene.adhesion().at(end.step.displacement_factor);
        bonds.set_memory(end.memory);
        return bonds;
      }

      /// Returns whether there is a next step: not if the body detaches.
      bool
      solve(const LoadFactors factors, const LoadPathObserver<dim> &observer)
      {
        const Stage            stage("load path, step " +
                          std::to_string(steps.size() + 1) + ", " +
                          parameters.name(factors));
        const PathEnd<dim>     begun   = last();
        std::optional<Reached> reached = step_to(factors, begun, result);
        // A signal within a step discards it, and the state is that of the step
        // before. Of the first step there is nothing but what was reached.
        if ((!reached && !result.comes_off_at) ||
            (!look_for_force(begun, factors, reached) && !steps.empty()))
          {
            interrupt("the path is not complete");
            return false;
          }
        // The body detaches, so that there is no state at this factor. The
        // result remains that of the factor before.
        if (!reached)
          {
            table.row(factors, to_string(result.status));
            return false;
          }
        steps.push_back(reached->end.step);
        points.push_back(reached->end.point);
        kinds.push_back(reached->end.kind);
        progress.u      = reached->end.u;
        progress.memory = reached->end.memory;
        note_breaks(parameters.varying(factors),
                    reached->verification.nodes,
                    progress.breaks);
        reached->verification.breaks = progress.breaks;
        tell(reached->verification, observer);
        return true;
      }

      /// Looks for the largest force on the way of a step. Returns false, with
      /// what was known before, if a signal cuts that short.
      bool
      look_for_force(const PathEnd<dim>           &begun,
                     const LoadFactors             factors,
                     const std::optional<Reached> &reached)
      {
        if (!seeks_force())
          return true;
        // Beyond a state that was not found there may be any force.
        if (reached && !reached->end.step.message.empty())
          {
            if (progress.peak)
              progress.peak->bound.reset();
            return true;
          }
        const dealii::Timer              timer;
        std::optional<LoadPathPeak<dim>> peak = progress.peak;
        n_inside                              = 0;
        force.look_into(begun,
                        factors,
                        reached ? &reached->end.step : nullptr,
                        peak);
        if (n_inside > 0 && reached)
          solver->start_from(reached->end.u);
        seconds_of_force += timer.wall_time();
        if (n_inside > 0 && interruption.requested())
          return false;
        progress.peak = peak;
        return true;
      }

      /// A verified state inside of a step, if there is one. It is none of the
      /// path's, whose result gets no more than a note that concerns all that
      /// follows.
      std::optional<PathEnd<dim>>
      state_inside(const PathEnd<dim> &begun, const LoadFactors factors)
      {
        ++n_inside;
        solver->start_from(begun.u);
        Solution inside;
        inside.notes                         = result.notes;
        const std::optional<Reached> reached = step_to(factors, begun, inside);
        result.notes                         = inside.notes;
        if (!reached || !reached->end.step.message.empty())
          return {};
        return reached->end;
      }

      /// The step from @p begun, where the solver is, to @p factors. Bonds that
      /// do not heal break where it leads to. Nothing if a signal comes or if
      /// the body detaches, which @p result says then.
      std::optional<Reached>
      step_to(const LoadFactors   factors,
              const PathEnd<dim> &begun,
              Solution           &result)
      {
        // The bonds are those of this step: with the prescribed displacements
        // at its factor, and with the memory of all steps before.
        AdhesionIntegral<dim> bonds =
          scene.adhesion().at(factors.displacements);
        bonds.set_memory(begun.memory);
        bonds.slide_to(scene.contact_trace(begun.u));
        const Solution minimum = minimise_with_friction(factors, begun, bonds);
        if (minimum.status == SolverStatus::interrupted && begun.step.step > 0)
          return {};
        result.add(minimum);
        result.message.clear();
        if (minimum.status == SolverStatus::comes_off)
          {
            result.comes_off_at = factors;
            result.message      = minimum.message;
            return {};
          }
        // The order matters: the displacement is refined before bonds break for
        // good by it, and the verification is of the bonds as they are then.
        PathEnd<dim> end;
        end.u = solver->displacement();
        refine_state(
          scene, bonds, factors, *solver->correction(), end.u, result);
        end.point = solver->point();
        if (!parameters.bonds_heal)
          bonds.break_for_good(scene.contact_trace(end.u));
        end.memory = bonds.memory();

        const VerifiedState<dim> state(scene, bonds, factors, end.u);
        end.step            = step_of(state, begun.step.step + 1, factors);
        end.step.iterations = minimum.iterations;
        end.step.status     = to_string(minimum.status);
        // The kind of the minimum follows from the pieces of the law alone,
        // unless bonds soften: then the second-order condition needs S, and g
        // at this factor.
        std::optional<Condensation> at_step;
        const Condensation *const   condensed = solver->condensed();
        if (condensed != nullptr && bonds.softens())
          at_step = CondensedScene<dim>{scene, *condensed}.at(factors);
        end.kind =
          kind_without_search(bonds, end.point, at_step ? &*at_step : nullptr);
        judge(minimum, state.verification, end, result);
        return Reached{std::move(end), state.verification};
      }

      /// The minimum from the state before. Where friction depends on the
      /// pressure it begins with all that sticks in the first step. In others
      /// what has stuck sticks and what has slid has its pressures of then, or
      /// all sticks if these do not hold the body. Other starts may settle on
      /// other states; a note says so.
      Solution
      minimise_with_friction(const LoadFactors      factors,
                             const PathEnd<dim>    &begun,
                             AdhesionIntegral<dim> &bonds)
      {
        if (!bonds.friction().depends_on_pressure())
          return minimise(factors, begun, bonds);
        const std::vector<bool> all(bonds.n_unknowns(), true);
        const bool              is_first = begun.step.step == 0;
        if (is_first)
          bonds.stick(all);
        const bool         breaks = scene.law().pieces().size() > 1;
        const Condensation condensed_here =
          CondensedScene<dim>{scene, *solver->condensed()}.at(factors);
        const auto settle = [&](AdhesionIntegral<dim> &from) {
          bool begins = true;
          return settle_friction<dim>(
            {[&]() {
               // Bonds that break with other pressures would stay broken, and
               // what has slid would not be where it sticks.
               if (breaks || std::exchange(begins, false))
                 solver->start_from(begun.u);
               return minimise(factors, begun, from);
             },
             [&]() {
               // What is closed is pressed by what is missing to equilibrium.
               const Eigen::VectorXd s = solver->point();
               const Eigen::VectorXd forces =
                 condensed_here.load() - condensed_here.schur_complement() * s;
               return Eigen::VectorXd(
                 (s.array() == 0.).select(forces, 0.).head(bonds.n_nodes()));
             }},
            from);
        };
        Solution result = settle(bonds);
        if (result.status == SolverStatus::comes_off && !is_first)
          {
            bonds.stick(all);
            result = settle(bonds);
          }
        if (!can_be_verified(result.status) || knows_other_friction)
          return result;
        // The second start is the opposite of what was found: what sticks is
        // not pressed, and what slides sticks. The state stays what it is, and
        // the solver returns to it.
        const DofVector       u     = solver->displacement();
        const Eigen::VectorXd s     = solver->point();
        AdhesionIntegral<dim> other = bonds;
        std::vector<bool>     slides;
        for (Eigen::Index i = 0; i < s.size(); ++i)
          slides.push_back(bonds.kinks().way(i, s) > 0.);
        other.stick(slides);
        knows_other_friction =
          can_be_verified(settle(other).status) &&
          (solver->point() - s).norm() > Tolerance::other_friction * s.norm();
        solver->start_from(u);
        if (knows_other_friction)
          result.notes.push_back(
            words("Coulomb's friction has several states at ",
                  parameters.name(factors),
                  ": from other pressures another one is found. The path "
                  "follows that to which ",
                  is_first ? "all that sticks leads" :
                             "what sticks, and pressures of the step before "
                             "where it slides, lead"));
        return result;
      }

      /// The minimum from the state before. The fracture energy of bonds may
      /// depend on the mode at which they are damaged, which only the minimum
      /// tells: it is sought again with the modes found, until they hold.
      Solution
      minimise(const LoadFactors      factors,
               const PathEnd<dim>    &begun,
               AdhesionIntegral<dim> &bonds)
      {
        const AdhesionIntegral<dim> before = bonds_of(begun);
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
                bonds.adapt_mode(before, begun.point, solver->point()) <=
                  Tolerance::lag_of_mode ||
                k == most_modes)
              return minimum;
            solver->start_from(begun.u);
          }
      }

      /// Status and message of a step, by what the solver and the verification
      /// say. If rounding kept the solver from its tolerance, the verification
      /// decides.
      void
      judge(const Solution          &minimum,
            const Verification<dim> &verification,
            PathEnd<dim>            &end,
            Solution                &result) const
      {
        LoadPathStep<dim> &step  = end.step;
        const std::string  where = location(parameters, step);
        // Either the method has failed, or what it found is not verified, or it
        // is a minimum. A step of the first two kinds has a message, which ends
        // the path. A method that has stagnated by rounding counts as a success
        // if the verification holds, with one note for the whole path.
        if (!can_be_verified(minimum.status))
          step.message = result.message = where + minimum.message;
        else if (verification.error() > settings.tolerance)
          {
            step.message =
              where + verification.failure(settings.tolerance,
                                           solver->condensed() == nullptr);
            if (minimum.status == SolverStatus::success)
              step.status = "not verified";
            else
              result.message = where + minimum.message;
          }
        else
          {
            step.state.minimum = to_string(end.kind);
            if (minimum.status == SolverStatus::stagnated)
              {
                result.status = SolverStatus::success;
                step.status   = to_string(result.status);
                if (result.notes.empty())
                  result.notes.push_back(where + minimum.message);
              }
          }
      }

      void
      interrupt(const std::string &what)
      {
        Debond::interrupt(parameters, steps.back(), what, result);
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
      const PathTable                 table;
      const LargestForce<dim>         force;
      const Interruption             &interruption = Interruption::by_signal();

      double       seconds_of_force = 0.;
      unsigned int n_inside         = 0; ///< states sought inside of a step

      /// Another state of Coulomb's friction was found, and a note says so.
      bool knows_other_friction = false;

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
        "There is no global branch: it is for a direct linear solver, no "
        "friction, no Mixed mode and bodies that not only bonds and the "
        "foundation hold.");
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
