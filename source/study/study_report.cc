// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/data_out_base.h>

#include <debond/base/atomic_file.h>
#include <debond/base/version.h>
#include <debond/study/study_report.h>

#include <filesystem>
#include <sstream>

namespace Debond
{
  namespace
  {
    void
    write_pvd(const StudyParameters       &study,
              const std::vector<StudyRow> &rows,
              const std::string           &vtu,
              const std::string           &pvd)
    {
      std::vector<std::pair<double, std::string>> times_and_names;
      for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows[i].result.has_results())
          times_and_names.emplace_back(i,
                                       std::filesystem::path(
                                         rows[i].one->directory + "/" + vtu)
                                         .lexically_relative(study.directory)
                                         .string());
      write_atomically(study.directory + "/" + pvd, [&](std::ostream &out) {
        dealii::DataOutBase::write_pvd_record(out, times_and_names);
      });
    }



    std::string
    best_text(const StudyParameters &study, const std::vector<BestRow> &best)
    {
      std::ostringstream text;
      text << "\n## Best values\n\n" << make_best_table(study, best).markdown();
      if (const auto law = fit_best_values(best); law)
        {
          text.precision(3);
          text << "\nFitted: best " << study.sweeps[1].label << " = "
               << law->factor << " h^" << law->exponent
               << ", without those at an end of the values.\n";
        }
      return text.str();
    }
  } // namespace



  DataTable
  make_table(const StudyParameters          &study,
             const std::vector<StudyRow>    &rows,
             const std::optional<Reference> &reference)
  {
    const auto has_reference = [&](const std::string &name) {
      return reference && study.reference.columns.count(name) > 0;
    };

    DataTable table;
    for (const Sweep &sweep : study.sweeps)
      table.add_column(sweep.label, 1);
    for (const std::string &name : study.columns)
      {
        const Column column = Column::parse(name);
        table.add_column(column.title(), column.digits());
        if (has_reference(name))
          table.add_column(column.title() + " (" + study.reference.label + ")",
                           column.digits());
      }

    for (const StudyRow &row : rows)
      {
        std::vector<Cell> cells(row.one->values.begin(), row.one->values.end());
        for (const std::string &name : study.columns)
          {
            const Column column = Column::parse(name);
            cells.push_back(column.value(row));
            if (has_reference(name))
              cells.push_back(reference->value(row.one->values.front(),
                                               name,
                                               column.is_error()));
          }
        table.add_row(cells);
      }
    return table;
  }



  DataTable
  make_best_table(const StudyParameters      &study,
                  const std::vector<BestRow> &best)
  {
    const std::string label = study.sweeps[1].label;
    DataTable         table;
    table.add_column(study.sweeps[0].label, 1);
    const bool has_methods = study.sweeps.size() > 2;
    if (has_methods)
      table.add_column(study.sweeps[2].label, 1);
    table.add_column("h", 3);
    table.add_column("best " + label, 3);
    table.add_column("iterations", 1);
    table.add_column("smallest " + label + " within 10 %", 3);
    table.add_column("largest " + label + " within 10 %", 3);
    table.add_column("at an end of the values", 1);
    for (const BestRow &row : best)
      {
        std::vector<Cell> cells = {row.value};
        if (has_methods)
          cells.emplace_back(row.method);
        cells.emplace_back(row.cell_edge);
        cells.emplace_back(row.best.value);
        cells.emplace_back(static_cast<long>(row.best.iterations));
        cells.emplace_back(row.best.smallest_good);
        cells.emplace_back(row.best.largest_good);
        cells.emplace_back(std::string(row.best.at_end ? "yes" : "no"));
        table.add_row(cells);
      }
    return table;
  }



  void
  write_series(const StudyParameters &study, const std::vector<StudyRow> &rows)
  {
    write_pvd(study, rows, "body.vtu", "fields.pvd");
    write_pvd(study, rows, "contact.vtu", "contact.pvd");
  }



  void
  write_index(const StudyParameters          &study,
              const DataTable                &table,
              const std::vector<BestRow>     &best,
              const std::vector<Plot>        &plots,
              const std::vector<std::string> &notes)
  {
    write_atomically(study.directory + "/index.md", [&](std::ostream &out) {
      out << "# " << study.title << "\n\n";
      if (!study.description.empty())
        out << study.description << "\n\n";
      out << "Made by `debond --study " << study.file << "`, Debond "
          << program_version() << ", revision " << git_revision() << ", "
          << build_type() << ", from the scene `" << study.scene << "`.\n\n"
          << table.markdown();
      if (!best.empty())
        out << best_text(study, best);
      for (const Plot &plot : plots)
        out << "\n![" << plot.name << "](plots/" << plot.name << ".png)\n*"
            << plot.caption << "* ([SVG](plots/" << plot.name
            << ".svg), [data](plots/" << plot.name << ".dat), [script](plots/"
            << plot.name << ".gp))\n";
      for (const std::string &note : notes)
        out << '\n' << note << '\n';
      out << "\nThe table as [CSV](table.csv) with all digits, [Markdown]"
             "(table.md) and [LaTeX](table.tex)";
      if (study.fields)
        out << "; the fields for ParaView: [body](fields.pvd), [contact "
               "boundary](contact.pvd), the time is the number of the case";
      out << ".\n";
    });
  }
} // namespace Debond
