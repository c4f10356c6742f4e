// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>
#include <deal.II/base/timer.h>
#include <deal.II/base/utilities.h>

#include <debond/base/atomic_file.h>
#include <debond/base/directory_lock.h>
#include <debond/base/interrupt.h>
#include <debond/check/plausibility.h>
#include <debond/input/expression.h>
#include <debond/output/load_path_output.h>
#include <debond/output/output_files.h>
#include <debond/output/report.h>
#include <debond/output/vtu.h>
#include <debond/program/run.h>
#include <debond/solve/load_path.h>
#include <debond/solve/run_checkpoints.h>
#include <debond/solve/scene_size.h>

#include <filesystem>
#include <iostream>
#include <memory>

namespace Debond
{
  namespace
  {
    std::string
    output_path(const std::string &directory, const std::string &name)
    {
      return (std::filesystem::path(directory) / name).string();
    }



    /// Returns the path.
    std::string
    write_effective_scene(const std::string &scene,
                          const std::string &directory)
    {
      const std::string path = output_path(directory, "parameters.prm");
      write_atomically(path, [&](std::ostream &file) { file << scene; });
      return path;
    }



    /// The difference from the exact displacement, if that is known; then
    /// throws BadInput if it is not finite somewhere.
    template <int dim>
    std::optional<DisplacementError>
    error_of(const std::string            &exact_displacement,
             const Scene<dim>             &scene,
             const dealii::Vector<double> &u)
    {
      if (exact_displacement.empty())
        return {};
      try
        {
          return displacement_error(
            scene.problem(),
            u,
            *make_function<dim>(exact_displacement,
                                scene.parameters().loads.constants));
        }
      catch (const std::invalid_argument &error)
        {
          throw BadInput(
            {scene.parameters().scene +
             ": Verification/Exact displacement: " + error.what()});
        }
    }



    /// Of this process so far, in bytes.
    double
    peak_memory()
    {
      dealii::Utilities::System::MemoryStats memory;
      dealii::Utilities::System::get_memory_stats(memory);
      return 1024. * static_cast<double>(memory.VmHWM);
    }



    using MPI = dealii::Utilities::MPI::MPI_InitFinalize;

    /// MPI for this process alone, if it is needed: Trilinos needs it even in
    /// one process; others need not wait for it.
    std::unique_ptr<MPI>
    initialize_mpi(const MethodChoice &choice)
    {
      static int    argc = 0;
      static char **argv = nullptr;
      if (choice.linear_solver != LinearSolver::multigrid ||
          dealii::Utilities::MPI::job_supports_mpi())
        return nullptr;
      return std::make_unique<MPI>(argc, argv, 1);
    }



    /// What the verification has against the result, or against the first
    /// step of a load path that it has something against; empty if nothing.
    template <int dim>
    std::string
    verification_message(const double tolerance, const RunResult<dim> &result)
    {
      for (const LoadPathStep<dim> &step : result.path)
        if (!step.message.empty())
          return step.message;
      const double error = result.verification.error();
      return error <= tolerance ? "" : verification_failure(error, tolerance);
    }



    /// Success needs the stop criterion and the verification. Where rounding
    /// kept the method from its stop criterion, the verification decides; what
    /// the method left is said in either case.
    template <int dim>
    void
    judge(const std::string &failure,
          const std::string &shortfall,
          RunResult<dim>    &result)
    {
      SolveResult &solve = result.solve;
      if (solve.status == SolverStatus::stagnated && failure.empty())
        {
          solve.status = SolverStatus::success;
          result.notes.push_back(solve.message);
          solve.message.clear();
        }
      else if (solve.status == SolverStatus::stagnated)
        solve.message += " " + failure;

      result.status  = to_string(solve.status);
      result.message = solve.message;
      // The solver is content, but its result is not a solution.
      if (solve.status == SolverStatus::success && !failure.empty())
        {
          result.status  = "not verified";
          result.message = failure;
        }
      else if (solve.status == SolverStatus::success && !shortfall.empty())
        {
          result.status  = "not accurate enough";
          result.message = shortfall;
        }
    }



