// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/instantiate.h>
#include <debond/base/memory.h>
#include <debond/base/processes.h>
#include <debond/output/report.h>
#include <debond/program/check_result.h>
#include <debond/program/run.h>
#include <debond/program/run_output.h>
#include <debond/solve/minimum/displacement.h>

#include <filesystem>

namespace Debond
{
  namespace
  {
    /// What a run has found, on which mesh and how, or before the end what it
    /// goes on from. The state has the meshes that are done, why the last one
    /// is short of its target, and what a later run would go on from.
    template <int dim>
    struct Answer
    {
      std::shared_ptr<const Scene<dim>> scene;
      MethodChoice                      choice; ///< on this mesh
      FollowedPath<dim>                 path;   ///< one load: without steps
      RunState<dim>                     state;
    };



    /// What an earlier run of the scene has left in the directory, if there was
    /// one. Throws BadInput if it does not belong to the scene.
    template <int dim>
    RunState<dim>
    earlier_state(const Parameters &parameters, std::ostream &out)
    {
      const std::string file = state_file(parameters.output.directory);
      if (!std::filesystem::exists(file))
        {
          out << "There is no " << file
              << ": the run starts from the beginning.\n\n";
          return {};
        }
      const RunState<dim> state =
        read_state<dim>(file, parameters.effective_scene);
      // A path may be continued with other factors than it was begun with, as
      // long as the steps that are done are the same.
      const LoadPathParameters &load_path = parameters.load_path;
      for (unsigned int k = 0; k < state.path.steps.size(); ++k)
        {
          const LoadFactors before = state.path.steps[k].factors();
          if (k == load_path.factors.size() || !(load_path.at(k) == before))
            throw BadInput(
              {file + ": Load path/Factors: step " + std::to_string(k + 1) +
               " was with " + load_path.name(before) +
               "; only later steps may differ, or run without --restart"});
        }
      return state;
    }



    /// The scene on the first mesh of this run, with what an earlier one has
    /// found there, and its method. Throws BadInput for all that is wrong with
    /// the scene, so that nothing is lost in a solve.
    template <int dim>
    Answer<dim>
    begin(const Parameters &parameters, const RunState<dim> &earlier)
    {
      Answer<dim> begun;
      // First of all, since it refuses what would not fit into memory.
      begun.choice      = choose_method(parameters, parameters.solver);
      begun.scene       = make_first_scene<dim>(parameters,
                                          parameters.accuracy,
                                          parameters.solver.start,
                                          earlier.meshes.divisions);
      begun.state       = earlier;
      begun.state.scene = parameters.effective_scene;
      begun.state.mesh  = mesh_checksum(*begun.scene);
      if (earlier.mesh != 0 && earlier.mesh != begun.state.mesh)
        throw BadInput({state_file(parameters.output.directory) +
                        " is of another mesh; run without --restart"});
      // Displacements in the file have the order of one rank, here they get
      // that of these ranks.
      for (DofVector *const u :
           {&begun.state.meshes.start, &begun.state.path.u})
        if (u->size() > 0)
          *u = from_serial_order(begun.scene->problem().unknowns(), *u);
      begun.path.progress = begun.state.path;
      choose_linear_solver(*begun.scene, parameters.solver, begun.choice);
      check_supports_of_method(begun.choice, parameters.solver, *begun.scene);
      check_exact_displacement(parameters.verification.exact_displacement,
                               *begun.scene);
      return begun;
    }



    /// The steps from a scene on its first mesh to its answer.
    template <int dim>
    class Run
    {
    public:
      const Parameters &parameters;
      const RunOptions  options;
      std::ostream     &out;
      RunOutput<dim>   &output;
      Record           &record;

      /// The minimum on one mesh.
      Answer<dim>
      minimise(Answer<dim> answer) const
      {
        const DofVector &start = answer.state.meshes.start;
        answer.path.result     = Debond::solve(answer.choice,
                                           parameters.solver,
                                           *answer.scene,
                                           log(),
                                           options.terminal,
                                           start.size() > 0 ? &start : nullptr);
        // A signal leaves the last iterate in the state, from which --restart
        // goes on.
        const SolveResult &found = answer.path.result;
        if (found.u.size() > 0 && (found.status == SolverStatus::interrupted ||
                                   found.minimum.interrupted))
          {
            answer.state.meshes.start = found.u;
            output.save(answer.state, *answer.scene);
          }
        return answer;
      }

