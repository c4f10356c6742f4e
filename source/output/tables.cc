// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
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

    const std::string xyz = "xyz";
    CsvTable          table;
    const auto       &nodes = verification.nodes;
    for (unsigned int d = 0; d < dim; ++d)
      table.add({xyz[d]}, boundary.nodes, [d](const auto &node) {
        return node.position[d];
      });
    table.add("u_nu", nodes, &ContactNodeState::u_nu);
    table.add("normal_force", nodes, &ContactNodeState::normal_force);
    table.add("normal_force_density", boundary.nodes, [&](const auto &node) {
      const auto i = &node - boundary.nodes.data();
      return verification.nodes[i].normal_force / node.measure;
    });
    table.add("normal_traction", nodes, &ContactNodeState::normal_traction);
    table.add("allowed_lower", nodes, [](const auto &node) {
      return node.allowed_force.lower;
    });
    table.add("allowed_upper", nodes, [](const auto &node) {
      return node.allowed_force.upper;
    });
    table.add("violation", nodes, &ContactNodeState::violation);
    table.add("state", nodes, [&](const auto &node) {
      return verification.name(node.state);
    });
    for (unsigned int d = 0; d < dim; ++d)
      table.add(std::string("tangential_force_") + xyz[d],
                verification.tangential_forces,
                [d](const auto &force) { return force[d]; });
    if (!verification.slips.empty())
      {
        for (unsigned int d = 0; d < dim; ++d)
          table.add(std::string("slip_") + xyz[d],
                    verification.slips,
                    [d](const auto &slip) { return slip[d]; });
        table.add("shear_force_density", boundary.nodes, [&](const auto &node) {
          const auto i = &node - boundary.nodes.data();
          return verification.tangential_forces[i].norm() / node.measure;
        });
        table.add("shear_traction",
                  verification.shear_tractions,
                  [](const auto &traction) { return traction.norm(); });
        table.add("mode_mixity", nodes, [](const auto &node) {
          return node.mode_mixity.value_or(0.);
        });
        table.add("shear_damage", nodes, &ContactNodeState::shear_damage);
      }
    table.add("bond_stiffness", nodes, &ContactNodeState::bond_stiffness);
    table.add("bond_threshold", nodes, &ContactNodeState::bond_threshold);
    table.add("damage", nodes, &ContactNodeState::damage);
    table.add("initial_gap", boundary.nodes, [](const auto &node) {
      return node.gap;
    });
    table.write(file_name);
  }



  void
  write_history(const std::vector<BundleIteration> &history,
                const std::optional<double>        &found,
                const std::string                  &file_name)
  {
    CsvTable table;
    table.add("iteration", history, &BundleIteration::iteration);
    table.add("functional", history, &BundleIteration::functional);
    table.add("v", history, &BundleIteration::v);
    table.add("t_L", history, &BundleIteration::t_L);
    table.add("t_R", history, &BundleIteration::t_R);
    table.add("bundle_size", history, &BundleIteration::bundle_size);
    table.add("qp_steps", history, &BundleIteration::qp_steps);
    table.add("kind", history, [](const auto &step) {
      return to_string(step.kind);
    });
    if (found)
      table.add_row(history.size() + 1, *found, "", "", "", "", "", "search");
    table.write(file_name);
  }



  void
  write_history(const std::vector<MajoriseMinimiseIteration> &history,
                const std::optional<double>                  &found,
                const std::string                            &file_name)
  {
    CsvTable table;
    table.add("iteration", history, &MajoriseMinimiseIteration::iteration);
    table.add("functional", history, &MajoriseMinimiseIteration::functional);
    table.add("residual", history, &MajoriseMinimiseIteration::residual);
    table.add("active_set_steps",
              history,
              &MajoriseMinimiseIteration::active_set_steps);
    table.add("linear_iterations",
              history,
              &MajoriseMinimiseIteration::linear_iterations);
    table.add("contact_nodes", history, &MajoriseMinimiseIteration::n_active);
    if (found)
      table.add_row(history.size() + 1, *found);
    table.write(file_name);
  }



  void
  write_history(const std::vector<ProofProgress> &history,
                const std::string                &file_name)
  {
    CsvTable table;
    table.add("nodes", history, &ProofProgress::nodes);
    table.add("open", history, &ProofProgress::open);
    table.add("lower_bound", history, &ProofProgress::lower);
    table.add("functional", history, &ProofProgress::upper);
    table.add("seconds", history, &ProofProgress::seconds);
    table.write(file_name);
  }



  DEBOND_INSTANTIATE(write_contact_profile);
} // namespace Debond
