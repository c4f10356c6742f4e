// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/append.h>
#include <debond/base/atomic_file.h>
#include <debond/base/directory_lock.h>
#include <debond/base/memory.h>
#include <debond/base/processes.h>
#include <debond/base/ranks.h>
#include <debond/base/text.h>
#include <debond/certify/certification.h>
#include <debond/input/bad_input.h>
#include <debond/output/load_path_output.h>
#include <debond/output/output_files.h>
#include <debond/output/record.h>
#include <debond/output/report.h>
#include <debond/output/run_result.h>
#include <debond/program/check_result.h>
#include <debond/program/run.h>
#include <debond/program/run_state.h>
#include <debond/solve/displacement.h>
#include <debond/solve/load_path.h>

#include <filesystem>
#include <memory>
#include <optional>

namespace Debond
{
  namespace
  {
    std::string
    output_path(const std::string &directory, const std::string &name)
    {
      return (std::filesystem::path(directory) / name).string();
    }



    /// The steps of run(), in their order.
    template <int dim>
    class SceneRun
    {
    public:
      /// Mesh, assembly and choice of the method.
      SceneRun(const Parameters &parameters,
               std::ostream     &out,
               const RunOptions  options)
        : parameters(parameters)
        , out(out)
        , options(options)
        , choice(choose_method(parameters, parameters.solver))
        , record(parameters.output.machine_details)
      {
        // The state of an earlier run decides the mesh, so it is read first.
        if (options.restart)
          read_state_before();
        state.scene              = parameters.effective_scene;
        scene                    = make_first_scene<dim>(parameters,
                                      parameters.accuracy,
                                      parameters.solver.start,
                                      state.meshes.divisions);
        const std::uint64_t mesh = mesh_checksum(*scene);
        if (state.mesh != 0 && state.mesh != mesh)
          throw BadInput({state_file() + " is of another mesh; run without "
                                         "--restart"});
        // Displacements in the file have the order of one rank, here they get
        // that of these ranks.
        state.mesh      = mesh;
        begun           = state.meshes;
        begun.start     = on_these_ranks(state.meshes.start);
        path.progress   = state.path;
        path.progress.u = on_these_ranks(state.path.u);
        choose_linear_solver(*scene, parameters.solver, choice);
        check_supports_of_method(choice, parameters.solver, *scene);
        // The exact displacement is compared with zero before the solve, so
        // that nothing is lost if it is not finite somewhere.
        error_of(parameters.verification.exact_displacement,
                 *scene,
                 DofVector(scene->problem().unknowns().n_dofs()));
        certification.emplace(parameters.certificate.kind,
                              parameters.accuracy.certified_width,
                              parameters.solver.proof,
                              scene);
        result.times = {{"mesh", scene->mesh_seconds()},
                        {"assembly", scene->assembly_seconds()}};
      }

      /// Locks the directory, removes what an earlier run left and writes the
      /// effective scene. Returns false if it cannot.
      bool
      open_output()
      {
        list_files(*scene);
        try
          {
            // The lock comes before anything is removed: another run may be
            // writing to this directory.
            on_all_ranks(scene->ranks(), [&]() {
              if (is_first_rank())
                lock.emplace(parameters.output.directory);
            });
            remove_files(files, parameters.output.directory);
            if (path.progress.steps.empty())
              path_output->remove_steps();
            // An old state would otherwise be taken up by a later --restart
            // that means this run.
            if (!options.restart)
              remove_files({{"restart.state", {}, {}}},
                           parameters.output.directory);
            written.push_back(
              output_path(parameters.output.directory, "parameters.prm"));
            write_atomically(written.back(), [&](std::ostream &file) {
              file << parameters.effective_scene;
            });
          }
        catch (const std::runtime_error &error)
          {
            if (is_first_rank())
              print_error(error.what());
            return false;
          }
        return true;
      }

      void
      say_problem()
      {
        report_problem(*scene, choice, parameters.solver.bundle.u, record);
        if (n_started_ranks() > 1 && record.has_details())
          record.line("ranks", std::to_string(n_started_ranks()));
        record.print(out);
      }

      /// The minimum, on meshes that are refined if the scene asks for it, or
      /// the states of a load path.
      void
      solve()
      {
        dealii::Timer timer;
        const bool    has_path = !parameters.load_path.factors.empty();
        if (parameters.accuracy.is_adaptive())
          refine();
        else if (!has_path)
          minimise();
        // Refinement has followed the path on its last mesh as well, and only
        // the global branch and the arc are left to do; otherwise the path
        // begins here.
        if (has_path && result.solve.status != SolverStatus::interrupted)
          follow();
        else if (!path.progress.steps.empty())
          {
            result.path         = path.progress.steps;
            result.verification = verify(scene->problem(),
                                         *path.bonds,
                                         scene->law(),
                                         result.solve.u,
                                         result.solve.load_factor);
          }
        result.times.emplace_back("solve", timer.wall_time());
      }