      /// The minimum, or the states of the load path, on meshes that are
      /// refined until their error is small enough.
      Answer<dim>
      refine(Answer<dim> answer, RefinementGoal<dim> *const goal) const
      {
        // Each mesh is reported when it is done, and its state saved before the
        // next one is solved, so that a run that ends there begins again with
        // that mesh.
        AdaptiveObserver<dim> observer;
        observer.level_is_done = [&](const unsigned int   number,
                                     const AdaptiveLevel &level) {
          report_level(number, level, record);
          record.print(out);
        };
        observer.next_mesh_is_made = [&](const AdaptiveProgress &progress,
                                         const Scene<dim>       &next) {
          answer.state.mesh   = mesh_checksum(next);
          answer.state.meshes = progress;
          output.save(answer.state, next);
          output.begin_mesh(next);
        };
        observer.step_is_done = [&](const PathProgress<dim> &progress,
                                    const Verification<dim> &verification,
                                    const AdhesionIntegral<dim> &) {
          output.add(progress, verification);
        };
        // A path that has begun stays on its mesh.
        if (answer.state.has_last_mesh)
          {
            const auto &levels = answer.state.meshes.levels;
            for (unsigned int k = 0; k < levels.size(); ++k)
              observer.level_is_done(k, levels[k]);
            return answer;
          }
        try
          {
            AdaptiveResult<dim> adaptive =
              solve_adaptively(settings(answer.choice),
                               parameters.accuracy,
                               goal,
                               answer.state.meshes,
                               observer,
                               std::move(answer.scene));
            answer.scene               = adaptive.scene;
            answer.choice              = adaptive.choice;
            answer.path                = std::move(adaptive.path);
            answer.state.meshes.levels = std::move(adaptive.levels);
            answer.state.shortfall     = adaptive.shortfall;
            // From here on a restart stays on this mesh.
            answer.state.has_last_mesh = true;
          }
        catch (const BadInput &)
          {
            // A load that only the finer mesh shows to have no integral is an
            // error of the input. It leaves the directory as it was found, like
            // those that are seen at once.
            output.withdraw();
            throw;
          }
        // The steps are of the mesh that was interrupted.
        if (answer.path.result.status == SolverStatus::interrupted)
          output.begin_mesh(*answer.scene);
        return answer;
      }

      /// The states of the load path; of a refined mesh the global branch and
      /// the arc are left to do.
      Answer<dim>
      follow(Answer<dim> answer) const
      {
        output.begin_path(*answer.scene, answer.path.progress.steps);
        answer.path = follow_load_path<dim>(
          parameters.load_path,
          settings(answer.choice),
          *answer.scene,
          answer.path,
          [&](const PathProgress<dim> &progress,
              const Verification<dim> &verification,
              const AdhesionIntegral<dim> &) {
            output.add(progress, verification);
            // A step that went wrong is not saved, so that a restart tries it
            // again.
            if (!progress.steps.back().message.empty())
              return;
            answer.state.path = progress;
            output.save(answer.state, *answer.scene);
          },
          log());
        return answer;
      }

      /// All that the scene asks for.
      Answer<dim>
      solve(Answer<dim> begun, RefinementGoal<dim> *const goal) const
      {
        const bool  has_path = !parameters.load_path.factors.empty();
        Answer<dim> answer   = parameters.accuracy.is_adaptive() ?
                                 refine(std::move(begun), goal) :
                               has_path ? std::move(begun) :
                                          minimise(std::move(begun));
        if (has_path && answer.path.result.status != SolverStatus::interrupted)
          return follow(std::move(answer));
        return answer;
      }

    private:
      SolveSettings
      settings(const MethodChoice &choice) const
      {
        return {choice, parameters.solver, parameters.verification.tolerance};
      }

