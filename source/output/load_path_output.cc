// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/data_out_base.h>

#include <debond/base/append.h>
#include <debond/base/atomic_file.h>
#include <debond/output/csv_table.h>
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



    using NamedCells = std::vector<std::pair<std::string, std::string>>;



    template <int dim>
    NamedCells
    cells_of(const LoadPathState<dim> &state, const std::string &prefix)
    {
      NamedCells cells;
      const auto add = [&](const std::string &title, const auto &value) {
        cells.emplace_back(prefix + title, CsvTable::cell(value));
      };
      const auto add_vector = [&](const std::string            &title,
                                  const dealii::Tensor<1, dim> &vector) {
        for (unsigned int d = 0; d < dim; ++d)
          add(title + '_' + "xyz"[d], vector[d]);
      };
      add("minimum", state.minimum);
      add("J", state.functional);
      add("elastic_energy", state.elastic_energy);
      add("adhesion_energy", state.adhesion_energy);
      add("unit_load_work", state.unit_load_work);
      add("unit_displacement_work", state.unit_displacement_work);
      add("contact_part", state.contact_part);
      add("bonded_part", state.bonded_part);
      add("broken_part", state.broken_part);
      add("mean_gap", state.mean_gap);
      add("largest_gap", state.largest_gap);
      add("normal_force", state.normal_force);
      add_vector("contact_reaction", state.contact_reaction);
      add_vector("clamped_reaction", state.clamped_reaction);
      add("law_violation", state.law_violation);
      add("equilibrium_residual", state.equilibrium_residual);
      add("force_imbalance", state.force_imbalance);
      for (const auto &[name, part] : state.other_parts)
        add(name + "_part", part);
      add("broken_zone", state.broken_zone);
      add("dissipated_energy", state.dissipated_energy);
      for (const auto &[name, vector] : state.vectors)
        add_vector(name, vector);
      return cells;
    }



    /// What the global branch does not have is empty, under the titles of
    /// @p first.
    template <int dim>
    NamedCells
    row_of(const LoadPathStep<dim> &step, const LoadPathState<dim> &first)
    {
      NamedCells row;
      const auto add = [&row](const std::string &title, const auto &value) {
        row.emplace_back(title, CsvTable::cell(value));
      };
      add("step", step.step);
      add("factor", step.factor);
      add("displacement_factor", step.displacement_factor);
      add("status", step.status);
      append(cells_of(step.state, ""), row);
      add("iterations", step.iterations);
      add("change_factor", step.change_factor);
      NamedCells global = cells_of(step.global.value_or(first), "global_");
      if (!step.global)
        for (auto &[unused, cell] : global)
          cell.clear();
      append(global, row);
      add("global_relative_gap", step.relative_gap);
      return row;
    }



    /// A row for each step; what was not computed is left empty.
    template <int dim>
    void
    write_load_path(const std::vector<LoadPathStep<dim>> &steps,
                    const std::string                    &file_name)
    {
      const LoadPathStep<dim> first =
        steps.empty() ? LoadPathStep<dim>() : steps[0];
      const auto cells = [&](const LoadPathStep<dim> &step, const bool titles) {
        CsvTable::Row row;
        for (const auto &[title, cell] : row_of(step, first.state))
          row.push_back(titles ? CsvTable::cell(title) : cell);
        return row;
      };
      CsvTable table(cells(first, true));
      for (const LoadPathStep<dim> &step : steps)
        table.add_row(cells(step, false));
      table.write(file_name);
    }
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
