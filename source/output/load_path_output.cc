// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/data_out_base.h>
#include <deal.II/base/utilities.h>

#include <debond/base/atomic_file.h>
#include <debond/base/instantiate.h>
#include <debond/base/processes.h>
#include <debond/output/csv_table.h>
#include <debond/output/load_path_output.h>

#include <filesystem>

namespace Debond
{
  namespace
  {
    const std::string directory_of_steps = "load_path";



    /// The cells of a row of load_path.csv.
    class Row
    {
    public:
      std::vector<CsvTable::Cell> cells;

      template <typename T>
      void
      add(const std::string &title, const T &value)
      {
        cells.push_back(CsvTable::titled(title, value));
      }

      template <int dim>
      void
      add(const std::string &title, const dealii::Tensor<1, dim> &vector)
      {
        for (unsigned int d = 0; d < dim; ++d)
          add(title + '_' + "xyz"[d], vector[d]);
      }

      /// Of a list whose entries have names, with what they end with.
      template <typename T>
      void
      add(const std::string                            &ending,
          const std::vector<std::pair<std::string, T>> &list)
      {
        for (const auto &[name, value] : list)
          add(name + ending, value);
      }

      /// "0.2 0; 0.31 0"
      template <int dim>
      void
      add(const std::string                     &title,
          const std::vector<dealii::Point<dim>> &points)
      {
        std::string text;
        for (const dealii::Point<dim> &point : points)
          for (unsigned int d = 0; d < dim; ++d)
            text += (d > 0        ? " " :
                     text.empty() ? "" :
                                    "; ") +
                    shortest_text(point[d]);
        add(title, text);
      }

      template <int dim>
      void
      add(const std::string &prefix, const LoadPathState<dim> &state)
      {
        LoadPathState<dim>::for_each_number(
          state, [&](const std::string &title, const auto &number) {
            const std::size_t n = cells.size();
            add(title, number);
            for (std::size_t k = n; k < cells.size(); ++k)
              cells[k].first = prefix + cells[k].first;
          });
      }
    };



    /// A row for each step; what was not computed is left empty.
    template <int dim>
    void
    write_load_path(const std::vector<LoadPathStep<dim>> &steps,
                    const std::string                    &file_name)
    {
      CsvTable table;
      for (const LoadPathStep<dim> &step : steps)
        {
          Row row;
          row.add("step", step.step);
          row.add("factor", step.factor);
          row.add("displacement_factor", step.displacement_factor);
          row.add("status", step.status);
          row.add("", step.state);
          row.add("iterations", step.iterations);
          row.add("change_factor", step.change_factor);
          // Without a global branch its columns are those of the step.
          const std::size_t n = row.cells.size();
          row.add("global_", step.global ? *step.global : step.state);
          if (!step.global)
            for (std::size_t k = n; k < row.cells.size(); ++k)
              row.cells[k].second.clear();
          row.add("global_relative_gap", step.relative_gap);
          table.add_row(row.cells);
        }
      table.write(file_name);
    }
  } // namespace



  template <int dim>
  void
  LoadPathOutput<dim>::remove_steps() const
  {
    if (!is_first_rank())
      return;
    std::vector<std::filesystem::path> old;
    std::error_code                    unreadable;
    for (const auto &entry :
         std::filesystem::directory_iterator(path(directory_of_steps),
                                             unreadable))
      if ((entry.path().extension() == ".vtu" ||
           entry.path().extension() == ".pvtu") &&
          entry.is_regular_file(unreadable))
        old.push_back(entry.path());
    for (const std::filesystem::path &file : old)
      std::filesystem::remove(file, unreadable);
    if (std::filesystem::is_empty(path(directory_of_steps), unreadable))
      std::filesystem::remove(path(directory_of_steps), unreadable);
  }



  template <int dim>
  void
  LoadPathOutput<dim>::go_on_after(const std::vector<LoadPathStep<dim>> &done)
  {
    so_far.assign(done.begin(), done.end() - 1);
    const auto find =
      [this](const std::string &body, const unsigned int step, Series &series) {
        const std::string name = name_of_step(body, step);
        for (const std::string &file :
             {name, name.substr(0, name.size() - 3) + "pvtu"})
          if (std::filesystem::exists(path(file)))
            series.emplace_back(step, file);
      };
    for (const LoadPathStep<dim> &step : so_far)
      {
        find("body", step.step, bodies);
        find("contact", step.step, contacts);
      }
  }



  template <int dim>
  void
  LoadPathOutput<dim>::add(const LoadPathStep<dim> &step,
                           const DofVector         &u,
                           const Verification<dim> &verification)
  {
    if (!error.empty())
      return;
    try
      {
        // Of a run that is killed most is there; of long paths few are written
        // more than sixty times.
        so_far.push_back(step);
        if (so_far.size() % (1 + so_far.size() / 64) == 0)
          write_load_path(so_far, path("load_path.csv"));
        if (!(output.path_body_vtu || output.path_contact_vtu))
          return;
        on_all_ranks(MPI_COMM_WORLD, [&]() {
          std::filesystem::create_directories(path(directory_of_steps));
        });
        // ParaView wants times that increase, which the factors need not do.
        if (output.path_body_vtu)
          {
            const std::string name = name_of_step("body", step.step);
            write_body_vtu(problem, u, path(name), step.factors());
            bodies.emplace_back(step.step,
                                joined_file(name,
                                            problem.unknowns().communicator()));
          }
        if (output.path_contact_vtu)
          {
            const std::string name = name_of_step("contact", step.step);
            write_contact_vtu(problem.unknowns().contact().boundary(),
                              verification,
                              path(name));
            contacts.emplace_back(step.step, name);
          }
      }
    catch (const std::runtime_error &exception)
      {
        error = exception.what();
      }
  }



  template <int dim>
  std::vector<OutputFile>
  LoadPathOutput<dim>::files(const std::vector<LoadPathStep<dim>> &steps,
                             const std::vector<LoadPathStep<dim>> &arc) const
  {
    return {{"load_path_arc.csv",
             [&arc]() { return !arc.empty(); },
             [&arc](const std::string &file) { write_load_path(arc, file); }},
            series_file("load_path_body.pvd", bodies),
            series_file("load_path_contact.pvd", contacts),
            {"load_path.csv",
             [&steps]() { return !steps.empty(); },
             [this, &steps](const std::string &file) {
               write_load_path(steps, file);
               if (!error.empty())
                 throw std::runtime_error(error);
             }}};
  }



  template <int dim>
  OutputFile
  LoadPathOutput<dim>::series_file(const std::string &name,
                                   const Series      &series) const
  {
    return {name,
            [&series]() { return !series.empty(); },
            [&series](const std::string &file) {
              write_atomically(file, [&series](std::ostream &out) {
                dealii::DataOutBase::write_pvd_record(out, series);
              });
            }};
  }



  template <int dim>
  std::string
  LoadPathOutput<dim>::path(const std::string &name) const
  {
    return (std::filesystem::path(output.directory) / name).string();
  }



  template <int dim>
  std::string
  LoadPathOutput<dim>::name_of_step(const std::string &body,
                                    const unsigned int step) const
  {
    return directory_of_steps + '/' + body + '-' +
           dealii::Utilities::int_to_string(step, 5) + ".vtu";
  }



  DEBOND_INSTANTIATE_CLASS(LoadPathOutput);
} // namespace Debond
