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



    /// "0.2 0; 0.31 0"
    template <int dim>
    std::string
    fronts_of(const LoadPathState<dim> &state)
    {
      std::string text;
      for (const dealii::Point<dim> &front : state.fronts)
        for (unsigned int d = 0; d < dim; ++d)
          text += (d > 0        ? " " :
                   text.empty() ? "" :
                                  "; ") +
                  shortest_text(front[d]);
      return text;
    }



    /// The columns of the states that @p state_of finds in the steps, empty
    /// where it is null; @p first tells what states have names for.
    template <int dim, typename StateOf>
    void
    add_states(const std::vector<LoadPathStep<dim>> &steps,
               const LoadPathState<dim>             &first,
               const std::string                    &prefix,
               const StateOf                        &state_of,
               CsvTable                             &table)
    {
      using State    = LoadPathState<dim>;
      const auto add = [&](const std::string &title, const auto &value) {
        table.add(prefix + title, steps, [&](const LoadPathStep<dim> &step) {
          const State *const state = state_of(step);
          return state == nullptr ?
                   std::nullopt :
                   std::make_optional(std::invoke(value, *state));
        });
      };
      const auto add_vector = [&](const std::string &title, const auto &value) {
        for (unsigned int d = 0; d < dim; ++d)
          add(title + '_' + "xyz"[d], [&value, d](const State &state) {
            return std::invoke(value, state)[d];
          });
      };
      add("minimum", &State::minimum);
      add("J", &State::functional);
      add("elastic_energy", &State::elastic_energy);
      add("adhesion_energy", &State::adhesion_energy);
      add("unit_load_work", &State::unit_load_work);
      add("unit_displacement_work", &State::unit_displacement_work);
      add("contact_part", &State::contact_part);
      add("bonded_part", &State::bonded_part);
      add("broken_part", &State::broken_part);
      add("mean_gap", &State::mean_gap);
      add("largest_gap", &State::largest_gap);
      add("normal_force", &State::normal_force);
      add_vector("contact_reaction", &State::contact_reaction);
      add_vector("clamped_reaction", &State::clamped_reaction);
      add("law_violation", &State::law_violation);
      add("equilibrium_residual", &State::equilibrium_residual);
      add("force_imbalance", &State::force_imbalance);
      for (std::size_t k = 0; k < first.other_parts.size(); ++k)
        add(first.other_parts[k].first + "_part",
            [k](const State &state) { return state.other_parts[k].second; });
      add("broken_zone", &State::broken_zone);
      add("fronts", &fronts_of<dim>);
      add("cell_size_at_edge", &State::cell_size_at_edge);
      add("dissipated_energy", &State::dissipated_energy);
      for (std::size_t k = 0; k < first.vectors.size(); ++k)
        add_vector(first.vectors[k].first,
                   [k](const State &state) { return state.vectors[k].second; });
    }



    /// A row for each step; what was not computed is left empty.
    template <int dim>
    void
    write_load_path(const std::vector<LoadPathStep<dim>> &steps,
                    const std::string                    &file_name)
    {
      using Step = LoadPathStep<dim>;
      const LoadPathState<dim> first =
        steps.empty() ? LoadPathState<dim>() : steps[0].state;
      CsvTable   table;
      const auto add = [&](const std::string &title, const auto &value) {
        table.add(title, steps, value);
      };
      add("step", &Step::step);
      add("factor", &Step::factor);
      add("displacement_factor", &Step::displacement_factor);
      add("status", &Step::status);
      add_states(
        steps, first, "", [](const Step &step) { return &step.state; }, table);
      add("iterations", &Step::iterations);
      add("change_factor", &Step::change_factor);
      add_states(
        steps,
        first,
        "global_",
        [](const Step &step) { return step.global ? &*step.global : nullptr; },
        table);
      add("global_relative_gap", &Step::relative_gap);
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
