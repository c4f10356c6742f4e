// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/output/csv_table.h>
#include <debond/output/tables.h>

namespace Debond
{
  template <int dim>
  void
  write_contact_profile(const ContactBoundary<dim> &boundary,
                        const Verification<dim>    &verification,
                        const std::string          &file_name)
  {
    AssertDimension(boundary.nodes.size(), verification.nodes.size());

    const char *const xyz = "xyz";
    CsvTable::Row     titles;
    for (unsigned int d = 0; d < dim; ++d)
      titles.push_back({xyz[d]});
    for (const char *const title : {"u_nu",
                                    "normal_force",
                                    "normal_force_density",
                                    "allowed_lower",
                                    "allowed_upper",
                                    "violation",
                                    "state"})
      titles.push_back(title);
    for (unsigned int d = 0; d < dim; ++d)
      titles.push_back(std::string("tangential_force_") + xyz[d]);
    for (const char *const title :
         {"bond_stiffness", "bond_threshold", "initial_gap"})
      titles.push_back(title);

    CsvTable table(titles);
    for (unsigned int i = 0; i < boundary.nodes.size(); ++i)
      {
        const auto             &node  = boundary.nodes[i];
        const ContactNodeState &state = verification.nodes[i];
        CsvTable::Row           row;
        const auto              add = [&row](const double number) {
          row.push_back(CsvTable::cell(number));
        };
        for (unsigned int d = 0; d < dim; ++d)
          add(node.position[d]);
        for (const double number : {state.u_nu,
                                    state.normal_force,
                                    state.normal_force / node.measure,
                                    state.allowed_force.lower,
                                    state.allowed_force.upper,
                                    state.violation})
          add(number);
        row.push_back(CsvTable::cell(verification.name(state.state)));
        for (unsigned int d = 0; d < dim; ++d)
          add(verification.tangential_forces[i][d]);
        for (const double number :
             {state.bond_stiffness, state.bond_threshold, node.gap})
          add(number);
        table.add_row(row);
      }
    table.write(file_name);
  }



  void
  write_certified_sides(const Certificate &certificate,
                        const AdhesiveLaw &law,
                        const std::string &file_name)
  {
    CsvTable table({"x0",
                    "y0",
                    "x1",
                    "y1",
                    "least_mean",
                    "largest_mean",
                    "least_linear",
                    "largest_linear",
                    "state"});
    for (const CertifiedSide &side : certificate.sides)
      table.add_row(side.ends[0][0],
                    side.ends[0][1],
                    side.ends[1][0],
                    side.ends[1][1],
                    side.mean.lower,
                    side.mean.upper,
                    side.linear().lower,
                    side.linear().upper,
                    side.piece ? law.name(*side.piece) : "uncertain");
    table.write(file_name);
  }



  void
  write_history(const std::vector<BundleIteration> &history,
                const std::optional<double>        &found,
                const std::string                  &file_name)
  {
    CsvTable table({"iteration",
                    "functional",
                    "v",
                    "t_L",
                    "t_R",
                    "bundle_size",
                    "qp_steps",
                    "kind"});
    for (const BundleIteration &step : history)
      table.add_row(step.iteration,
                    step.functional,
                    step.v,
                    step.t_L,
                    step.t_R,
                    step.bundle_size,
                    step.qp_steps,
                    to_string(step.kind));
    if (found)
      table.add_row(history.size() + 1, *found, "", "", "", "", "", "search");
    table.write(file_name);
  }



  void
  write_history(const std::vector<MajoriseMinimiseIteration> &history,
                const std::optional<double>                  &found,
                const std::string                            &file_name)
  {
    CsvTable table({"iteration",
                    "functional",
                    "residual",
                    "active_set_steps",
                    "linear_iterations",
                    "contact_nodes"});
    for (const MajoriseMinimiseIteration &step : history)
      table.add_row(step.iteration,
                    step.functional,
                    step.residual,
                    step.active_set_steps,
                    step.linear_iterations,
                    step.n_active);
    if (found)
      table.add_row(history.size() + 1, *found);
    table.write(file_name);
  }



  void
  write_history(const std::vector<ProofProgress> &history,
                const std::string                &file_name)
  {
    CsvTable table({"nodes", "open", "lower_bound", "functional", "seconds"});
    for (const ProofProgress &step : history)
      table.add_row(
        step.nodes, step.open, step.lower, step.upper, step.seconds);
    table.write(file_name);
  }



  template decltype(write_contact_profile<2>) write_contact_profile<2>;
  template decltype(write_contact_profile<3>) write_contact_profile<3>;
} // namespace Debond
