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

    // Each column comes from one list with an entry for each contact node, all
    // of them in the order of the nodes, which is that of contact.mtx as well.
    // With quadratic displacements the midpoints of edges are nodes, and their
    // u_nu is a coefficient.
    const std::string xyz = "xyz";
    CsvTable          table;
    const auto       &nodes = verification.nodes;
    for (unsigned int d = 0; d < dim; ++d)
      table.add({xyz[d]}, boundary.nodes, [d](const auto &node) {
        return node.position[d];
      });
    table.add("u_nu", nodes, &ContactNodeState::u_nu);
    // The force of the node is positive where the foundation pushes and
    // negative where bonds pull. Divided by its share of the boundary, a length
    // or in 3D and with an axis an area, it is a density that can be compared
    // with the traction, which the law says at the node itself.
    table.add("normal_force", nodes, &ContactNodeState::normal_force);
    table.add("normal_force_density", boundary.nodes, [&](const auto &node) {
      const auto i = &node - boundary.nodes.data();
      return verification.nodes[i].normal_force / node.measure;
    });
    table.add("normal_traction", nodes, &ContactNodeState::normal_traction);
    // The interval of forces that the law allows at the displacement of the
    // node. It has no upper end in contact, where the number is infinite.
    table.add("allowed_lower", nodes, [](const auto &node) {
      return node.allowed_force.lower;
    });
    table.add("allowed_upper", nodes, [](const auto &node) {
      return node.allowed_force.upper;
    });
    table.add("violation", nodes, &ContactNodeState::violation);
    // Words and not numbers: the numbers of states in contact.vtu depend on the
    // law from 6 on.
    table.add("state", nodes, [&](const auto &node) {
      return verification.name(node.state);
    });
    for (unsigned int d = 0; d < dim; ++d)
      table.add(std::string("tangential_force_") + xyz[d],
                verification.tangential_forces,
                [d](const auto &force) { return force[d]; });
    // Columns that only bonds in shear have come before those that all scenes
    // end with. The force along the boundary is a vector above; its size, over
    // the share of the node, is here.
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
    if (verification.has_friction)
      table.add("slides", nodes, [](const auto &node) {
        return node.slides.value_or(false) ? 1 : 0;
      });
    table.add("bond_stiffness", nodes, &ContactNodeState::bond_stiffness);
    table.add("bond_threshold", nodes, &ContactNodeState::bond_threshold);
    table.add("damage", nodes, &ContactNodeState::damage);
    table.add("initial_gap", boundary.nodes, [](const auto &node) {
      return node.gap;
    });
    // Without a load path there is no list, and no column.
    if (!verification.breaks.empty())
      {
        table.add("broken_at", verification.breaks, &BondBreak::factor);
        if (!verification.slips.empty())
          table.add("broken_mode", verification.breaks, &BondBreak::mode);
      }
    table.write(file_name);
  }



  void
  write_history(const std::vector<BundleIteration> &history,
                const std::optional<double>        &found,
                const std::string                  &file_name)
  {
    // v_k is negative, the descent that the direction problem predicts. The
    // step is t_L, which is 0 in a null step, and the new subgradient was
    // computed at t_R. The row of a state that was found later has only its
    // number, its J and its kind.
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
    // The residual is that of the optimality conditions, relative to the
    // largest force on a contact node. Linear iterations are 0 if the systems
    // were factorised. The contact nodes are the bounds that are active.
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
    // A row for each time at which the proof has told its progress: the nodes
    // of its tree so far and those that wait, the lower bound of J and the best
    // J so far, and the seconds since it began.
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
