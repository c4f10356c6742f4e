// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/append.h>
#include <debond/base/atomic_file.h>
#include <debond/base/directory_lock.h>
#include <debond/base/memory.h>
#include <debond/base/processes.h>
#include <debond/base/ranks.h>
#include <debond/base/text.h>
#include <debond/input/bad_input.h>
#include <debond/output/load_path_output.h>
#include <debond/output/output_files.h>
#include <debond/output/report.h>
#include <debond/program/check_result.h>
#include <debond/program/run.h>
#include <debond/solve/load_path.h>

#include <filesystem>
#include <memory>
#include <optional>

namespace Debond
{
  std::string
  output_path(const std::string &directory, const std::string &name)
  {
    return (std::filesystem::path(directory) / name).string();
  }



  std::string
  write_effective_scene(const std::string &scene, const std::string &directory)
  {
    const std::string path = output_path(directory, "parameters.prm");
    write_atomically(path, [&](std::ostream &file) { file << scene; });
    return path;
  }



  template <int dim>
  ExitCode
  conclude(const RunResult<dim> &result, const std::string &output_error)
  {
    const bool interrupted = result.solve.minimum.interrupted;
    const auto print       = [](const std::string &message) {
      if (is_first_rank())
        print_error(message);
    };
    if (!result.is_answer())
      print("NOT CONVERGED (" + result.status + "): " + result.message);
    else if (interrupted)
      print(
        "the search or the proof was interrupted; the result is what it had "
        "found");
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



  namespace
  {
    void
    refuse_certificates_of_ranks(const Parameters &parameters)
    {
      const std::string entry = "Certificate/Kind";
      if (n_started_ranks() > 1 &&
          parameters.certificate.kind != CertificateKind::none)
        throw BadInput({parameters.locations.at(entry) + ": " + entry +
                        ": several ranks have no certificate; run the scene on "
                        "one rank"});
    }
  } // namespace



  template <int dim>
  ExitCode
  run(const Parameters &parameters, std::ostream &out, const bool terminal)
  {
    dealii::Timer             total;
    const SolverParameters   &solver      = parameters.solver;
    const LoadPathParameters &load_path   = parameters.load_path;
    const CertificateKind     certificate = parameters.certificate.kind;
    const OutputParameters   &output      = parameters.output;
    const AccuracyParameters &accuracy    = parameters.accuracy;
    MethodChoice              choice      = choose_method(parameters, solver);
    refuse_certificates_of_ranks(parameters);
    std::shared_ptr<const Scene<dim>> scene =
      make_first_scene<dim>(parameters, accuracy, parameters.solver.start);
    choose_linear_solver(*scene, solver, choice);
    check_supports_of_method(choice, solver, *scene);
    // Before the solve, so that nothing is lost if it is not finite somewhere.
    error_of(parameters.verification.exact_displacement,
             *scene,
             DofVector(scene->problem().unknowns().n_dofs()));
    const std::unique_ptr<const Certifier<dim>> certifier =
      make_certifier(certificate, scene);

    RunResult<dim>          result;
    std::vector<OutputFile> files = output_files(output, *scene, result);
    std::optional<LoadPathOutput<dim>> path_output;
    const auto                         add_path_output = [&]() {
      path_output.emplace(output, scene->problem(), result.path, result.arc);
      append(path_output->files(), files);
    };
    add_path_output();
    std::optional<DirectoryLock> lock;
    std::vector<std::string>     written;
    try
      {
        on_all_ranks(scene->ranks(), [&]() {
          if (is_first_rank())
            lock.emplace(output.directory);
        });
        remove_files(files, output.directory);
        path_output->remove_steps();
        written.push_back(
          write_effective_scene(parameters.effective_scene, output.directory));
      }
    catch (const std::runtime_error &error)
      {
        if (is_first_rank())
          print_error(error.what());
        return ExitCode::output_not_saved;
      }

    Record record(output.machine_details);
    report_problem(*scene, choice, solver.bundle.u, record);
    if (n_started_ranks() > 1 && record.has_details())
      record.line("ranks", std::to_string(n_started_ranks()));
    record.print(out);

    result.times = {{"mesh", scene->mesh_seconds()},
                    {"assembly", scene->assembly_seconds()}};
    dealii::Timer       timer;
    std::string         shortfall;
    FollowedPath<dim>   path;
    const SolveSettings settings = {choice,
                                    solver,
                                    parameters.verification.tolerance};
    if (accuracy.is_adaptive())
      {
        const auto report = [&](const AdaptiveLevel &level) {
          report_level(static_cast<unsigned int>(result.levels.size()),
                       level,
                       record);
          record.print(out);
          result.levels.push_back(level);
        };
        AdaptiveResult<dim> adaptive;
        try
          {
            adaptive =
              solve_adaptively(settings, accuracy, certificate, report, scene);
          }
        catch (const BadInput &)
          {
            // A load that only the finer mesh shows to have no integral.
            if (lock)
              {
                for (const std::string &file : written)
                  std::filesystem::remove(file);
                lock->withdraw();
              }
            throw;
          }
        result.solve       = std::move(adaptive.solve);
        shortfall          = adaptive.shortfall;
        result.certificate = std::move(adaptive.certificate);
        path               = std::move(adaptive.path);
        files              = output_files(output, *scene, result);
        add_path_output();
      }
    else if (load_path.factors.empty())
      result.solve = solve(choice,
                           solver,
                           *scene,
                           record.has_details() ? &out : nullptr,
                           terminal);
    // On a refined mesh the states are computed again, now with all that is
    // written of them.
    if (!load_path.factors.empty() &&
        result.solve.status != SolverStatus::interrupted)
      {
        path = follow_load_path<dim>(
          load_path,
          settings,
          *scene,
          [&](const LoadPathStep<dim> &step,
              const DofVector         &u,
              const Verification<dim> &verification,
              const AdhesionIntegral<dim> &) {
            result.verification = verification;
            path_output->add(step, u, verification);
          },
          record.has_details() ? &out : nullptr);
        result.solve = std::move(path.result);
        result.path  = path.steps;
        result.arc   = path.arc;
      }
    else if (!path.steps.empty())
      {
        result.path         = path.steps;
        result.verification = verify(scene->problem(),
                                     *path.bonds,
                                     scene->law(),
                                     result.solve.u,
                                     result.solve.load_factor);
      }
    result.times.emplace_back("solve", timer.wall_time());
    check_result(parameters.verification,
                 parameters.notes,
                 *scene,
                 path.bonds ? *path.bonds : scene->adhesion(),
                 shortfall,
                 result);
    if (certificate != CertificateKind::none && result.is_success() &&
        !result.certificate)
      certify_result(certifier.get(),
                     certificate,
                     accuracy.is_adaptive(),
                     solver.proof,
                     scene,
                     result);
    report_result(*scene, choice, result, record);

    std::string output_error;
    timer.restart();
    try
      {
        append(write_files(files, output.directory), written);
        result.times.emplace_back("output", timer.wall_time());
        result.times.emplace_back("total", total.wall_time());
        report_cost(result, choice, -least_of_ranks(-peak_memory()), record);
        const std::string summary =
          output_path(output.directory, "summary.json");
        record.write(summary);
        written.push_back(summary);
      }
    catch (const std::runtime_error &error)
      {
        output_error = error.what();
      }
    report_files(written, record);
    record.print(out);
    return conclude(result, output_error);
  }



  template decltype(run<2>)      run<2>;
  template decltype(run<3>)      run<3>;
  template decltype(conclude<2>) conclude<2>;
  template decltype(conclude<3>) conclude<3>;
} // namespace Debond
