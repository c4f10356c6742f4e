// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/data_out_base.h>

#include <debond/base/atomic_file.h>
#include <debond/output/load_path.h>
#include <debond/output/load_path_output.h>
#include <debond/output/vtu.h>

#include <filesystem>
#include <iomanip>
#include <sstream>

namespace Debond
{
  namespace
  {
    const std::string directory_of_steps = "load_path";
  } // namespace



  template <int dim>
  void
  LoadPathOutput<dim>::remove_steps() const
  {
    std::vector<std::filesystem::path> old;
    std::error_code                    unreadable;
    for (const auto &entry :
         std::filesystem::directory_iterator(path(directory_of_steps),
                                             unreadable))
      if (entry.path().extension() == ".vtu" &&
          entry.is_regular_file(unreadable))
        old.push_back(entry.path());
    for (const std::filesystem::path &file : old)
      std::filesystem::remove(file, unreadable);
    if (std::filesystem::is_empty(path(directory_of_steps), unreadable))
      std::filesystem::remove(path(directory_of_steps), unreadable);
  }



  template <int dim>
  void
  LoadPathOutput<dim>::add(const LoadPathStep<dim> &step,
                           const DofVector         &u,
                           const Verification<dim> &verification)
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
            write_body_vtu(problem, u, path(name), step.factors());
            bodies.emplace_back(step.step, name);
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
  LoadPathOutput<dim>::files()
  {
    return {{"load_path_arc.csv",
             [this]() { return !arc.empty(); },
             [this](const std::string &file) { write_load_path(arc, file); }},
            series_file("load_path_body.pvd", bodies),
            series_file("load_path_contact.pvd", contacts),
            {"load_path.csv",
             [this]() { return !steps.empty(); },
             [this](const std::string &file) {
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
    std::ostringstream name;
    name << directory_of_steps << '/' << body << '-' << std::setw(5)
         << std::setfill('0') << step << ".vtu";
    return name.str();
  }



  template class LoadPathOutput<2>;
  template class LoadPathOutput<3>;
} // namespace Debond
