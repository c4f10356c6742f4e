// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>
#include <deal.II/base/timer.h>
#include <deal.II/base/utilities.h>

#include <debond/base/atomic_file.h>
#include <debond/base/directory_lock.h>
#include <debond/base/version.h>
#include <debond/check/plausibility.h>
#include <debond/input/expression.h>
#include <debond/output/load_path_output.h>
#include <debond/output/proof_plots.h>
#include <debond/output/report.h>
#include <debond/output/tables.h>
#include <debond/output/vtu.h>
#include <debond/program/run.h>
#include <debond/solve/displacement.h>
#include <debond/solve/load_path.h>
#include <debond/solve/run_checkpoints.h>
#include <debond/solve/solve.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>

namespace Debond
{
  namespace
  {
    /// Empties the directory and writes the effective parameters into it.
    /// Throws std::runtime_error naming what cannot be written.
    std::string
    open_output(const Parameters &parameters)
    {
      const std::filesystem::path directory = parameters.output.directory;
      std::error_code             error;

      // What an earlier run left must not stand beside the new results.
      for (const char *name : {"body.vtu",
                               "contact.vtu",
                               "contact_profile.csv",
                               "history.csv",
                               "proof.csv",
                               "proof_time.dat",
                               "proof_time.gp",
                               "proof_time.png",
                               "proof_time.svg",
                               "proof_nodes.dat",
                               "proof_nodes.gp",
                               "proof_nodes.png",
                               "proof_nodes.svg",
                               "displacement.txt",
                               "summary.json"})
        if (std::filesystem::is_regular_file(directory / name, error))
          std::filesystem::remove(directory / name, error);

      const std::string file_name = (directory / "parameters.prm").string();
      write_atomically(file_name, [&](std::ostream &file) {
        file << parameters.effective_scene;
      });
      return file_name;
    }



    template <int dim>
    Summary
    summarize_problem(const Parameters &parameters, const Scene<dim> &scene)
    {
      Summary summary;
      summary.scene              = parameters.scene;
      summary.dimension          = dim;
      summary.cells              = scene.n_cells();
      summary.degrees_of_freedom = scene.problem().unknowns().n_free_dofs();
      summary.contact_nodes      = scene.problem().unknowns().contact().size();
      // The paper counts the tangential displacements of the contact nodes,
      // although they are fixed: 710 on its mesh 40x4.
      summary.degrees_of_freedom_paper =
        summary.degrees_of_freedom + (parameters.tangential_displacement_fixed ?
                                        (dim - 1) * summary.contact_nodes :
                                        0);
      summary.timings_s["mesh"]     = scene.mesh_seconds();
      summary.timings_s["assembly"] = scene.assembly_seconds();
      summary.revision              = git_revision();
      summary.deal_ii_version       = deal_ii_version();
      summary.build_type            = build_type();
      return summary;
    }



    void
    add_result(const SolveResult &result, Summary &summary)
    {
      summary.status                = to_string(result.status);
      summary.message               = result.message;
      summary.notes                 = result.notes;
      summary.functional            = result.functional;
      summary.functional_from_start = result.functional_from_start;
      summary.is_replaced           = result.is_replaced;
      summary.notes.insert(summary.notes.end(),
                           result.minimum.notes.begin(),
                           result.minimum.notes.end());
      if (result.status == SolverStatus::success)
        summary.minimum = to_string(result.minimum.kind);
      summary.search_trials       = result.minimum.search_trials;
      summary.search_improvements = result.minimum.search_improvements;
      summary.search_failures     = result.minimum.search_failures;
      summary.search_nodes        = result.minimum.search_nodes;
      summary.closed_nodes        = result.minimum.closed_nodes;
      if (result.minimum.proof_attempted)
        summary.proof = to_string(result.minimum.proof_status);
      summary.proof_nodes         = result.minimum.proof_nodes;
      summary.lower_bound         = result.minimum.lower_bound;
      summary.relative_gap        = result.minimum.relative_gap;
      summary.total_iterations    = result.iterations;
      summary.long_steps          = result.long_steps;
      summary.short_steps         = result.short_steps;
      summary.null_steps          = result.null_steps;
      summary.stop_criterion      = result.criterion;
      summary.largest_qp_residual = result.largest_qp_residual;
      summary.linear_iterations   = result.linear_iterations;
      summary.condition_estimate  = result.condition_estimate;
      for (const auto &[part, seconds] : result.parts)
        summary.timings_s["solve/" + part] = seconds;
    }



    template <int dim>
    void
    add_verification(const Verification<dim> &verification, Summary &summary)
    {
      summary.law_violation        = verification.law_violation;
      summary.penetration          = verification.penetration;
      summary.equilibrium_residual = verification.equilibrium_residual;
      summary.force_imbalance      = verification.force_imbalance;
      const auto components        = [](const dealii::Tensor<1, dim> &force) {
        return std::vector<double>(force.begin_raw(), force.end_raw());
      };
      summary.applied_force    = components(verification.applied_force);
      summary.clamped_reaction = components(verification.clamped_reaction);
      summary.contact_reaction = components(verification.contact_reaction);
      summary.tangential_reaction =
        components(verification.tangential_reaction);
      for (unsigned int k = 0; k < verification.state_names.size(); ++k)
        if (const auto state = static_cast<BondState>(k);
            state != BondState::held)
          summary.bond_states[verification.name(state)] =
            verification.count(state);
    }



