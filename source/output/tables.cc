// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/data_table.h>
#include <debond/output/tables.h>

#include <initializer_list>

namespace Debond
{
  namespace
  {
    DataTable
    table_with(const std::initializer_list<const char *> &titles)
    {
      DataTable table;
      for (const char *const title : titles)
        table.add_column(title);
      return table;
    }



    Cell
    count(const std::size_t number)
    {
      return static_cast<long>(number);
    }



    /// The row of what a search or a proof put in the place of the last of
    /// @p n_steps iterates, in a history with @p n_columns columns.
    std::vector<Cell>
    row_of_found(const std::size_t n_steps,
                 const double      functional,
                 const std::size_t n_columns)
    {
      std::vector<Cell> row(n_columns);
      row[0] = count(n_steps + 1);
      row[1] = functional;
      return row;
    }
  } // namespace



  template <int dim>
  void
  write_contact_profile(const ContactBoundary<dim> &boundary,
                        const Verification<dim>    &verification,
                        const std::string          &file_name)
  {
    AssertDimension(boundary.nodes.size(), verification.nodes.size());

    DataTable table;
    for (unsigned int d = 0; d < dim; ++d)
      table.add_column({"xyz"[d]});
    for (const char *const title : {"u_nu",
                                    "normal_force",
                                    "normal_force_density",
                                    "allowed_lower",
                                    "allowed_upper",
                                    "violation",
                                    "state"})
      table.add_column(title);
    for (unsigned int d = 0; d < dim; ++d)
      table.add_column(std::string("tangential_force_") + "xyz"[d]);
    for (const char *const title :
         {"bond_stiffness", "bond_threshold", "initial_gap"})
      table.add_column(title);

    for (unsigned int i = 0; i < boundary.nodes.size(); ++i)
      {
        const auto             &node  = boundary.nodes[i];
        const ContactNodeState &state = verification.nodes[i];
        std::vector<Cell>       row;
        for (unsigned int d = 0; d < dim; ++d)
          row.emplace_back(node.position[d]);
        for (const double number : {state.u_nu,
                                    state.normal_force,
                                    state.normal_force / node.measure,
                                    state.allowed_force.lower,
                                    state.allowed_force.upper,
                                    state.violation})
          row.emplace_back(number);
        row.emplace_back(verification.name(state.state));
        for (unsigned int d = 0; d < dim; ++d)
          row.emplace_back(verification.tangential_forces[i][d]);
        for (const double number :
             {state.bond_stiffness, state.bond_threshold, node.gap})
          row.emplace_back(number);
        table.add_row(row);
      }
    table.write_csv(file_name);
  }



  void
  write_certified_sides(const Certificate &certificate,
                        const AdhesiveLaw &law,
                        const std::string &file_name)
  {
    DataTable table = table_with({"x0",
                                  "y0",
                                  "x1",
                                  "y1",
                                  "least_mean",
                                  "largest_mean",
                                  "least_linear",
                                  "largest_linear",
                                  "state"});
    for (const CertifiedSide &side : certificate.sides)
      table.add_row({side.ends[0][0],
                     side.ends[0][1],
                     side.ends[1][0],
                     side.ends[1][1],
                     side.mean.lower,
                     side.mean.upper,
                     side.linear().lower,
                     side.linear().upper,
                     side.piece ? law.name(*side.piece) : "uncertain"});
    table.write_csv(file_name);
  }



  void
  write_history(const std::vector<BundleIteration> &history,
                const std::optional<double>        &found,
                const std::string                  &file_name)
  {
    DataTable table = table_with({"iteration",
                                  "functional",
                                  "v",
                                  "t_L",
                                  "t_R",
                                  "bundle_size",
                                  "qp_steps",
                                  "kind"});
    for (const BundleIteration &step : history)
      table.add_row({count(step.iteration),
                     step.functional,
                     step.v,
                     step.t_L,
                     step.t_R,
                     count(step.bundle_size),
                     count(step.qp_steps),
                     to_string(step.kind)});
    if (found)
      {
        std::vector<Cell> row = row_of_found(history.size(), *found, 8);
        row.back()            = "search";
        table.add_row(row);
      }
    table.write_csv(file_name);
  }



  void
  write_history(const std::vector<MajoriseMinimiseIteration> &history,
                const std::optional<double>                  &found,
                const std::string                            &file_name)
  {
    DataTable table = table_with({"iteration",
                                  "functional",
                                  "residual",
                                  "active_set_steps",
                                  "linear_iterations",
                                  "contact_nodes"});
    for (const MajoriseMinimiseIteration &step : history)
      table.add_row({count(step.iteration),
                     step.functional,
                     step.residual,
                     count(step.active_set_steps),
                     count(step.linear_iterations),
                     count(step.n_active)});
    if (found)
      table.add_row(row_of_found(history.size(), *found, 6));
    table.write_csv(file_name);
  }



  void
  write_history(const std::vector<ProofProgress> &history,
                const std::string                &file_name)
  {
    DataTable table =
      table_with({"nodes", "open", "lower_bound", "functional", "seconds"});
    for (const ProofProgress &step : history)
      table.add_row({count(step.nodes),
                     count(step.open),
                     step.lower,
                     step.upper,
                     step.seconds});
    table.write_csv(file_name);
  }



  template decltype(write_contact_profile<2>) write_contact_profile<2>;
  template decltype(write_contact_profile<3>) write_contact_profile<3>;
} // namespace Debond
