// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/base/text.h>
#include <debond/check/broken_zone.h>
#include <debond/contact/adhesion_sums.h>
#include <debond/mesh/owned_cells.h>
#include <debond/solve/path/load_path_state.h>

namespace Debond
{
  namespace
  {
    /// LoadPathState::unit_displacement_work.
    template <int dim>
    double
    work_of_supports(const ElasticProblem<dim>   &problem,
                     const AdhesionIntegral<dim> &adhesion,
                     const LoadFactors            factors,
                     const DofVector             &u,
                     const VectorView            &s)
    {
      const ElasticUnknowns<dim> &unknowns = problem.unknowns();
      if (!unknowns.has_prescribed_displacements())
        return 0.;
      // The lifting of the prescribed displacements alone, without the gap,
      // which has no factor. Vertices of the contact boundary that are held
      // have a bond whose force belongs to this work as well.
      DofVector displacement = unknowns.lifting({0., 1.});
      displacement -= unknowns.lifting({0., 0.});
      double sum = problem.fields().residual(u, factors) * displacement;
      const std::vector<double> forces = held_forces(adhesion, s);
      const auto &held = unknowns.contact().boundary().held_vertices;
      for (unsigned int k = 0; k < held.size(); ++k)
        sum += forces[k] * held[k].normal_displacement;
      return sum;
    }



    /// LoadPathState::cell_size_at_edge.
    template <int dim>
    double
    cell_size_at_edge(const ElasticProblem<dim>   &problem,
                      const AdhesionIntegral<dim> &adhesion,
                      const Verification<dim>     &verification)
    {
      const ElasticUnknowns<dim> &unknowns = problem.unknowns();
      const auto                 &boundary = unknowns.contact().boundary();
      // Bonds that soften share their load over another length, E' G /
      // strength^2.
      if (adhesion.softens())
        return 0.;

      // By cell the stiffness of bonds times the size of a face if some of its
      // nodes have a bond and others have none: there a front may be, and E*/a
      // has to be resolved. Of bonds that shear the stiffer direction has the
      // shorter length.
      std::vector<double> at_edge(
        unknowns.dof_handler().get_triangulation().n_global_active_cells());
      for (const auto &face : boundary.faces)
        {
          bool   are_gone  = false;
          double stiffness = 0.;
          for (unsigned int k = 0; k < boundary.n_face_nodes(); ++k)
            if (!face.is_held(k))
              {
                const ContactNodeState &node = verification.nodes[face.node(k)];
                if (node.branch == BondState::broken ||
                    node.branch == BondState::free)
                  are_gone = true;
                else
                  stiffness = std::max(
                    stiffness,
                    node.bond_stiffness *
                      std::max(1.,
                               adhesion.points().bonds_at(face.node(k)).shear));
              }
          if (are_gone)
            at_edge[face.cell] = stiffness * face.size();
        }
      double largest = 0.;
      // Faces are known to all ranks, materials to the rank that owns the cell.
      // E* is E / (1 - nu^2) in plane stress too, hence the modulus of the
      // solid.
      for (const auto &cell : owned_cells(unknowns.dof_handler()))
        if (const double of_cell = at_edge[cell->id().get_coarse_cell_id()];
            of_cell > 0.)
          largest = std::max(
            largest,
            of_cell /
              problem.fields().material(cell).template plane_modulus<3>());
      return dealii::Utilities::MPI::max(largest, unknowns.communicator());
    }