    template <typename T>
    void
    append(const std::vector<T> &more, std::vector<T> &list)
    {
      list.insert(list.end(), more.begin(), more.end());
    }



    template <int dim>
    void
    estimate(const Scene<dim>            &scene,
             const AdhesionIntegral<dim> &bonds,
             RunResult<dim>              &result)
    {
      try
        {
          result.estimate = estimate_error(scene.problem(),
                                           bonds,
                                           scene.conditions(),
                                           scene.supports(),
                                           scene.loads(),
                                           result.solve.u,
                                           result.solve.functional,
                                           result.solve.load_factor,
                                           &scene.dead_loads(),
                                           scene.piece());
          if (const std::string &reason = result.estimate->outside_calibration;
              !reason.empty())
            result.notes.push_back(
              "the error of the mesh may be from two thirds to three times the "
              "estimate, which was not calibrated for " +
              reason);
        }
      catch (const std::invalid_argument &error)
        {
          result.notes.push_back(
            std::string(
              "the error of the mesh is not known: a load or a bond "
              "is none between the points that the solution needs, ") +
            error.what());
        }
    }



    /// Verifies what the solver found and adds what else is to be said of it.
    /// @p notes: on the scene; @p bonds are as the load path has left them.
    template <int dim>
    void
    check_result(const VerificationParameters   &verification,
                 const std::vector<std::string> &notes,
                 const Scene<dim>               &scene,
                 const AdhesionIntegral<dim>    &bonds,
                 const std::string              &shortfall,
                 RunResult<dim>                 &result)
    {
      result.notes = result.solve.notes;
      append(result.solve.minimum.notes, result.notes);
      append(notes, result.notes);
      append(scene.notes(), result.notes);
      if (result.solve.status == SolverStatus::comes_off && result.path.empty())
        {
          judge("", "", result);
          return;
        }

      dealii::Timer timer;
      // What bonds have left for good only the path knows.
      if (result.path.empty())
        result.verification = verify(scene.problem(),
                                     scene.adhesion(),
                                     scene.law(),
                                     result.solve.u,
                                     result.solve.load_factor);
      result.probes = scene.probes().values(scene.problem(),
                                            result.solve.u,
                                            result.solve.load_factor);
      result.means  = scene.means().values(scene.problem(),
                                          result.solve.u,
                                          result.solve.load_factor);
      result.times.emplace_back("verification", timer.wall_time());
      judge(verification_message(verification.tolerance, result),
            shortfall,
            result);

      // A loop that was interrupted has the solution of the mesh before.
      const bool is_solution =
        result.is_success() || !shortfall.empty() ||
        (result.solve.status == SolverStatus::interrupted &&
         !result.levels.empty());
      if (is_solution)
        {
          timer.restart();
          estimate(scene, bonds, result);
          result.times.emplace_back("error estimate", timer.wall_time());
        }

      result.largest = largest_values(scene.problem(),
                                      result.solve.u,
                                      result.solve.load_factor);
      append(plausibility_notes(
               scene.body().shape(),
               dim,
               scene.problem().unknowns().has_lifting() ||
                 scene.problem().fields().applied_nodal_forces().linfty_norm() >
                   0.,
               result.largest,
               scene.parameters().degree),
             result.notes);
      result.displacement_error =
        error_of(verification.exact_displacement, scene, result.solve.u);
    }



    /// What certifies results of the scene, null if that is not asked for.
    /// Throws BadInput if it cannot be done.
    template <int dim>
    std::unique_ptr<const Certifier>
    make_certifier(
      [[maybe_unused]] const CertificateKind                    kind,
      [[maybe_unused]] const std::shared_ptr<const Scene<dim>> &scene)
    {
      if constexpr (dim == 2)
        if (kind != CertificateKind::none)
          try
            {
              return std::make_unique<const Certifier>(kind, scene);
            }
          catch (const EquilibriumError &error)
            {
              const std::string entry = "Certificate/Kind";
              throw BadInput({scene->parameters().locations.at(entry) + ": " +
                              entry + ": " + error.what()});
            }
      return nullptr;
    }