      /// Verification, estimate and certificate.
      void
      check()
      {
        check_result(parameters.verification,
                     parameters.notes,
                     *scene,
                     path.bonds ? *path.bonds : scene->adhesion(),
                     shortfall,
                     result);
        certification->certify(scene, result);
        report_result(*scene, choice, result, record);
        certification->report(record);
      }

      void
      write()
      {
        dealii::Timer timer;
        try
          {
            // The summary comes last and names the cost of all that was written
            // before, so that whoever finds it knows the run to be complete.
            append(write_files(files, parameters.output.directory), written);
            result.times.emplace_back("output", timer.wall_time());
            result.times.emplace_back("total", total.wall_time());
            report_cost(result,
                        choice,
                        -least_of_ranks(-peak_memory()),
                        record);
            const std::string summary =
              output_path(parameters.output.directory, "summary.json");
            record.write(summary);
            written.push_back(summary);
            if (has_state)
              written.push_back(state_file());
          }
        catch (const std::runtime_error &error)
          {
            output_error = error.what();
          }
        report_files(written, record);
        record.print(out);
      }

      /// Says on std::cerr what did not go well.
      ExitCode
      conclude() const
      {
        const bool interrupted = result.solve.minimum.interrupted;
        const auto print       = [](const std::string &message) {
          if (is_first_rank())
            print_error(message);
        };
        // In the order of what the user has to know first: no answer, a search
        // that was cut short, files that are missing.
        if (!result.is_answer())
          print("NOT CONVERGED (" + result.status + "): " + result.message);
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

    private:
      void
      list_files(const Scene<dim> &on_mesh)
      {
        // The files depend on the mesh, whose scene may be replaced by a finer
        // one; so the list is made anew for each.
        files = output_files(parameters.output, on_mesh, result);
        path_output.emplace(parameters.output,
                            on_mesh.problem(),
                            result.path,
                            result.arc);
        append(path_output->files(), files);
        append(certification->files(parameters.output, on_mesh), files);
      }

      std::string
      state_file() const
      {
        return output_path(parameters.output.directory, "restart.state");
      }

      void
      read_state_before()
      {
        if (!std::filesystem::exists(state_file()))
          {
            out << "There is no " << state_file()
                << ": the run starts from the beginning.\n\n";
            return;
          }
        state = read_state<dim>(state_file(), parameters.effective_scene);
        // A path may be continued with other factors than it was begun with, as
        // long as the steps that are done are the same.
        const LoadPathParameters &load_path = parameters.load_path;
        for (unsigned int k = 0; k < state.path.steps.size(); ++k)
          {
            const LoadFactors before = state.path.steps[k].factors();
            if (k == load_path.factors.size() ||
                load_path.at(k).loads != before.loads ||
                load_path.at(k).displacements != before.displacements)
              throw BadInput(
                {state_file() + ": Load path/Factors: step " +
                 std::to_string(k + 1) + " was with " + load_path.name(before) +
                 "; only later steps may differ, or run without --restart"});
          }
      }

      /// A displacement of an earlier run.
      DofVector
      on_these_ranks(const DofVector &u) const
      {
        return u.size() == 0 ?
                 u :
                 from_serial_order(scene->problem().unknowns(), u);
      }

      /// Writes the state for --restart. A run whose state cannot be written
      /// goes on.
      void
      save_state()
      {
        try
          {
            write_state(state, state_file());
            has_state = true;
          }
        catch (const std::runtime_error &error)
          {
            output_error = error.what();
          }
      }

      void
      minimise()
      {
        result.solve =
          Debond::solve(choice,
                        parameters.solver,
                        *scene,
                        log(),
                        options.terminal,
                        begun.start.size() > 0 ? &begun.start : nullptr);
        // A signal leaves the last iterate in the state, from which --restart
        // goes on.
        if (result.solve.u.size() > 0 &&
            (result.solve.status == SolverStatus::interrupted ||
             result.solve.minimum.interrupted))
          {
            state.meshes.start =
              in_serial_order(scene->problem().unknowns(), result.solve.u);
            save_state();
          }
      }

      /// The stream for the iterations; null if there is none.
      std::ostream *
      log() const
      {
        return record.has_details() ? &out : nullptr;
      }

      SolveSettings
      settings() const
      {
        return {choice, parameters.solver, parameters.verification.tolerance};
      }

      void
      refine()
      {
        // Each mesh is reported when it is done, and its state saved before the
        // next one is solved, so that a run that ends there begins again with
        // that mesh.
        AdaptiveObserver<dim> observer;
        observer.level_is_done = [this](const AdaptiveLevel &level) {
          report_level(static_cast<unsigned int>(result.levels.size()),
                       level,
                       record);
          record.print(out);
          result.levels.push_back(level);
        };
        observer.next_mesh_is_made = [this](const AdaptiveProgress &progress,
                                            const Scene<dim>       &next) {
          state.mesh   = mesh_checksum(next);
          state.meshes = progress;
          state.meshes.start =
            in_serial_order(next.problem().unknowns(), progress.start);
          save_state();
          list_files(next);
          path_output->remove_steps();
        };
        observer.step_is_done = [this](const PathProgress<dim> &progress,
                                       const Verification<dim> &verification,
                                       const AdhesionIntegral<dim> &) {
          path_output->add(progress.steps.back(), progress.u, verification);
        };
        // A path that has begun stays on its mesh.
        if (state.has_last_mesh)
          {
            for (const AdaptiveLevel &level : begun.levels)
              observer.level_is_done(level);
            shortfall = state.shortfall;
            return;
          }
        AdaptiveResult<dim> adaptive;
        try
          {
            adaptive = solve_adaptively(settings(),
                                        parameters.accuracy,
                                        certification->goal(),
                                        begun,
                                        observer,
                                        scene);
          }
        catch (const BadInput &)
          {
            // A load that only the finer mesh shows to have no integral is an
            // error of the input. It leaves the directory as it was found, like
            // those that are seen at once.
            if (lock)
              {
                for (const std::string &file : written)
                  std::filesystem::remove(file);
                std::filesystem::remove(state_file());
                lock->withdraw();
              }
            throw;
          }
        result.solve        = std::move(adaptive.solve);
        shortfall           = adaptive.shortfall;
        path                = std::move(adaptive.path);
        path.result         = result.solve;
        state.meshes.levels = result.levels;
        // From here on a restart stays on this mesh.
        state.has_last_mesh = true;
        state.shortfall     = shortfall;
        list_files(*scene);
        // They are of the mesh that was interrupted.
        if (result.solve.status == SolverStatus::interrupted)
          path_output->remove_steps();
      }

      void
      follow()
      {
        if (!path.progress.steps.empty())
          path_output->go_on_after(path.progress.steps);
        path = follow_load_path<dim>(
          parameters.load_path,
          settings(),
          *scene,
          path,
          [this](const PathProgress<dim> &progress,
                 const Verification<dim> &verification,
                 const AdhesionIntegral<dim> &) {
            result.verification = verification;
            path_output->add(progress.steps.back(), progress.u, verification);
            // A step that went wrong is not saved, so that a restart tries it
            // again.
            if (!progress.steps.back().message.empty())
              return;
            state.path = progress;
            state.path.u =
              in_serial_order(scene->problem().unknowns(), progress.u);
            save_state();
          },
          log());
        result.solve = std::move(path.result);
        result.path  = path.progress.steps;
        result.arc   = path.arc;
      }

      const dealii::Timer total;
      const Parameters   &parameters;
      std::ostream       &out;
      const RunOptions    options;

      MethodChoice                      choice;
      Record                            record;
      std::shared_ptr<const Scene<dim>> scene;
      std::optional<Certification<dim>> certification;

      RunState<dim>     state; ///< as it is to be saved
      bool              has_state = false;
      AdaptiveProgress  begun; ///< by an earlier run
      RunResult<dim>    result;
      FollowedPath<dim> path;      ///< begun by an earlier run or refine()
      std::string       shortfall; ///< of refinement

      std::vector<OutputFile>            files;
      std::optional<LoadPathOutput<dim>> path_output;
      std::optional<DirectoryLock>       lock;
      std::vector<std::string>           written;
      std::string                        output_error;
    };
  } // namespace



  template <int dim>
  ExitCode
  run(const Parameters &parameters, std::ostream &out, const RunOptions options)
  {
    SceneRun<dim> scene(parameters, out, options);
    if (!scene.open_output())
      return ExitCode::output_not_saved;
    scene.say_problem();
    scene.solve();
    scene.check();
    scene.write();
    return scene.conclude();
  }



  template decltype(run<2>) run<2>;
  template decltype(run<3>) run<3>;
} // namespace Debond