    /// The parts of the contact boundary in each state of bonds, with the mean
    /// gap and the sum of the normal forces.
    template <int dim>
    void
    add_parts(const AdhesionIntegral<dim> &adhesion,
              const Verification<dim>     &verification,
              const std::vector<typename ContactBoundary<dim>::Node> &nodes,
              LoadPathState<dim>                                     &state)
    {
      double measure = 0.;
      // Columns have to be the same at all steps, so that states that the law
      // can have are listed even if no node is in them.
      state.other_parts.emplace_back(verification.name(BondState::free), 0.);
      for (std::size_t k = first_of_law; k < verification.state_names.size();
           ++k)
        state.other_parts.emplace_back(as_title(verification.state_names[k]),
                                       0.);
      // Without adhesion what is open counts as broken, as nothing holds it. If
      // some of the boundary has bonds, what has none has a part of its own
      // beside what is broken.
      const auto part = [&](const BondState branch) -> double & {
        switch (branch)
          {
            case BondState::contact:
              return state.contact_part;
            case BondState::bonded:
              return state.bonded_part;
            case BondState::broken:
              return state.broken_part;
            case BondState::free:
              return adhesion.adhesive_law().is_loose(0) ?
                       state.broken_part :
                       state.other_parts[0].second;
            default:
              return state.other_parts[index_of(branch) - first_of_law + 1]
                .second;
          }
      };

      const std::size_t stick = state.other_parts.size();
      if (adhesion.kinks().weight.size() > 0)
        state.other_parts.emplace_back("stick", 0.);
      const bool breaks_separately =
        std::any_of(adhesion.points().list().begin(),
                    adhesion.points().list().end(),
                    [](const auto &point) { return point.n_entries == 0; });
      if (breaks_separately)
        state.other_parts.emplace_back("broken_in_shear", 0.);
      for (unsigned int i = 0; i < nodes.size(); ++i)
        {
          if (breaks_separately && verification.nodes[i].shear_damage == 1.)
            state.other_parts.back().second += nodes[i].measure;
          if (verification.nodes[i].slides == false)
            state.other_parts[stick].second += nodes[i].measure;
          // Each node counts with the measure of the boundary that its bonds
          // stand for.
          const ContactNodeState &node = verification.nodes[i];
          measure += nodes[i].measure;
          // A closed node is in contact, whatever its bonds are, unless it may
          // slide: then it is as broken as if it were open, and has the part of
          // its branch.
          const bool is_closed =
            node.state == BondState::contact ||
            (node.state == BondState::broken_but_closed && !node.mode_mixity);
          part(is_closed ? BondState::contact : node.branch) +=
            nodes[i].measure;
          state.mean_gap -= nodes[i].measure * node.s;
          state.normal_force += node.normal_force;
        }
      // Sums over nodes become parts of the whole contact boundary, and the gap
      // its mean. The normal force remains a sum.
      if (measure > 0.)
        {
          for (double *number : {&state.contact_part,
                                 &state.bonded_part,
                                 &state.broken_part,
                                 &state.mean_gap})
            *number /= measure;
          for (auto &[name, other] : state.other_parts)
            other /= measure;
        }
    }
  } // namespace



  template <int dim>
  LoadPathState<dim>
  load_path_state(const ElasticProblem<dim>   &problem,
                  const AdhesionIntegral<dim> &adhesion,
                  const LoadFactors            factors,
                  const DofVector             &u,
                  const Verification<dim>     &verification)
  {
    const auto           &nodes = problem.unknowns().contact().boundary().nodes;
    const Eigen::VectorXd s     = problem.unknowns().contact().trace(u);
    LoadPathState<dim>    state = {};

    add_parts(adhesion, verification, nodes, state);
    // With degree 2 a coefficient of an edge is no displacement, and the
    // largest gap is that of the quadratic.
    const auto &boundary = problem.unknowns().contact().boundary();
    if (boundary.degree == 1)
      state.largest_gap = verification.largest_opening;
    else
      for (const auto &face : boundary.faces)
        state.largest_gap = std::max(
          state.largest_gap,
          -range_on_simplex<dim>(adhesion.points().trace_on(face, s), 2).first);
    // Energies are integrals of strains and no products with A, whose rows
    // nearly cancel.
    state.elastic_energy  = problem.fields().strain_energy(u, factors);
    state.adhesion_energy = adhesion.value(s);
    state.unit_load_work  = problem.fields().load_work(u, factors);
    state.unit_displacement_work =
      work_of_supports(problem, adhesion, factors, u, s);
    state.functional =
      problem.fields().elastic_functional(u, factors) + state.adhesion_energy;

    // What the verification has computed from the stresses is copied, so that
    // the table of a path shows how good each of its states is.
    state.contact_reaction     = verification.contact_reaction;
    state.clamped_reaction     = verification.clamped_reaction;
    state.law_violation        = verification.law_violation;
    state.equilibrium_residual = verification.equilibrium_residual;
    state.force_imbalance      = verification.force_imbalance;
    state.broken_zone          = verification.broken_zone;
    state.fronts               = fronts(boundary, adhesion, s);
    state.cell_size_at_edge =
      cell_size_at_edge(problem, adhesion, verification);
    // With what friction takes in this step.
    state.dissipated_energy =
      adhesion.dissipated_energy() + adhesion.kinks().value(s);
    for (const auto &[name, vector] : verification.reactions)
      state.vectors.emplace_back("reaction_" + as_title(name), vector);
    return state;
  }


  DEBOND_INSTANTIATE(load_path_state);
} // namespace Debond