    /// @p certifier: of the scene as it was before its mesh was refined, if it
    /// was. @p kind is that of a certificate on the last mesh.
    template <int dim>
    void
    certify_result(
      const Certifier                                          &certifier,
      [[maybe_unused]] const CertificateKind                    kind,
      const bool                                                is_refined,
      const BranchAndBoundParameters                           &proof,
      [[maybe_unused]] const std::shared_ptr<const Scene<dim>> &scene,
      RunResult<dim>                                           &result)
    {
      dealii::Timer        timer;
      const InterruptGuard guard;
      const auto           certify = [&](const Certifier &current) {
        if constexpr (dim == 2)
          result.certificate =
            current.certify(*scene, result.solve.u, proof, [&guard]() {
              return !guard.requested();
            });
        if (guard.requested())
          result.solve.minimum.interrupted = true;
      };
      try
        {
          if constexpr (dim == 2)
            {
              if (is_refined && !certifier.is_for_finer_meshes())
                certify(Certifier(kind, scene));
              else
                certify(certifier);
            }
        }
      catch (const EquilibriumError &error)
        {
          result.notes.push_back(std::string("There is no certificate: ") +
                                 error.what() + ".");
        }
      result.times.emplace_back("certificate", timer.wall_time());
    }



    /// Removes the checkpoint of a success; otherwise adds it to the files that
    /// are @p written. Returns what kept it from being written.
    template <int dim>
    std::string
    finish_checkpoints(const RunCheckpoints     &checkpoints,
                       RunResult<dim>           &result,
                       std::vector<std::string> &written)
    {
      if (result.is_success())
        {
          checkpoints.remove();
          return "";
        }
      if (checkpoints.written())
        {
          written.push_back(checkpoints.file_name());
          result.message += " The run goes on with --restart.";
        }
      return checkpoints.error();
    }



    template <int dim>
    ExitCode
    conclude(const RunResult<dim> &result, const std::string &output_error)
    {
      const bool interrupted = result.solve.minimum.interrupted;
      if (!result.is_answer())
        std::cerr << "debond: NOT CONVERGED (" << result.status
                  << "): " << result.message << std::endl;
      else if (interrupted)
        std::cerr
          << "debond: the search or the proof was interrupted; the result "
             "is what it had found"
          << std::endl;
      if (!output_error.empty())
        {
          std::cerr << "debond: " << output_error << std::endl;
          return ExitCode::output_not_saved;
        }
      if (result.solve.status == SolverStatus::interrupted ||
          (result.is_success() && interrupted))
        return ExitCode::interrupted;
      return result.is_answer() ? ExitCode::success : ExitCode::not_converged;
    }



    bool
    first_of(const MPI_Comm ranks)
    {
      return dealii::Utilities::MPI::this_mpi_process(ranks) == 0;
    }



