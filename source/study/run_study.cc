// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/directory_lock.h>
#include <debond/base/text.h>
#include <debond/study/case_runner.h>
#include <debond/study/run_study.h>
#include <debond/study/study_report.h>

#include <algorithm>
#include <filesystem>

namespace Debond
{
  namespace
  {
    /// Runs all that has to be run. Returns false if interrupted.
    bool
    run_cases(const StudyParameters &study,
              const Cases           &cases,
              CaseRunner            &runner)
    {
      bool afresh = false;
      if (cases.preparation)
        {
          if (!runner.run(study.scene, {&*cases.preparation}, false))
            return false;
          // The others may have used what an earlier preparation left.
          afresh = runner.n_run() > 0;
          if (!is_finished(*cases.preparation))
            return true;
        }
      std::vector<const Case *> all;
      for (const Case &one : cases.minima)
        all.push_back(&one);
      for (const Case &one : cases.cases)
        all.push_back(&one);
      return runner.run(study.scene, all, afresh);
    }



    std::vector<StudyRow>
    collect_rows(const StudyParameters &study,
                 const Cases           &cases,
                 const CaseRunner      &runner)
    {
      std::vector<StudyRow> rows;
      for (const Case &one : cases.cases)
        {
          StudyRow         row{&one, runner.result(one), {}, {}};
          const CaseResult minimum =
            one.minimum ? runner.result(cases.minima[*one.minimum]) :
                          CaseResult();
          if (minimum.status == "success")
            {
              row.minimum = minimum.number("/functional");
              row.rate =
                fit_rate(relative_errors(row.result.history, *row.minimum),
                         study.fit_from,
                         study.fit_to);
            }
          rows.push_back(row);
        }
      return rows;
    }



    /// Throws std::runtime_error naming a column whose number is in no summary.
    void
    check_pointers(const StudyParameters       &study,
                   const std::vector<StudyRow> &rows)
    {
      const bool any_results =
        std::any_of(rows.begin(), rows.end(), [](const StudyRow &row) {
          return row.result.has_results();
        });
      for (const std::string &name : study.columns)
        {
          const Column column = Column::parse(name);
          if (any_results && !column.json_pointer().empty() &&
              std::none_of(rows.begin(), rows.end(), [&](const StudyRow &row) {
                return row.result.numbers.count(column.json_pointer()) > 0;
              }))
            throw std::runtime_error(
              "Study/Columns: no case has a number " + column.json_pointer() +
              " in its summary.json, for the column '" + name + "'");
        }
    }



    bool
    is_accepted(const StudyParameters &study, const CaseResult &result)
    {
      return std::find(study.accepted_statuses.begin(),
                       study.accepted_statuses.end(),
                       result.status) != study.accepted_statuses.end();
    }



    /// What went wrong, a line for each case.
    std::vector<std::string>
    failures(const StudyParameters       &study,
             const Cases                 &cases,
             const CaseRunner            &runner,
             const std::vector<StudyRow> &rows)
    {
      std::vector<std::string> lines;
      const auto add = [&](const Case &one, const CaseResult &result) {
        lines.push_back(one.label + ": " + result.status +
                        (result.message.empty() ? "" : ": " + result.message));
      };
      if (cases.preparation && !is_finished(*cases.preparation))
        add(*cases.preparation, runner.result(*cases.preparation));
      for (const Case &one : cases.minima)
        if (const CaseResult result = runner.result(one);
            result.status != "success")
          add(one, result);
      for (const StudyRow &row : rows)
        if (!is_accepted(study, row.result))
          add(*row.one, row.result);
      return lines;
    }



    void
    write_tables(const StudyParameters &study,
                 const DataTable       &table,
                 const std::string     &name)
    {
      const std::string path = study.directory + "/" + name;
      table.write_csv(path + ".csv");
      table.write_markdown(path + ".md");
      table.write_latex(path + ".tex");
    }



    /// Returns what went wrong, or nothing.
    std::string
    draw(const StudyParameters &study, const std::vector<Plot> &plots)
    {
      const std::string directory = study.directory + "/plots";
      std::filesystem::create_directories(directory);
      std::string problem;
      for (const Plot &plot : plots)
        {
          write_gnuplot(plot, directory);
          if (const std::string error = run_gnuplot(plot, directory);
              !error.empty())
            problem = error;
        }
      return problem;
    }



    ExitCode
    report_study(const StudyParameters          &study,
                 const Cases                    &cases,
                 const CaseRunner               &runner,
                 const std::optional<Reference> &reference,
                 std::ostream                   &out)
    {
      const std::vector<StudyRow> rows = collect_rows(study, cases, runner);
      check_pointers(study, rows);
      const std::vector<BestRow> best  = find_best_values(study, rows);
      const DataTable            table = make_table(study, rows, reference);
      write_tables(study, table, "table");
      if (!best.empty())
        write_tables(study, make_best_table(study, best), "best");
      if (study.fields)
        write_series(study, rows);

      const std::vector<Plot> plots        = make_plots(study, rows, best);
      const std::string       plot_problem = draw(study, plots);

      std::vector<std::string>       notes;
      const std::vector<std::string> failed =
        failures(study, cases, runner, rows);
      if (!failed.empty())
        {
          std::string note = "Failed:\n";
          for (const std::string &line : failed)
            note += "\n* " + line;
          notes.push_back(note);
        }
      if (!plot_problem.empty())
        notes.push_back("Not all pictures were drawn: " + plot_problem + ".");
      for (const std::string &kind : study.plots.kinds)
        if (std::none_of(plots.begin(), plots.end(), [&](const Plot &plot) {
              return plot.name == kind;
            }))
          {
            notes.push_back("The plot " + kind + " has no points" +
                            (kind == "law" ?
                               "; of bonds that vary there is no one graph." :
                               "."));
            std::cerr << "debond: " << notes.back() << std::endl;
          }
      write_index(study, table, best, plots, notes);

      out << '\n'
          << table.markdown() << "\nWritten: " << study.directory
          << "/index.md, with its tables and plots" << std::endl;
      for (const std::string &line : failed)
        print_error("case " + line);
      if (!plot_problem.empty())
        print_error("no pictures: " + plot_problem +
                    "; their data and scripts are in " + study.directory +
                    "/plots");
      if (!failed.empty())
        return ExitCode::not_converged;
      return plot_problem.empty() ? ExitCode::success :
                                    ExitCode::output_not_saved;
    }
  } // namespace



  ExitCode
  run_study(const StudyParameters &study,
            const unsigned int     jobs,
            std::ostream          &out,
            const bool             terminal)
  {
    const dealii::Timer      timer;
    const Cases              cases = make_cases(study);
    std::optional<Reference> reference;
    if (!study.reference.file.empty())
      reference.emplace(study.reference);

    out << "Study " << study.title << "\n  cases " << cases.cases.size()
        << ", exact minima " << cases.minima.size() << ", at a time " << jobs
        << std::endl;
    try
      {
        const DirectoryLock lock(study.directory);
        CaseRunner          runner(jobs, out, terminal);
        if (!run_cases(study, cases, runner))
          {
            print_error("interrupted; the same command goes on where the study "
                        "stopped");
            return ExitCode::interrupted;
          }
        const ExitCode code =
          report_study(study, cases, runner, reference, out);
        out << "Cases run now: " << runner.n_run() << ", in "
            << timer.wall_time() << " s" << std::endl;
        return code;
      }
    catch (const std::runtime_error &error)
      {
        print_error(error.what());
        return ExitCode::output_not_saved;
      }
  }
} // namespace Debond