      /// For the iterations; null if there is none.
      std::ostream *
      log() const
      {
        return record.has_details() ? &out : nullptr;
      }
    };



    /// Says on std::cerr what did not go well.
    template <int dim>
    ExitCode
    conclude(const RunResult<dim> &result, const std::string &output_error)
    {
      const bool interrupted = result.solve.minimum.interrupted;
      const auto print       = [](const std::string &message) {
        if (is_first_rank())
          print_error(message);
      };
      // In the order of what the user has to know first: no answer, a search
      // that was cut short, files that are missing.
      if (!result.is_answer())
        print("NOT CONVERGED (" + result.status + "): " + result.message +
              (result.solve.status == SolverStatus::interrupted &&
                   (!result.path.empty() || !result.levels.empty()) ?
                 "; --restart goes on from what is done" :
                 ""));
      else if (interrupted)
        print("the search or the proof was interrupted; the result is what "
              "it had found");
      if (!output_error.empty())
        {
          print(output_error);
          return ExitCode::output_not_saved;
        }
      if (result.solve.status == SolverStatus::interrupted ||
          (result.is_success() && interrupted))
        return ExitCode::interrupted;
      return result.is_answer() ? ExitCode::success : ExitCode::not_converged;
    }
  } // namespace



  template <int dim>
  void
  validate(const Parameters &parameters, const Companion &companion)
  {
    companion.begin(parameters.solver,
                    begin(parameters, RunState<dim>()).scene);
  }



  template <int dim>
  ExitCode
  run(const Parameters &parameters,
      const Companion  &companion,
      std::ostream     &out,
      const RunOptions  options)
  {
    dealii::Timer       total, timer;
    const RunState<dim> earlier =
      options.restart ? earlier_state<dim>(parameters, out) : RunState<dim>();
    Answer<dim>    answer = begin(parameters, earlier);
    RunResult<dim> result;
    result.times = {{"mesh", answer.scene->mesh_seconds()},
                    {"assembly", answer.scene->assembly_seconds()}};
    const std::unique_ptr<RunCompanion<dim>> after =
      companion.begin(parameters.solver, answer.scene);

    std::optional<RunOutput<dim>> output;
    try
      {
        output.emplace(parameters,
                       *answer.scene,
                       *after,
                       options.restart ? &earlier : nullptr);
      }
    catch (const std::runtime_error &error)
      {
        if (is_first_rank())
          print_error(error.what());
        return ExitCode::output_not_saved;
      }
    Record record(parameters.output.machine_details);
    report_problem(*answer.scene,
                   answer.choice,
                   parameters.solver.bundle.u,
                   record);
    if (n_started_ranks() > 1 && record.has_details())
      record.line("ranks", std::to_string(n_started_ranks()));
    record.print(out);

    timer.restart();
    answer = Run<dim>{parameters, options, out, *output, record}.solve(
      std::move(answer), after->goal());
    result.times.emplace_back("solve", timer.wall_time());
    result.solve  = answer.path.result;
    result.levels = answer.state.meshes.levels;
    result.path   = answer.path.progress.steps;
    result.arc    = answer.path.arc;

    const Scene<dim> &scene = *answer.scene;
    check_result(parameters.verification,
                 parameters.notes,
                 scene,
                 answer.path.bonds ? *answer.path.bonds : scene.adhesion(),
                 answer.state.shortfall,
                 result);
    after->after(answer.scene, result);
    report_result(scene, answer.choice, result, record);
    after->report(record);

    // The summary comes last and names the cost of all that was written before,
    // so that whoever finds it knows the run to be complete.
    timer.restart();
    if (output->write(scene, result))
      {
        result.times.emplace_back("output", timer.wall_time());
        result.times.emplace_back("total", total.wall_time());
        report_cost(result,
                    answer.choice,
                    -least_of_ranks(-peak_memory()),
                    record);
        output->write_summary(record);
      }
    report_files(output->files_written(), record);
    record.print(out);
    return conclude(result, output->error());
  }



  DEBOND_INSTANTIATE(run);
  DEBOND_INSTANTIATE(validate);
} // namespace Debond