    /// Throws BadInput if ranks cannot share the scene.
    template <int dim>
    std::shared_ptr<const BoxPiece<dim>>
    make_piece(const Parameters &parameters, const MPI_Comm ranks)
    {
      const auto refuse = [&parameters](const bool         is_refused,
                                        const std::string &entry,
                                        const std::string &what) {
        if (is_refused)
          throw BadInput({parameters.scene + ": " + entry + ": " + what +
                          "; run the scene on one rank"});
      };
      const SolverParameters &solver = parameters.solver;
      const auto *const       box =
        dynamic_cast<const Box<dim> *>(parameters.body.get());
      refuse(box == nullptr && parameters.body->shape().is_box,
             "Parts",
             "several ranks share no bodies with parts");
      refuse(box == nullptr, "Mesh/Source", "several ranks share boxes only");
      refuse(parameters.degree != 1,
             "Mesh/Degree",
             "several ranks share linear displacements only");
      refuse(solver.method != SolverMethod::automatic &&
               solver.method != SolverMethod::majorise_minimise,
             "Solver/Method",
             "several ranks need majorise minimise or automatic, not " +
               solver.method);
      refuse(solver.linear_solver == LinearSolver::direct,
             "Solver/Linear solver",
             "several ranks have multigrid only");
      refuse(solver.prove, "Solver/Prove", "several ranks have no proof");
      refuse(!parameters.load_path.factors.empty(),
             "Load path/Factors",
             "several ranks follow no load path");
      refuse(parameters.accuracy.is_adaptive(),
             parameters.accuracy.target > 0. ? "Accuracy/Target" :
                                               "Accuracy/Maximum unknowns",
             "several ranks refine no mesh");
      refuse(parameters.certificate.kind != CertificateKind::none,
             "Certificate/Kind",
             "several ranks have no certificate");
      refuse(!parameters.probes.empty(),
             parameters.probes.empty() ?
               "" :
               "Probes/" + parameters.probes.begin()->first,
             "several ranks have no probes");
      refuse(!parameters.supports.displacements.empty(),
             parameters.supports.displacements.empty() ?
               "" :
               "Boundary conditions/Displacement " +
                 parameters.supports.displacements.begin()->first,
             "several ranks share no prescribed displacements");
      refuse(!parameters.supports.gap.empty() ||
               !parameters.supports.gaps.empty(),
             "Contact law/Initial gap",
             "several ranks share no gaps");
      refuse(!parameters.verification.exact_displacement.empty(),
             "Verification/Exact displacement",
             "several ranks compare no displacements");
      refuse(parameters.checkpoints.restart,
             "--restart",
             "several ranks have no checkpoints");
      refuse(!box->has_coarse_levels(),
             "Mesh/Cells",
             "several ranks need coarser levels, and this box has none");
      try
        {
          return std::make_shared<const BoxPiece<dim>>(
            *box,
            dealii::Utilities::MPI::this_mpi_process(ranks),
            dealii::Utilities::MPI::n_mpi_processes(ranks));
        }
      catch (const std::invalid_argument &error)
        {
          const bool is_too_short = dealii::Utilities::MPI::n_mpi_processes(
                                      ranks) > box->shape().cells[0];
          throw BadInput({parameters.scene + ": " +
                          (is_too_short ? "Mesh/Cells" : "Mesh/Rotation") +
                          ": " + error.what()});
        }
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
    MethodChoice choice = choose_method(parameters, solver, accuracy);
    const std::unique_ptr<MPI>        mpi   = initialize_mpi(choice);
    std::shared_ptr<const Scene<dim>> scene = make_first_scene<dim>(
      parameters, accuracy, matrix_storage(choice), parameters.start_file());
    check_supports_of_method(choice, solver, *scene);
    // Before the solve, so that nothing is lost if it is not finite somewhere.
    error_of(parameters.verification.exact_displacement,
             *scene,
             dealii::Vector<double>(scene->problem().unknowns().n_dofs()));
    const std::unique_ptr<const Certifier> certifier =
      make_certifier(certificate, scene);
    RunCheckpoints checkpoints(parameters.checkpoints,
                               output.directory,
                               choice);

    RunResult<dim>          result;
    std::string             no_pictures;
    std::vector<OutputFile> files =
      output_files(output, *scene, result, no_pictures);
    std::optional<LoadPathOutput<dim>> path_output;
    const auto                         add_path_output = [&]() {
      path_output.emplace(
        output, scene->problem(), result.path, result.arc, no_pictures);
      append(path_output->files(), files);
    };
    add_path_output();
    std::optional<DirectoryLock> lock;
    std::vector<std::string>     written;
    try
      {
        lock.emplace(output.directory);
        remove_files(files, output.directory);
        path_output->remove_steps();
        written.push_back(
          write_effective_scene(parameters.effective_scene, output.directory));
      }
    catch (const std::runtime_error &error)
      {
        std::cerr << "debond: " << error.what() << std::endl;
        return ExitCode::output_not_saved;
      }

    Record record(output.machine_details);
    report_problem(*scene, choice, solver.bundle.u, record);
    report_checkpoints(checkpoints, record);
    record.print(out);

    result.times = {{"mesh", scene->mesh_seconds()},
                    {"assembly", scene->assembly_seconds()}};
    dealii::Timer     timer;
    std::string       shortfall;
    FollowedPath<dim> path;
    if (accuracy.is_adaptive())
      {
        const auto report = [&](const AdaptiveLevel &level) {
          report_level(static_cast<unsigned int>(result.levels.size()),
                       level,
                       record);
          record.print(out);
          result.levels.push_back(level);
        };
        AdaptiveResult adaptive;
        try
          {
            adaptive = solve_adaptively(choice,
                                        solver,
                                        accuracy,
                                        certificate,
                                        parameters.verification.tolerance,
                                        report,
                                        scene,
                                        &path);
          }
        catch (const BadInput &)
          {
            // A load that only the finer mesh shows to have no integral.
            for (const std::string &file : written)
              std::filesystem::remove(file);
            lock->withdraw();
            throw;
          }
        result.solve       = std::move(adaptive.solve);
        shortfall          = adaptive.shortfall;
        result.certificate = std::move(adaptive.certificate);
        // On the last mesh.
        choice.memory =
          memory_with_factorisation(scene_size(scene->body(),
                                               dim,
                                               parameters.contact_boundaries,
                                               parameters.degree),
                                    dim);
        files = output_files(output, *scene, result, no_pictures);
        add_path_output();
      }
    else if (load_path.factors.empty())
      result.solve = solve(choice,
                           solver,
                           *scene,
                           record.has_details() ? &out : nullptr,
                           terminal,
                           &checkpoints);
    // On a refined mesh the states are computed again, now with all that is
    // written of them.
    if (!load_path.factors.empty() &&
        result.solve.status != SolverStatus::interrupted)
      result.solve = follow_load_path<dim>(
        load_path,
        solver,
        parameters.verification.tolerance,
        *scene,
        [&](const LoadPathStep<dim>      &step,
            const dealii::Vector<double> &u,
            const Verification<dim>      &verification,
            const AdhesionIntegral<dim>  &bonds) {
          result.verification = verification;
          path.bonds = std::make_shared<const AdhesionIntegral<dim>>(bonds);
          path_output->add(step, u, verification);
        },
        record.has_details() ? &out : nullptr,
        result.path,
        result.arc);
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
    if (certifier && result.is_success() && !result.certificate)
      certify_result(*certifier,
                     certificate,
                     accuracy.is_adaptive(),
                     solver.proof,
                     scene,
                     result);
    std::string output_error = finish_checkpoints(checkpoints, result, written);
    report_result(*scene, choice, result, record);

    timer.restart();
    try
      {
        append(write_files(files, output.directory), written);
        result.times.emplace_back("output", timer.wall_time());
        result.times.emplace_back("total", total.wall_time());
        report_cost(result, choice, peak_memory(), record);
        const std::string summary =
          output_path(output.directory, "summary.json");
        record.write(summary);
        written.push_back(summary);
      }
    catch (const std::runtime_error &error)
      {
        output_error = error.what();
      }
    report_files(written, no_pictures, record);
    record.print(out);
    return conclude(result, output_error);
  }



