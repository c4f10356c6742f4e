// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/instantiate.h>
#include <debond/base/memory.h>
#include <debond/base/processes.h>
#include <debond/output/report.h>
#include <debond/program/check_result.h>
#include <debond/program/run.h>
#include <debond/program/run_output.h>
#include <debond/solve/meshes/adaptive_loop.h>
#include <debond/solve/meshes/first_scene.h>
#include <debond/solve/minimum/displacement.h>
#include <debond/solve/minimum/solve.h>

#include <filesystem>

namespace Debond
{
  namespace
  {
    /// What an earlier run of the scene has left in the directory, if there was
    /// one. Throws BadInput if it does not belong to the scene.
    template <int dim>
    RunState<dim>
    earlier_state(const Parameters &parameters, std::ostream &out)
    {
      // A missing state is no error, so that the same command begins a run and
      // continues one that was killed.
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
      begun.choice = choose_method(parameters, parameters.solver);
      begun.scene  = make_first_scene<dim>(parameters,
                                          parameters.accuracy,
                                          parameters.solver.start,
                                          earlier.meshes.divisions);
      // 0 is the number without an earlier run. The entries of a scene may be
      // the same and its mesh another one, if the file of the mesh has changed.
      // The displacements of the state would belong to other nodes then.
      if (earlier.mesh != 0 && earlier.mesh != mesh_checksum(*begun.scene))
        throw BadInput({state_file(parameters.output.directory) +
                        " is of another mesh; run without --restart"});
      // Displacements in the file have the order of one rank, here they get
      // that of these ranks.
      RunState<dim> state = earlier;
      for (DofVector *const u : displacements_of(state))
        *u = from_serial_order(begun.scene->problem().unknowns(), *u);
      begun.meshes = state.meshes;
      begun.path   = state.path;
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

      /// All that the scene asks for. A load path on refined meshes has its
      /// global branch and its arc yet to come when the last mesh is done.
      Answer<dim>
      solve(Answer<dim> begun, RefinementGoal<dim> *const goal) const
      {
        // The loop over the meshes follows a load path on each of them, but
        // without what only the last mesh gets. That is done below, on the mesh
        // that the loop ended with; the steps are there already and are not
        // solved again, but for a factor at which the body detaches.
        Answer<dim> answer = std::move(begun);
        if (parameters.accuracy.is_adaptive())
          {
            answer = refine(std::move(answer), goal);
            if (parameters.load_path.factors.empty() ||
                answer.solution.status == SolverStatus::interrupted)
              return answer;
          }
        return solve_on_last_mesh(std::move(answer));
      }

    private:
      Answer<dim>
      solve_on_last_mesh(Answer<dim> begun) const
      {
        // Steps that an earlier run, or the loop over the meshes, has done here
        // have their files. solve_on_mesh() tells the observer of the last of
        // them once more, so that its files are written again.
        output.begin_path(*begun.scene, begun.path.steps);
        Answer<dim> answer =
          solve_on_mesh<dim>(parameters.load_path,
                             settings(),
                             std::move(begun),
                             [this](const Answer<dim>       &state,
                                    const Verification<dim> &verification) {
                               output.add(state.path, verification);
                               // A step that went wrong is not saved, so that a
                               // restart tries it again.
                               if (state.path.steps.back().message.empty())
                                 output.save(state);
                             },
                             {record.has_details() ? &out : nullptr,
                              options.terminal});
        // A signal leaves the last iterate in the state, from which --restart
        // continues.
        const Solution &found = answer.solution;
        if (answer.path.steps.empty() && found.u.size() > 0 &&
            (found.status == SolverStatus::interrupted ||
             found.minimum.interrupted))
          {
            answer.meshes.start = found.u;
            output.save(answer);
          }
        return answer;
      }

      /// The minimum, or the states of the load path, on meshes that are
      /// refined until their error is small enough. Each mesh is reported when
      /// it is done, and its state saved before the next one is solved, so that
      /// a run that ends there begins again with that mesh.
      Answer<dim>
      refine(Answer<dim> begun, RefinementGoal<dim> *const goal) const
      {
        AdaptiveObserver<dim> observer;
        observer.level_is_done = [this](const unsigned int   number,
                                        const AdaptiveLevel &level) {
          // The log has a mesh as soon as it is done: the next one may take
          // much longer.
          report_level(number, level, record);
          record.print(out);
        };
        observer.next_mesh_is_made = [this](const Answer<dim> &next) {
          // The state is saved first. A run that is killed between the two
          // calls leaves files of the old mesh and a state without steps; a
          // restart removes these files because there are no steps.
          output.save(next);
          output.begin_mesh(*next.scene);
        };
        observer.step_is_done = [this](const Answer<dim>       &state,
                                       const Verification<dim> &verification) {
          output.add(state.path, verification);
        };
        // A path that has begun stays on its mesh.
        if (begun.meshes.is_last)
          {
            for (unsigned int k = 0; k < begun.meshes.levels.size(); ++k)
              observer.level_is_done(k, begun.meshes.levels[k]);
            return begun;
          }
        try
          {
            Answer<dim> answer = solve_adaptively(settings(),
                                                  parameters.accuracy,
                                                  goal,
                                                  observer,
                                                  std::move(begun));
            // The steps are of the mesh that was interrupted.
            if (answer.solution.status == SolverStatus::interrupted)
              output.begin_mesh(*answer.scene);
            return answer;
          }
        catch (const BadInput &)
          {
            // A load that only the finer mesh shows to have no integral is an
            // error of the input. It leaves the directory as it was found, like
            // those that are seen at once.
            output.withdraw();
            throw;
          }
      }

      SolveSettings
      settings() const
      {
        return {parameters.solver, parameters.verification.tolerance};
      }
    };



