// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>
#include <deal.II/base/timer.h>

#include <debond/base/append.h>
#include <debond/base/directory_lock.h>
#include <debond/base/memory.h>
#include <debond/base/text.h>
#include <debond/mesh/box_piece.h>
#include <debond/mesh/mesh_piece.h>
#include <debond/output/output_files.h>
#include <debond/output/report.h>
#include <debond/output/vtu.h>
#include <debond/program/check_result.h>
#include <debond/program/run.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

namespace Debond
{
  unsigned int
  n_started_ranks()
  {
    // Of Open MPI; of MPICH and those that come from it.
    int n = 1;
    for (const char *const name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
      if (const char *const text = std::getenv(name))
        n = std::max(n, std::atoi(text));
    return static_cast<unsigned int>(n);
  }



  void
  start_mpi()
  {
    // Who uses this as a library may have started it.
    if (dealii::Utilities::MPI::job_supports_mpi())
      return;
    static int                                            argc = 0;
    static char                                         **argv = nullptr;
    static const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  }



  namespace
  {
    bool
    first_of(const MPI_Comm ranks)
    {
      return dealii::Utilities::MPI::this_mpi_process(ranks) == 0;
    }



    /// Throws BadInput if ranks cannot share the scene.
    template <int dim>
    std::shared_ptr<const BodyPiece<dim>>
    make_piece(const Parameters &parameters, const MPI_Comm ranks)
    {
      const auto refuse = [&parameters](const bool         is_refused,
                                        const std::string &entry,
                                        const std::string &what) {
        if (is_refused)
          throw BadInput({parameters.scene + ": " + entry + ": " + what +
                          "; run the scene on one rank"});
      };
      const auto first = [](const auto &entries) {
        return entries.empty() ? std::string() : entries.begin()->first;
      };
      const SolverParameters &solver = parameters.solver;
      const auto              box =
        std::dynamic_pointer_cast<const Box<dim>>(parameters.body);
      const auto mesh =
        std::dynamic_pointer_cast<const MeshBody<dim>>(parameters.body);
      refuse(!dynamic_cast<const Body<dim> &>(*parameters.body).parts.empty(),
             "Parts",
             "several ranks share no bodies with parts");
      refuse(mesh != nullptr && mesh->is_of_simplices(),
             "Mesh/Source",
             "several ranks share meshes of quadrilaterals or hexahedra that "
             "Mesh/Refinements halves, and this one is of triangles or "
             "tetrahedra");
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
      refuse(!parameters.loads.forces.empty(),
             "Loads/Force " + first(parameters.loads.forces),
             "several ranks spread no total force");
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
             "Probes/" + first(parameters.probes),
             "several ranks have no probes");
      refuse(!parameters.supports.displacements.empty(),
             "Boundary conditions/Displacement " +
               first(parameters.supports.displacements),
             "several ranks share no prescribed displacements");
      refuse(!parameters.supports.gap.empty() ||
               !parameters.supports.gaps.empty(),
             "Contact law/Initial gap",
             "several ranks share no gaps");
      refuse(!parameters.verification.exact_displacement.empty(),
             "Verification/Exact displacement",
             "several ranks compare no displacements");
      refuse(!parameters.body->has_coarse_levels(),
             box != nullptr ? "Mesh/Cells" : "Mesh/Refinements",
             "several ranks need coarser levels, and this " +
               std::string(box != nullptr ? "box" : "mesh") + " has none");
      const unsigned int n_ranks =
        dealii::Utilities::MPI::n_mpi_processes(ranks);
      try
        {
          if (box == nullptr)
            return std::make_shared<const MeshPiece<dim>>(mesh, ranks);
          return std::make_shared<const BoxPiece<dim>>(
            box, dealii::Utilities::MPI::this_mpi_process(ranks), n_ranks);
        }
      catch (const std::invalid_argument &error)
        {
          if (box == nullptr)
            throw BadInput(
              {parameters.scene + ": Mesh/Refinements: " + error.what()});
          const bool is_too_short = n_ranks > box->shape().cells[0];
          throw BadInput({parameters.scene + ": " +
                          (is_too_short ? "Mesh/Cells" : "Mesh/Rotation") +
                          ": " + error.what() +
                          (is_too_short ? "" : "; run the scene on one rank")});
        }
    }
  } // namespace



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
    std::string                   failure;
    const std::vector<OutputFile> files = output_files(output, scene, result);
    std::optional<DirectoryLock>  lock;
    std::vector<std::string>      written;
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
          print_error(failure);
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

    check_result(parameters.verification,
                 parameters.notes,
                 scene,
                 scene.adhesion(),
                 "",
                 result);

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
        report_files(written, record);
        record.print(out);
        code = conclude(result, failure);
      }
    return static_cast<ExitCode>(
      dealii::Utilities::MPI::broadcast(ranks, static_cast<int>(code)));
  }



  template decltype(run_on_ranks<2>) run_on_ranks<2>;
  template decltype(run_on_ranks<3>) run_on_ranks<3>;
} // namespace Debond
