// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/append.h>
#include <debond/output/csv_table.h>
#include <debond/output/load_path.h>

#include <utility>

namespace Debond
{
  namespace
  {
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
  } // namespace



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



  template decltype(write_load_path<2>) write_load_path<2>;
  template decltype(write_load_path<3>) write_load_path<3>;
} // namespace Debond
