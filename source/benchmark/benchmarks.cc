// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <debond/benchmark/benchmark_study.h>
#include <debond/benchmark/benchmarks.h>
#include <debond/benchmark/contact_against_linear.h>
#include <debond/benchmark/machine.h>
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
    run_start_up(const BenchmarkStudy &study, const Writer &writer)
    {
      std::cout << "Start of the program" << std::endl;
      const BenchmarkRow row = measure_start_up(study.scenes.front(),
                                                writer.path("start-up"),
                                                study.repetitions);
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
    run_contact_solves(const std::vector<BenchmarkStudy> &studies,
                       const Writer                      &writer)
    {
      std::cout << "Contact solve beside one linear solve" << std::endl;
      std::vector<BenchmarkRow> rows;
      for (const BenchmarkStudy &study : studies)
        for (const BenchmarkScene &scene : study.scenes)
          {
            std::cout << "  " << scene.name << std::endl;
            const Parameters parameters = scene.parameters();
            rows.push_back(parameters.dimension == 2 ?
                             measure_contact_against_linear<2>(scene.name,
                                                               parameters,
                                                               study) :
                             measure_contact_against_linear<3>(scene.name,
                                                               parameters,
                                                               study));
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
  } // namespace



  ExitCode
  run_benchmarks(const std::string              &directory,
                 const std::vector<std::string> &files)
  {
    std::vector<BenchmarkStudy> studies;
    for (const std::string &file : files)
      {
        BenchmarkTable table;
        read_scene(file, table);
        studies.push_back(table.benchmark(file));
      }
    const Writer writer(directory);
    // In its own process, and before the environment has traces of MPI.
    run_start_up(studies.front(), writer);

    int                                      argc = 0;
    char                                   **argv = nullptr;
    dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
    return run_contact_solves(studies, writer);
  }
} // namespace Debond