  template <int dim>
  ExitCode
  run_on_ranks(const Parameters &parameters,
               const MPI_Comm    ranks,
               std::ostream     &out,
               const bool        terminal)
  {
    dealii::Timer    total;
    const bool       is_first      = first_of(ranks);
    const auto       piece         = make_piece<dim>(parameters, ranks);
    SolverParameters solver        = parameters.solver;
    solver.linear_solver           = LinearSolver::multigrid;
    const OutputParameters &output = parameters.output;
    const MethodChoice      choice = choose_method(parameters, solver);
    const Scene<dim>        scene(parameters, piece, ranks);

    RunResult<dim>                result;
    std::string                   no_pictures, failure;
    const std::vector<OutputFile> files =
      output_files(output, scene, result, no_pictures);
    std::optional<DirectoryLock> lock;
    std::vector<std::string>     written;
    if (is_first)
      try
        {
          lock.emplace(output.directory);
          remove_files(files, output.directory);
          written.push_back(write_effective_scene(parameters.effective_scene,
                                                  output.directory));
        }
      catch (const std::runtime_error &error)
        {
          failure = error.what();
        }
    failure = dealii::Utilities::MPI::broadcast(ranks, failure);
    if (!failure.empty())
      {
        if (is_first)
          std::cerr << "debond: " << failure << std::endl;
        return ExitCode::output_not_saved;
      }

    Record record(output.machine_details);
    report_problem(scene, choice, solver.bundle.u, record);
    if (record.has_details())
      record.line("ranks",
                  std::to_string(
                    dealii::Utilities::MPI::n_mpi_processes(ranks)));
    record.print(out);

    result.times = {{"mesh", scene.mesh_seconds()},
                    {"assembly", scene.assembly_seconds()}};
    dealii::Timer timer;
    result.solve = solve(
      choice, solver, scene, record.has_details() ? &out : nullptr, terminal);
    result.times.emplace_back("solve", timer.wall_time());

    timer.restart();
    result.verification = verify(scene.problem(),
                                 scene.adhesion(),
                                 scene.law(),
                                 result.solve.u,
                                 result.solve.load_factor,
                                 1e-6,
                                 scene.piece());
    result.largest      = largest_values(scene.problem(), result.solve.u, 1.);
    for (double *const value : {&result.largest.displacement,
                                &result.largest.gradient,
                                &result.largest.von_mises})
      *value = dealii::Utilities::MPI::max(*value, ranks);
    const double largest_force = scene.piece()->nodes().largest(
      scene.problem().fields().applied_nodal_forces().begin());
    result.means = scene.means().values(scene.problem(),
                                        result.solve.u,
                                        result.solve.load_factor,
                                        scene.piece());
    result.times.emplace_back("verification", timer.wall_time());
    result.notes = result.solve.notes;
    append(result.solve.minimum.notes, result.notes);
    append(parameters.notes, result.notes);
    judge(verification_message(parameters.verification.tolerance, result),
          "",
          result);
    if (dealii::Utilities::MPI::broadcast(ranks, result.is_success()))
      {
        timer.restart();
        estimate(scene, scene.adhesion(), result);
        result.times.emplace_back("error estimate", timer.wall_time());
      }
    append(plausibility_notes(scene.body().shape(),
                              dim,
                              largest_force > 0.,
                              result.largest,
                              parameters.degree),
           result.notes);

    timer.restart();
    try
      {
        if (output.body_vtu)
          append(write_body_pieces(scene.problem(),
                                   *scene.piece(),
                                   result.solve.u,
                                   result.estimate ? &*result.estimate :
                                                     nullptr,
                                   output.directory),
                 written);
      }
    catch (const std::runtime_error &error)
      {
        failure = error.what();
      }
    result.solve.u      = scene.piece()->gather(result.solve.u);
    const double memory = dealii::Utilities::MPI::max(peak_memory(), ranks);
    ExitCode     code   = ExitCode::success;
    const auto   all_failures =
      dealii::Utilities::MPI::all_gather(ranks, failure);
    if (is_first)
      {
        for (const std::string &other : all_failures)
          if (failure.empty())
            failure = other;
        report_result(scene, choice, result, record);
        try
          {
            append(write_files(files, output.directory), written);
            result.times.emplace_back("output", timer.wall_time());
            result.times.emplace_back("total", total.wall_time());
            report_cost(result, choice, memory, record);
            const std::string summary =
              output_path(output.directory, "summary.json");
            record.write(summary);
            written.push_back(summary);
          }
        catch (const std::runtime_error &error)
          {
            failure = error.what();
          }
        report_files(written, no_pictures, record);
        record.print(out);
        code = conclude(result, failure);
      }
    return static_cast<ExitCode>(
      dealii::Utilities::MPI::broadcast(ranks, static_cast<int>(code)));
  }



  template ExitCode
  run<2>(const Parameters &, std::ostream &, const bool);
  template ExitCode
  run<3>(const Parameters &, std::ostream &, const bool);
  template ExitCode
  run_on_ranks<2>(const Parameters &,
                  const MPI_Comm,
                  std::ostream &,
                  const bool);
  template ExitCode
  run_on_ranks<3>(const Parameters &,
                  const MPI_Comm,
                  std::ostream &,
                  const bool);
} // namespace Debond
