// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <debond/benchmark/benchmarks.h>
#include <debond/benchmark/contact_against_linear.h>
#include <debond/benchmark/machine.h>
#include <debond/benchmark/speed_against_error.h>
#include <debond/benchmark/start_up.h>

#include <filesystem>
#include <iostream>

namespace Debond
{
  namespace
  {
    /// Below, the time is not yet that of the factorisation.
    constexpr unsigned int smallest_for_growth = 2000;



    /// Writes results into a directory.
    class Writer
    {
    public:
      explicit Writer(const std::string &directory)
        : directory(directory)
        , heading(describe_machine())
      {
        std::filesystem::create_directories(directory);
      }

      std::string
      path(const std::string &name) const
      {
        return (directory / name).string();
      }

      void
      write(const std::string                  &name,
            const std::vector<BenchmarkColumn> &columns,
            const std::vector<BenchmarkRow>    &rows) const
      {
        write_csv(rows, path(name + ".csv"));
        write_markdown(heading, columns, rows, path(name + ".md"));
        std::cout << "  " << path(name + ".csv") << ", .md" << std::endl;
      }

    private:
      const std::filesystem::path directory;
      const std::string           heading;
    };



    void
    run_start_up(const BenchmarkSuite &suite, const Writer &writer)
    {
      std::cout << "Start of the program" << std::endl;
      const BenchmarkRow row = measure_start_up(suite.start_up,
                                                writer.path("start-up"),
                                                suite.start_up_repetitions);
      writer.write("start_up",
                   {plain_column("scene", "scene"),
                    spread_column("over an empty program", "ratio", 3),
                    spread_column("above it, s", "seconds_above_floor", 2),
                    spread_column("whole program, s", "seconds", 3),
                    spread_column("empty program, s", "floor_seconds", 3)},
                   {row});
    }



    /// Names the solves that did not end with success on std::cerr.
    ExitCode
    report_failures(const std::vector<BenchmarkRow> &rows)
    {
      ExitCode result = ExitCode::success;
      for (const BenchmarkRow &row : rows)
        if (row["status"] != to_string(SolverStatus::success))
          {
            std::cerr << "debond: NOT CONVERGED: " << row.dump() << std::endl;
            result = ExitCode::not_converged;
          }
      return result;
    }



    ExitCode
    run_contact_solves(const BenchmarkSuite &suite, const Writer &writer)
    {
      std::cout << "Contact solve beside one linear solve" << std::endl;
      std::vector<BenchmarkRow> rows;
      for (const BenchmarkSuite::ContactSolve &contact : suite.contact_solves)
        {
          std::cout << "  " << contact.scene.name << std::endl;
          rows.push_back(contact.scene.parameters().dimension == 2 ?
                           measure_contact_against_linear<2>(contact) :
                           measure_contact_against_linear<3>(contact));
        }

      writer.write(
        "contact_solve",
        {plain_column("scene", "scene"),
         plain_column("unknowns", "unknowns"),
         plain_column("path", "path"),
         spread_column("time / CHOLMOD", "time_over_cholesky", 3),
         number_column("CPU time / CHOLMOD", "cpu_time_over_cholesky", 3),
         spread_column("memory / CHOLMOD", "memory_over_cholesky", 3),
         spread_column("time / ML-CG", "time_over_multigrid", 3),
         number_column("CPU time / ML-CG", "cpu_time_over_multigrid", 3),
         spread_column("memory / ML-CG", "memory_over_multigrid", 3),
         plain_column("iterations", "iterations"),
         plain_column("CG steps", "multigrid_iterations"),
         number_column("contact, s", "seconds", 3),
         number_column("CHOLMOD, s", "cholesky_seconds", 3),
         number_column("ML-CG, s", "multigrid_seconds", 3)},
        rows);
      writer.write("growth",
                   {plain_column("path", "path"),
                    plain_column("unknowns from", "unknowns_from"),
                    plain_column("to", "unknowns_to"),
                    number_column("time ~ n^", "time_exponent", 3),
                    number_column("memory ~ n^", "memory_exponent", 3)},
                   fit_growth(rows, smallest_for_growth));
      return report_failures(rows);
    }



    ExitCode
    run_speed_against_error(const BenchmarkSuite &suite, const Writer &writer)
    {
      std::cout << "Speed against error" << std::endl;
      const SpeedAgainstError result =
        suite.meshes.front().scene.parameters().dimension == 2 ?
          measure_speed_against_error<2>(suite.meshes) :
          measure_speed_against_error<3>(suite.meshes);

      writer.write(
        "methods",
        {plain_column("mesh", "mesh"),
         plain_column("method", "method"),
         spread_column("time / last method", "time_over_last_method", 3),
         plain_column("iterations", "iterations"),
         number_column("J - J_min", "J_optimisation_error", 2),
         number_column("law violation", "law_violation", 2),
         spread_column("time, s", "seconds", 3)},
        result.methods);
      writer.write("speed_against_error",
                   {plain_column("mesh", "mesh"),
                    plain_column("unknowns", "unknowns"),
                    plain_column("method", "method"),
                    number_column("J - J_min", "J_optimisation_error", 2),
                    number_column("\\|u - u_min\\|_A / \\|u_min\\|_A",
                                  "energy_optimisation_error",
                                  2),
                    number_column("J_min - J", "J_discretisation_error", 3),
                    number_column("\\|u_min - u_ref\\|_A / \\|u_ref\\|_A",
                                  "energy_discretisation_error",
                                  3),
                    plain_column("iterations", "iterations"),
                    plain_column("of them useful", "iteration_good_enough"),
                    number_column("time, s", "seconds", 3),
                    number_column("of it useful", "seconds_good_enough", 3)},
                   result.methods);
      writer.write("meshes",
                   {plain_column("mesh", "mesh"),
                    plain_column("unknowns", "unknowns"),
                    number_column("J_min", "J_min", 11),
                    number_column("J_min - J", "J_discretisation_error", 4),
                    number_column("\\|u_min - u_ref\\|_A / \\|u_ref\\|_A",
                                  "energy_discretisation_error",
                                  4)},
                   result.meshes);
      write_csv(result.convergence, writer.path("convergence.csv"));
      return report_failures(result.methods);
    }
  } // namespace



  ExitCode
  run_benchmarks(const std::string &file)
  {
    const BenchmarkSuite suite = read_benchmark_suite(file);
    const Writer         writer(suite.output);
    // In its own process, and before the environment has traces of MPI.
    run_start_up(suite, writer);

    int                                      argc = 0;
    char                                   **argv = nullptr;
    dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
    const ExitCode contact = run_contact_solves(suite, writer);
    const ExitCode speed   = run_speed_against_error(suite, writer);
    return contact == ExitCode::success ? speed : contact;
  }
} // namespace Debond