    /// Says on std::cerr what did not go well.
    template <int dim>
    ExitCode
    conclude(const RunResult<dim> &result, const std::string &output_error)
    {
      // The exit code is 5 whenever something could not be written, since a
      // script would otherwise look for results that are not there. It is 4 if
      // a signal has cut short the solve, or a search, a proof or a certificate
      // after a verified result. In all other cases the answer decides between
      // 0 and 3; a result that is not verified is 3 also if its search was
      // interrupted.
      const bool interrupted = result.solution.minimum.interrupted;
      const auto print       = [](const std::string &message) {
        if (is_first_rank())
          print_error(message);
      };
      // In the order of what the user has to know first: no answer, a search
      // that was cut short, files that are missing.
      if (!result.is_answer())
        print(
          "NOT CONVERGED (" + result.status + "): " + result.message +
          (result.solution.status == SolverStatus::interrupted &&
               (!result.path.steps.empty() || !result.meshes.levels.empty()) ?
             "; --restart goes on from what is done" :
             ""));
      else if (interrupted)
        print("the search or the proof was interrupted; the result is what "
              "it had found, and --restart goes on from there");
      if (!output_error.empty())
        {
          print(output_error);
          return ExitCode::output_not_saved;
        }
      if (result.solution.status == SolverStatus::interrupted ||
          (result.is_success() && interrupted))
        return ExitCode::interrupted;
      return result.is_answer() ? ExitCode::success : ExitCode::not_converged;
    }
  } // namespace



  template <int dim>
  void
  validate(const Parameters &parameters, const Companion &companion)
  {
    // These are the calls by which run() refuses a scene before it writes
    // anything, but for the state of an earlier run: one makes the scene on its
    // first mesh, the other shows it to the companion.
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
    // What can be wrong with the scene is found first, when the directory is
    // still as it was: in the state of an earlier run, in begin() and by the
    // companion. Then the directory is locked and cleared, so that a directory
    // without access costs no solve. All ranks take the same steps, and what
    // fails fails on all of them; that is why none of them waits for another
    // one.
    dealii::Timer       total, timer;
    const RunState<dim> earlier =
      options.restart ? earlier_state<dim>(parameters, out) : RunState<dim>();
    Answer<dim>    begun = begin(parameters, earlier);
    RunResult<dim> result;
    result.times = {{"mesh", begun.scene->mesh_seconds()},
                    {"assembly", begun.scene->assembly_seconds()}};
    const std::unique_ptr<RunCompanion<dim>> after =
      companion.begin(parameters.solver, begun.scene);

    std::optional<RunOutput<dim>> output;
    try
      {
        output.emplace(parameters,
                       *begun.scene,
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
    // The log has the problem before the solve, so that the user sees in time
    // that it is another one than was meant.
    report_problem(begun, parameters.solver.bundle.u, record);
    if (n_started_ranks() > 1 && record.has_details())
      record.line("ranks", std::to_string(n_started_ranks()));
    record.print(out);

    // The goal of the companion can ask the loop for further meshes. When
    // check_result() has given the result a status, after() may add notes,
    // times and fields for body.vtu and contact.vtu, therefore it comes before
    // the report and the files. What the companion says itself stands behind
    // the result in the log.
    timer.restart();
    static_cast<Answer<dim> &>(result) =
      Run<dim>{parameters, options, out, *output, record}.solve(
        std::move(begun), after->goal());
    result.times.emplace_back("solve", timer.wall_time());
    check_result(parameters.verification, parameters.notes, result);
    after->after(result);
    report_result(result, record);
    after->report(record);

    // The summary comes last and names the cost of all that was written before,
    // so that whoever finds it knows the run to be complete.
    timer.restart();
    if (output->write(result))
      {
        result.times.emplace_back("output", timer.wall_time());
        result.times.emplace_back("total", total.wall_time());
        report_cost(result, -least_of_ranks(-peak_memory()), record);
        output->write_summary(record);
      }
    report_files(output->files_written(), record);
    record.print(out);
    return conclude(result, output->error());
  }



  DEBOND_INSTANTIATE(run);
  DEBOND_INSTANTIATE(validate);
} // namespace Debond
