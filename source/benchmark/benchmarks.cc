// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <debond/benchmark/benchmark_study.h>
#include <debond/benchmark/benchmarks.h>
#include <debond/benchmark/certificate_against_linear.h>
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



    bool
    has_certificate(const Parameters &parameters)
    {
      return parameters.dimension == 2 &&
             parameters.certificate.kind != CertificateKind::none;
    }



    /// Measures a scene, with a certificate that one; if that fails, the row
    /// has the reason.
    BenchmarkRow
    contact_row(const BenchmarkScene &scene, const BenchmarkStudy &study)
    {
      try
        {
          const Parameters parameters = scene.parameters();
          if (has_certificate(parameters))
            return measure_certificate_against_linear(scene.name,
                                                      parameters,
                                                      study);
          return parameters.dimension == 2 ?
                   measure_contact_against_linear<2>(scene.name,
                                                     parameters,
                                                     study) :
                   measure_contact_against_linear<3>(scene.name,
                                                     parameters,
                                                     study);
        }
      catch (const std::exception &error)
        {
          BenchmarkRow row;
          row["scene"]  = scene.name;
          row["failed"] = scene.name + ": " + error.what();
          return row;
        }
    }



    /// Names on std::cerr what did not end with success.
    ExitCode
    report_failures(const std::vector<BenchmarkRow> &rows)
    {
      unsigned int n_failed = 0;
      for (const BenchmarkRow &row : rows)
        {
          const bool has_failed = row.contains("failed");
          if (has_failed)
            std::cerr << "debond: FAILED: " << row["failed"].get<std::string>()
                      << std::endl;
          const bool is_wrong =
            row.contains("status") &&
            row["status"] != to_string(SolverStatus::success);
          if (is_wrong)
            std::cerr << "debond: NOT CONVERGED: " << row.dump() << std::endl;
          n_failed += has_failed || is_wrong;
        }
      std::cout << n_failed << " of " << rows.size() << " scenes failed"
                << std::endl;
      return n_failed == 0 ? ExitCode::success : ExitCode::not_converged;
    }



    void
    write_contact_solves(const std::vector<BenchmarkRow> &rows,
                         const Writer                    &writer)
    {
      writer.write(
        "contact_solve",
        {plain_column("scene", "scene"),
         plain_column("unknowns", "unknowns"),
         number_column("contact, s", "cpu_seconds", 3),
         plain_column("cycles", "cg_steps"),
         plain_column("linear", "levels_iterations"),
         number_column("quotient", "cycles_over_levels", 3),
         spread_column("time / same cycle", "cpu_time_over_levels", 3),
         spread_column("time / best", "cpu_time_over_best", 3),
         plain_column("best", "best_linear"),
         number_column("same cycle, s", "levels_cpu_seconds", 3),
         number_column("ML-CG, s", "ml_cpu_seconds", 3),
         number_column("hypre-CG, s", "hypre_cpu_seconds", 3),
         number_column("CHOLMOD, s", "cholesky_cpu_seconds", 3),
         number_column("bytes per unknown", "bytes_per_unknown", 3)},
        rows);
    }



    void
    write_certificates(const std::vector<BenchmarkRow> &rows,
                       const Writer                    &writer)
    {
      writer.write(
        "certificates",
        {plain_column("scene", "scene"),
         plain_column("kind", "kind"),
         plain_column("unknowns", "unknowns"),
         plain_column("of the stresses", "stress_unknowns"),
         number_column("width", "width", 2),
         plain_column("boxes", "boxes"),
         number_column("certificate, s", "cpu_seconds", 3),
         number_column("CHOLMOD, s", "cholesky_cpu_seconds", 3),
         number_column("with assembly, s", "assembled_cpu_seconds", 3),
         spread_column("over CHOLMOD", "cpu_time_over_cholesky", 3),
         spread_column("over both", "cpu_time_over_assembled", 3)},
        rows);
    }



    ExitCode
    run_contact_solves(const std::vector<BenchmarkStudy> &studies,
                       const Writer                      &writer)
    {
      std::cout << "Contact solve beside one linear solve" << std::endl;
      std::vector<BenchmarkRow> rows, of_growing, certificates;
      for (const BenchmarkStudy &study : studies)
        for (const BenchmarkScene &scene : study.scenes)
          {
            std::cout << "  " << scene.name << std::endl;
            const BenchmarkRow row = contact_row(scene, study);
            if (row.contains("kind"))
              {
                certificates.push_back(row);
                write_certificates(certificates, writer);
                continue;
              }
            rows.push_back(row);
            if (study.is_refined && rows.back().contains("status"))
              of_growing.push_back(rows.back());
            // What ends the program later leaves these.
            write_contact_solves(rows, writer);
          }

      writer.write("growth",
                   {plain_column("path", "path"),
                    plain_column("unknowns from", "unknowns_from"),
                    plain_column("to", "unknowns_to"),
                    number_column("time ~ n^", "time_exponent", 3),
                    number_column("memory ~ n^", "memory_exponent", 3)},
                   fit_growth(of_growing, smallest_for_growth));
      std::cout << "Tables (CSV, Markdown): " << writer.path("") << std::endl;
      rows.insert(rows.end(), certificates.begin(), certificates.end());
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
    ExitCode of_start_up = ExitCode::success;
    try
      {
        run_start_up(studies.front(), writer);
      }
    catch (const std::runtime_error &error)
      {
        std::cerr << "debond: FAILED: " << error.what() << std::endl;
        of_start_up = ExitCode::not_converged;
      }

    int                                      argc = 0;
    char                                   **argv = nullptr;
    dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
    const ExitCode of_contact = run_contact_solves(studies, writer);
    return of_contact == ExitCode::success ? of_start_up : of_contact;
  }
} // namespace Debond
