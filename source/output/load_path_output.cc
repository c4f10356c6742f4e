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



    /// The cells of a row of load_path.csv. They are added with their titles,
    /// so that a title and what stands below it are written down in one place.
    /// Vectors and lists become several cells.
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
        // Points are one cell, because their number changes from step to step
        // and the columns have to stay.
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
        // One number may become several cells, a vector for each of its
        // components. All of those that it added get the prefix, by which the
        // columns of the global branch differ from those of the path.
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
      // The factor is that of the loads. A cell is empty if the number is not
      // known. The columns of the global branch are there in any case.
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
    // Only what write_body_vtu() and write_contact_vtu() leave is removed, and
    // the folder if nothing else is in it. The list is made before anything is
    // removed, as a folder that changes while it is read may be read wrongly.
    // Errors are ignored: whether files can be written is seen when they are.
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
    // The last step is left out here, since add() is called for it once more. A
    // body of several ranks is a .pvtu file, so that either name is looked for,
    // however many ranks there are now. Steps whose files are gone are left out
    // of the records for ParaView.
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
    // After the first error nothing more is tried: the disk is full, or the
    // folder is gone. The path continues, because its states are worth more
    // than their files, and the error is told when the other files are written.
    // All ranks get here with the same error, since all functions that write
    // agree on it.
    if (!error.empty())
      return;
    try
      {
        // The table is written again and again, so that most of it is there if
        // the run is killed. To write all rows after each step would take a
        // time that grows with the square of their number. Therefore it is
        // written after each of the first 63 steps, after every second one up
        // to 127, and so on.
        so_far.push_back(step);
        if (so_far.size() % (1 + so_far.size() / 64) == 0)
          write_load_path(so_far, path("load_path.csv"));
        if (!(output.path_body_vtu || output.path_contact_vtu))
          return;
        // All ranks create the folder: it is no error if it exists, and each of
        // them may write a piece of the body into it.
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
    // The table of the path is the last one and throws what went wrong with the
    // files of steps, so that all that can be written is written before. It is
    // complete here, with the global branch, and replaces those of add().
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
              // The record has the files by their time, which is the step, and
              // relative to its own folder.
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
    // Names with leading zeros have the order of the steps in any list of
    // files. More than five digits are not needed, since a path has at most
    // 10000 factors.
    return directory_of_steps + '/' + body + '-' +
           dealii::Utilities::int_to_string(step, 5) + ".vtu";
  }



  DEBOND_INSTANTIATE_CLASS(LoadPathOutput);
} // namespace Debond
