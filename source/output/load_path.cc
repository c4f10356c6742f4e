// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/base/number_text.h>
#include <debond/output/load_path.h>

namespace Debond
{
  namespace
  {
    /// The titles of write_state() with @p prefix.
    template <int dim>
    void
    write_titles(const LoadPathState<dim> &state,
                 const std::string        &prefix,
                 std::ostream             &out)
    {
      for (const char *title : {"minimum",
                                "J",
                                "elastic_energy",
                                "adhesion_energy",
                                "unit_load_work",
                                "unit_displacement_work",
                                "contact_part",
                                "bonded_part",
                                "broken_part",
                                "mean_gap",
                                "largest_gap",
                                "normal_force"})
        out << ',' << prefix << title;
      for (const char *body : {"contact", "clamped"})
        for (unsigned int d = 0; d < dim; ++d)
          out << ',' << prefix << body << "_reaction_"
              << "xyz"[d];
      for (const char *title :
           {"law_violation", "equilibrium_residual", "force_imbalance"})
        out << ',' << prefix << title;
      for (const auto &[name, part] : state.other_parts)
        out << ',' << prefix << name << "_part";
      for (const char *title : {"broken_zone", "dissipated_energy"})
        out << ',' << prefix << title;
      for (const auto &[name, vector] : state.vectors)
        for (unsigned int d = 0; d < dim; ++d)
          out << ',' << prefix << name << '_' << "xyz"[d];
    }



    template <int dim>
    void
    write_state(const LoadPathState<dim> &state, std::ostream &out)
    {
      out << ',' << state.minimum;
      for (const double number : {state.functional,
                                  state.elastic_energy,
                                  state.adhesion_energy,
                                  state.unit_load_work,
                                  state.unit_displacement_work,
                                  state.contact_part,
                                  state.bonded_part,
                                  state.broken_part,
                                  state.mean_gap,
                                  state.largest_gap,
                                  state.normal_force})
        out << ',' << shortest_text(number);
      for (const auto &reaction :
           {state.contact_reaction, state.clamped_reaction})
        for (unsigned int d = 0; d < dim; ++d)
          out << ',' << shortest_text(reaction[d]);
      for (const double number : {state.law_violation,
                                  state.equilibrium_residual,
                                  state.force_imbalance})
        out << ',' << shortest_text(number);
      for (const auto &[name, part] : state.other_parts)
        out << ',' << shortest_text(part);
      for (const double number : {state.broken_zone, state.dissipated_energy})
        out << ',' << shortest_text(number);
      for (const auto &[name, vector] : state.vectors)
        for (unsigned int d = 0; d < dim; ++d)
          out << ',' << shortest_text(vector[d]);
    }



    void
    write_optional(const std::optional<double> &number, std::ostream &out)
    {
      out << ',';
      if (number)
        out << shortest_text(*number);
    }
  } // namespace



  template <int dim>
  void
  write_load_path(const std::vector<LoadPathStep<dim>> &steps,
                  const std::string                    &file_name)
  {
    const LoadPathState<dim> first =
      steps.empty() ? LoadPathState<dim>() : steps[0].state;
    const std::size_t n_columns_of_state =
      17 + 2 * dim + first.other_parts.size() + dim * first.vectors.size();
    write_atomically(file_name, [&](std::ostream &out) {
      out << "step,factor,displacement_factor,status";
      write_titles(first, "", out);
      out << ",iterations,change_factor";
      write_titles(first, "global_", out);
      out << ",global_relative_gap\n";

      for (const LoadPathStep<dim> &step : steps)
        {
          out << step.step << ',' << shortest_text(step.factor) << ','
              << shortest_text(step.displacement_factor) << ',' << step.status;
          write_state(step.state, out);
          out << ',' << step.iterations;
          write_optional(step.change_factor, out);
          if (step.global)
            write_state(*step.global, out);
          else
            out << std::string(n_columns_of_state, ',');
          write_optional(step.relative_gap, out);
          out << '\n';
        }
    });
  }


  template void
  write_load_path(const std::vector<LoadPathStep<2>> &, const std::string &);
  template void
  write_load_path(const std::vector<LoadPathStep<3>> &, const std::string &);
} // namespace Debond
