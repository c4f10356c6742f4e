// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/output/atomic_file.h>
#include <debond/output/load_path.h>
#include <debond/output/number_text.h>

#include <algorithm>
#include <cmath>

namespace Debond
{
  template <int dim>
  LoadPathState<dim>
  load_path_state(const ElasticProblem<dim>    &problem,
                  const AdhesionIntegral<dim>  &adhesion,
                  const double                  factor,
                  const dealii::Vector<double> &u,
                  const Verification<dim>      &verification)
  {
    const auto            &nodes = problem.contact_boundary().nodes;
    dealii::Vector<double> s(static_cast<unsigned int>(nodes.size()));
    LoadPathState<dim>     state   = {};
    double                 measure = 0.;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      {
        const ContactNodeState &node = verification.nodes[i];
        s(i)                         = node.u_nu;
        measure += nodes[i].measure;
        switch (node.state)
          {
            case BondState::contact:
              state.contact_part += nodes[i].measure;
              break;
            case BondState::bonded:
            case BondState::kink:
              state.bonded_part += nodes[i].measure;
              break;
            case BondState::broken:
            case BondState::free:
              state.broken_part += nodes[i].measure;
              break;
          }
        state.mean_gap -= nodes[i].measure * node.u_nu;
        state.largest_gap = std::max(state.largest_gap, -node.u_nu);
        state.normal_force += node.normal_force;
      }
    if (measure > 0.)
      for (double *part : {&state.contact_part,
                           &state.bonded_part,
                           &state.broken_part,
                           &state.mean_gap})
        *part /= measure;

    state.elastic_energy  = problem.elastic_functional(u, 0.);
    state.adhesion_energy = adhesion.value(s);
    state.unit_load_work  = problem.load() * u;
    state.functional =
      problem.elastic_functional(u, factor) + state.adhesion_energy;

    state.contact_reaction     = verification.contact_reaction;
    state.clamped_reaction     = verification.clamped_reaction;
    state.law_violation        = verification.law_violation;
    state.equilibrium_residual = verification.equilibrium_residual;
    state.force_imbalance      = verification.force_imbalance;
    return state;
  }



  namespace
  {
    /// The titles of write_state() with @p prefix.
    template <int dim>
    void
    write_titles(const std::string &prefix, std::ostream &out)
    {
      for (const char *title : {"minimum",
                                "J",
                                "elastic_energy",
                                "adhesion_energy",
                                "unit_load_work",
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
    constexpr unsigned int n_columns_of_state = 14 + 2 * dim;
    write_atomically(file_name, [&](std::ostream &out) {
      out << "step,factor,status";
      write_titles<dim>("", out);
      out << ",iterations,change_factor";
      write_titles<dim>("global_", out);
      out << ",global_relative_gap\n";

      for (const LoadPathStep<dim> &step : steps)
        {
          out << step.step << ',' << shortest_text(step.factor) << ','
              << step.status;
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



  template <int dim>
  LoadPathTotals
  load_path_totals(const std::vector<LoadPathStep<dim>> &steps,
                   const unsigned int                    n_factors)
  {
    // Differences that are rounding.
    constexpr double tolerance = 1e-9;

    LoadPathTotals totals;
    totals.factors     = n_factors;
    totals.steps       = static_cast<unsigned int>(steps.size());
    totals.last_factor = steps.back().factor;

    double broken = 0.;
    for (const LoadPathStep<dim> &step : steps)
      {
        const BondChange change = {step.step,
                                   step.factor,
                                   step.change_factor,
                                   broken,
                                   step.state.broken_part};
        const double     growth = change.broken_after - change.broken_before;
        const auto       size   = [](const std::optional<BondChange> &other) {
          return other ? std::abs(other->broken_after - other->broken_before) :
                                 tolerance;
        };
        if (growth > size(totals.largest_break))
          totals.largest_break = change;
        if (-growth > size(totals.largest_closing))
          totals.largest_closing = change;
        broken = change.broken_after;

        if (step.global)
          {
            const double excess =
              step.state.functional - step.global->functional;
            const double scale = std::abs(step.global->functional);
            ++totals.compared;
            if (excess > tolerance * scale)
              {
                ++totals.above_global;
                totals.largest_excess =
                  std::max(totals.largest_excess, excess / scale);
              }
          }
      }
    return totals;
  }



  template LoadPathState<2>
  load_path_state(const ElasticProblem<2> &,
                  const AdhesionIntegral<2> &,
                  const double,
                  const dealii::Vector<double> &,
                  const Verification<2> &);
  template LoadPathState<3>
  load_path_state(const ElasticProblem<3> &,
                  const AdhesionIntegral<3> &,
                  const double,
                  const dealii::Vector<double> &,
                  const Verification<3> &);
  template LoadPathTotals
  load_path_totals(const std::vector<LoadPathStep<2>> &, const unsigned int);
  template LoadPathTotals
  load_path_totals(const std::vector<LoadPathStep<3>> &, const unsigned int);
  template void
  write_load_path(const std::vector<LoadPathStep<2>> &, const std::string &);
  template void
  write_load_path(const std::vector<LoadPathStep<3>> &, const std::string &);
} // namespace Debond