    /// Throws BadInput if the exact displacement is not finite somewhere.
    template <int dim>
    DisplacementError
    error_of(const Parameters             &parameters,
             const ElasticProblem<dim>    &problem,
             const dealii::Vector<double> &u)
    {
      try
        {
          return displacement_error(
            problem,
            u,
            *make_function<dim>(parameters.exact_displacement,
                                parameters.loads.constants));
        }
      catch (const std::invalid_argument &error)
        {
          throw BadInput(
            {parameters.scene +
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



    /// MPI for this process alone.
    std::unique_ptr<dealii::Utilities::MPI::MPI_InitFinalize>
    initialize_mpi()
    {
      static int    argc = 0;
      static char **argv = nullptr;
      return std::make_unique<dealii::Utilities::MPI::MPI_InitFinalize>(argc,
                                                                        argv,
                                                                        1);
    }



    /// Where rounding kept the method from its stop criterion, the verification
    /// decides; what the method left is said in either case.
    void
    judge_stagnation(const std::string &failure, SolveResult &result)
    {
      if (result.status != SolverStatus::stagnated)
        return;
      if (failure.empty())
        {
          result.status = SolverStatus::success;
          result.notes.push_back(result.message);
          result.message.clear();
        }
      else
        result.message += " " + failure;
    }



    /// The solver is content, but its result is not a solution.
    void
    reject_result(const std::string &message, Summary &summary)
    {
      summary.status = "not verified";
      summary.minimum.clear();
      summary.message = message;
    }



    /// What the verification has against the result, or against the first
    /// step of a load path that it has something against; empty if nothing.
    template <int dim>
    std::string
    verification_message(const Parameters                     &parameters,
                         const Verification<dim>              &verification,
                         const std::vector<LoadPathStep<dim>> &path)
    {
      for (const LoadPathStep<dim> &step : path)
        if (!step.message.empty())
          return step.message;
      return verification.error() <= parameters.verification_tolerance ?
               "" :
               verification_failure(verification.error(),
                                    parameters.verification_tolerance);
    }



    /// Writes what the scene asks for, and returns the names of the files. The
    /// note says why there are no pictures.
    template <int dim>
    std::vector<std::string>
    write_fields(const Parameters        &parameters,
                 const Scene<dim>        &scene,
                 const Verification<dim> &verification,
                 const SolveResult       &result,
                 std::string             &note)
    {
      const OutputParameters &output = parameters.output;
      const auto              path   = [&output](const std::string &name) {
        return (std::filesystem::path(output.directory) / name).string();
      };
      std::vector<std::string> files;
      if (output.body_vtu)
        {
          files.push_back(path("body.vtu"));
          write_body_vtu(scene.problem(), result.u, files.back());
        }
      if (output.contact_vtu)
        {
          files.push_back(path("contact.vtu"));
          write_contact_vtu(scene.problem(),
                            result.u,
                            verification,
                            files.back());
        }
      if (output.contact_profile)
        {
          files.push_back(path("contact_profile.csv"));
          write_contact_profile(scene.problem().unknowns().contact().boundary(),
                                verification,
                                files.back());
        }
      if (output.history)
        {
          files.push_back(path("history.csv"));
          const std::optional<double> found =
            result.is_replaced ? std::make_optional(result.functional) :
                                 std::nullopt;
          if (result.majorise_history.empty())
            write_history(result.bundle_history, found, files.back());
          else
            write_history(result.majorise_history, found, files.back());
        }
      if (output.displacement)
        {
          files.push_back(path("displacement.txt"));
          write_displacement(result.u, files.back());
        }
      if (output.history && !result.minimum.proof_history.empty())
        {
          files.push_back(path("proof.csv"));
          write_history(result.minimum.proof_history, files.back());
          for (const Plot &plot : proof_plots(result.minimum.proof_history))
            {
              write_gnuplot(plot, output.directory);
              for (const char *ending : {".dat", ".gp"})
                files.push_back(path(plot.name + ending));
              note = run_gnuplot(plot, output.directory);
              if (note.empty())
                for (const char *ending : {".png", ".svg"})
                  files.push_back(path(plot.name + ending));
            }
        }
      return files;
    }



    ExitCode
    exit_code(const SolveResult &result)
    {
      switch (result.status)
        {
          case SolverStatus::success:
            return result.minimum.interrupted ? ExitCode::interrupted :
                                                ExitCode::success;
          case SolverStatus::interrupted:
            return ExitCode::interrupted;
          default:
            return ExitCode::not_converged;
        }
    }
  } // namespace



  template <int dim>
  ExitCode
  run(const Parameters &parameters, std::ostream &out, const bool terminal)
  {
    dealii::Timer total;

    const MethodChoice choice = choose_method(parameters);
    // Trilinos needs MPI, even in one process; others need not wait for it.
    std::unique_ptr<dealii::Utilities::MPI::MPI_InitFinalize> mpi;
    if (choice.linear_solver == LinearSolver::multigrid &&
        !dealii::Utilities::MPI::job_supports_mpi())
      mpi = initialize_mpi();
    const Scene<dim> scene(parameters, matrix_storage(choice));

    // Before the solve, so that nothing is lost if it is not finite somewhere.
    if (!parameters.exact_displacement.empty())
      error_of(parameters,
               scene.problem(),
               dealii::Vector<double>(scene.problem().unknowns().n_dofs()));

    RunCheckpoints               checkpoints(parameters, choice);
    std::optional<DirectoryLock> lock;
    std::vector<std::string>     files;
    try
      {
        lock.emplace(parameters.output.directory);
        files.push_back(open_output(parameters));
      }
    catch (const std::runtime_error &error)
      {
        std::cerr << "debond: " << error.what() << std::endl;
        return ExitCode::output_not_saved;
      }

    Summary summary         = summarize_problem(parameters, scene);
    summary.method          = choice.method;
    summary.linear_solver   = choice.linear_solver;
    summary.memory_estimate = choice.memory;
    report_problem(parameters, summary, choice.reason, out);
    if (parameters.output.machine_details && !checkpoints.description().empty())
      out << "Checkpoints\n  " << checkpoints.description() << std::endl;

    dealii::Timer       timer;
    LoadPathOutput<dim> path_output(parameters.output, scene.problem());
    std::vector<LoadPathStep<dim>> path;
    const bool  has_path = !parameters.load_path.factors.empty();
    SolveResult result =
      has_path ? follow_load_path<dim>(
                   parameters,
                   scene,
                   [&](const auto &...step) { path_output.add(step...); },
                   out,
                   path) :
                 solve(choice, parameters, scene, out, terminal, &checkpoints);
    summary.timings_s["solve"] = timer.wall_time();

    timer.restart();
    const Verification<dim> verification = verify(scene.problem(),
                                                  scene.adhesion(),
                                                  scene.law(),
                                                  result.u,
                                                  result.load_factor);
    summary.timings_s["verification"]    = timer.wall_time();
    const std::string failure =
      verification_message(parameters, verification, path);
    judge_stagnation(failure, result);
    add_result(result, summary);
    add_verification(verification, summary);
    summary.largest = largest_values(scene.problem(), result.u);
    for (const std::string &note : plausibility_notes(
           scene.body().shape(),
           dim,
           scene.problem().fields().applied_nodal_forces().linfty_norm() > 0.,
           summary.largest))
      summary.notes.push_back(note);
    if (!parameters.exact_displacement.empty())
      summary.displacement_error =
        error_of(parameters, scene.problem(), result.u);
    if (result.status == SolverStatus::success && !failure.empty())
      reject_result(failure, summary);
    if (has_path)
      summary.load_path = load_path_totals(
        path, static_cast<unsigned int>(parameters.load_path.factors.size()));

    std::string output_error, plot_note;
    if (result.status == SolverStatus::success && failure.empty())
      checkpoints.remove();
    else
      {
        output_error = checkpoints.error();
        if (checkpoints.written())
          {
            files.push_back(checkpoints.file_name());
            summary.message += " The run goes on with --restart.";
          }
      }
    timer.restart();
    try
      {
        const std::vector<std::string> fields =
          write_fields(parameters, scene, verification, result, plot_note);
        files.insert(files.end(), fields.begin(), fields.end());
        if (has_path)
          {
            const std::vector<std::string> path_files =
              path_output.finish(path, plot_note);
            files.insert(files.end(), path_files.begin(), path_files.end());
          }
        summary.timings_s["output"] = timer.wall_time();
        summary.peak_memory         = peak_memory();
        summary.timings_s["total"]  = total.wall_time();
        const std::string name =
          (std::filesystem::path(parameters.output.directory) / "summary.json")
            .string();
        write_summary(summary, name);
        files.push_back(name);
      }
    catch (const std::runtime_error &error)
      {
        output_error = error.what();
      }

    report_result(parameters, summary, verification, out);
    if (parameters.output.machine_details)
      report_files(files, out);
    if (!plot_note.empty())
      out << "No pictures: " << plot_note << std::endl;

    if (result.status != SolverStatus::success || !failure.empty())
      std::cerr << "debond: NOT CONVERGED (" << summary.status
                << "): " << summary.message << std::endl;
    else if (result.minimum.interrupted)
      std::cerr
        << "debond: the search or the proof was interrupted; the result "
           "is what it had found"
        << std::endl;
    if (!output_error.empty())
      {
        std::cerr << "debond: " << output_error << std::endl;
        return ExitCode::output_not_saved;
      }
    return result.status == SolverStatus::success && !failure.empty() ?
             ExitCode::not_converged :
             exit_code(result);
  }



  template ExitCode
  run<2>(const Parameters &, std::ostream &, const bool);
  template ExitCode
  run<3>(const Parameters &, std::ostream &, const bool);
} // namespace Debond
