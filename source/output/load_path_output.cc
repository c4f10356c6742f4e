// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/data_out_base.h>

#include <debond/base/atomic_file.h>
#include <debond/output/load_path_output.h>
#include <debond/output/load_path_plots.h>
#include <debond/output/vtu.h>

#include <filesystem>
#include <iomanip>
#include <sstream>

namespace Debond
{
  namespace
  {
    const std::string directory_of_steps = "load_path";



    const char *const table    = "load_path.csv";
    const char *const bodies   = "load_path_body.pvd";
    const char *const contacts = "load_path_contact.pvd";



    /// What a load path may have left, but nothing else.
    void
    remove_old_files(const std::filesystem::path &directory)
    {
      std::vector<std::filesystem::path> old = {directory / table,
                                                directory / bodies,
                                                directory / contacts};
      for (const std::string &plot : load_path_plot_names())
        for (const char *ending : {".dat", ".gp", ".png", ".svg", ".log"})
          old.push_back(directory / (plot + ending));
      std::error_code error;
      for (const auto &entry :
           std::filesystem::directory_iterator(directory / directory_of_steps,
                                               error))
        if (entry.path().extension() == ".vtu")
          old.push_back(entry.path());
      for (const std::filesystem::path &file : old)
        if (std::filesystem::is_regular_file(file, error))
          std::filesystem::remove(file, error);
      if (std::filesystem::is_empty(directory / directory_of_steps, error))
        std::filesystem::remove(directory / directory_of_steps, error);
    }
  } // namespace



  template <int dim>
  LoadPathOutput<dim>::LoadPathOutput(const OutputParameters    &output,
                                      const ElasticProblem<dim> &problem)
    : output(output)
    , problem(problem)
  {
    remove_old_files(output.directory);
  }



  template <int dim>
  void
  LoadPathOutput<dim>::add(const LoadPathStep<dim>      &step,
                           const dealii::Vector<double> &u,
                           const Verification<dim>      &verification)
  {
    if (!error.empty() || !(output.path_body_vtu || output.path_contact_vtu))
      return;
    try
      {
        std::filesystem::create_directories(path(directory_of_steps));
        // ParaView wants times that increase, which the factors need not do.
        if (output.path_body_vtu)
          {
            const std::string name = name_of_step("body", step.step);
            write_body_vtu(problem, u, path(name));
            body_record.emplace_back(step.step, name);
          }
        if (output.path_contact_vtu)
          {
            const std::string name = name_of_step("contact", step.step);
            write_contact_vtu(problem, u, verification, path(name));
            contact_record.emplace_back(step.step, name);
          }
      }
    catch (const std::runtime_error &exception)
      {
        error = exception.what();
      }
  }



  template <int dim>
  std::vector<std::string>
  LoadPathOutput<dim>::finish(const std::vector<LoadPathStep<dim>> &steps,
                              std::string                          &note)
  {
    std::vector<std::string> files = {path(table)};
    write_load_path(steps, files.back());

    for (const auto &[name, record] :
         {std::make_pair(bodies, body_record),
          std::make_pair(contacts, contact_record)})
      if (!record.empty())
        {
          files.push_back(path(name));
          write_atomically(files.back(), [&record = record](std::ostream &out) {
            dealii::DataOutBase::write_pvd_record(out, record);
          });
        }

    for (const Plot &plot : load_path_plots(steps))
      {
        write_gnuplot(plot, output.directory);
        for (const char *ending : {".dat", ".gp"})
          files.push_back(path(plot.name + ending));
        if (!output.path_plots || !note.empty())
          continue;
        note = run_gnuplot(plot, output.directory);
        if (note.empty())
          for (const char *ending : {".png", ".svg"})
            files.push_back(path(plot.name + ending));
      }
    if (!error.empty())
      throw std::runtime_error(error);
    return files;
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
    std::ostringstream name;
    name << directory_of_steps << '/' << body << '-' << std::setw(5)
         << std::setfill('0') << step << ".vtu";
    return name.str();
  }



  template class LoadPathOutput<2>;
  template class LoadPathOutput<3>;
} // namespace Debond
