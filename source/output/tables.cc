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

    const std::string xyz = "xyz";
    CsvTable          table;
    const auto add_of_node = [&](const std::string &title, const auto &value) {
      table.add(title, boundary.nodes, value);
    };
    const auto add = [&](const std::string &title, const auto &value) {
      table.add(title, verification.nodes, value);
    };
    for (unsigned int d = 0; d < dim; ++d)
      add_of_node({xyz[d]}, [d](const auto &node) { return node.position[d]; });
    add("u_nu", &ContactNodeState::u_nu);
    add("normal_force", &ContactNodeState::normal_force);
    add_of_node("normal_force_density", [&](const auto &node) {
      const auto i = &node - boundary.nodes.data();
      return verification.nodes[i].normal_force / node.measure;
    });
    add("allowed_lower",
        [](const auto &node) { return node.allowed_force.lower; });
    add("allowed_upper",
        [](const auto &node) { return node.allowed_force.upper; });
    add("violation", &ContactNodeState::violation);
    add("state",
        [&](const auto &node) { return verification.name(node.state); });
    for (unsigned int d = 0; d < dim; ++d)
      table.add(std::string("tangential_force_") + xyz[d],
                verification.tangential_forces,
                [d](const auto &force) { return force[d]; });
    add("bond_stiffness", &ContactNodeState::bond_stiffness);
    add("bond_threshold", &ContactNodeState::bond_threshold);
    add("damage", &ContactNodeState::damage);
    add_of_node("initial_gap", [](const auto &node) { return node.gap; });
    table.write(file_name);
  }



  void
  write_history(const std::vector<BundleIteration> &history,
                const std::optional<double>        &found,
                const std::string                  &file_name)
  {
    CsvTable   table;
    const auto add = [&](const std::string &title, const auto &value) {
      table.add(title, history, value);
    };
    add("iteration", &BundleIteration::iteration);
    add("functional", &BundleIteration::functional);
    add("v", &BundleIteration::v);
    add("t_L", &BundleIteration::t_L);
    add("t_R", &BundleIteration::t_R);
    add("bundle_size", &BundleIteration::bundle_size);
    add("qp_steps", &BundleIteration::qp_steps);
    add("kind", [](const auto &step) { return to_string(step.kind); });
    if (found)
      table.add_row(history.size() + 1, *found, "", "", "", "", "", "search");
    table.write(file_name);
  }



  void
  write_history(const std::vector<MajoriseMinimiseIteration> &history,
                const std::optional<double>                  &found,
                const std::string                            &file_name)
  {
    CsvTable   table;
    const auto add = [&](const std::string &title, const auto &value) {
      table.add(title, history, value);
    };
    add("iteration", &MajoriseMinimiseIteration::iteration);
    add("functional", &MajoriseMinimiseIteration::functional);
    add("residual", &MajoriseMinimiseIteration::residual);
    add("active_set_steps", &MajoriseMinimiseIteration::active_set_steps);
    add("linear_iterations", &MajoriseMinimiseIteration::linear_iterations);
    add("contact_nodes", &MajoriseMinimiseIteration::n_active);
    if (found)
      table.add_row(history.size() + 1, *found);
    table.write(file_name);
  }



  void
  write_history(const std::vector<ProofProgress> &history,
                const std::string                &file_name)
  {
    CsvTable   table;
    const auto add = [&](const std::string &title, const auto &value) {
      table.add(title, history, value);
    };
    add("nodes", &ProofProgress::nodes);
    add("open", &ProofProgress::open);
    add("lower_bound", &ProofProgress::lower);
    add("functional", &ProofProgress::upper);
    add("seconds", &ProofProgress::seconds);
    table.write(file_name);
  }



  template decltype(write_contact_profile<2>) write_contact_profile<2>;
  template decltype(write_contact_profile<3>) write_contact_profile<3>;
} // namespace Debond
