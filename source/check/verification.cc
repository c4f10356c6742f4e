// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/infinity.h>
#include <debond/base/instantiate.h>
#include <debond/check/broken_zone.h>
#include <debond/check/force_balance.h>
#include <debond/check/law_violation.h>
#include <debond/contact/adhesion_sums.h>

namespace Debond
{
  template <int dim>
  double
  Verification<dim>::error() const
  {
    // Were all forces rounding, they would balance whatever u is. The
    // comparisons of std::max would lose a NaN.
    if (!(force_rounding <= Tolerance::force_rounding))
      return infinity;
    return std::isfinite(equilibrium_residual + force_imbalance +
                         law_violation) ?
             std::max({equilibrium_residual, force_imbalance, law_violation}) :
             infinity;
  }



  template <int dim>
  std::string
  Verification<dim>::failure(const double tolerance,
                             const bool   is_iterative) const
  {
    std::ostringstream text;
    text.precision(3);
    const std::string advice =
      ". Are bonds, loads and gaps in the units of the Young modulus?";
    if (!(force_rounding <= Tolerance::force_rounding))
      text << "verification: rounding of the displacements makes forces of "
           << force_rounding << " of the largest one, required is at most "
           << Tolerance::force_rounding << advice;
    else
      {
        text << "verification: the largest of residual, force imbalance and "
                "contact law violation is "
             << error() << ", required is at most " << tolerance;
        if (force_rounding <= 0.1 * tolerance)
          text << (is_iterative ? ". Try a smaller stop tolerance." : ".");
        else
          text << ", and rounding of the displacements alone makes forces of "
                  "up to "
               << force_rounding << " of the largest one" << advice;
      }
    return text.str();
  }



  template <int dim>
  unsigned int
  Verification<dim>::count(const BondState state) const
  {
    return static_cast<unsigned int>(std::count_if(
      nodes.begin(), nodes.end(), [&](const ContactNodeState &node) {
        return node.state == state;
      }));
  }



  template <int dim>
  const std::string &
  Verification<dim>::name(const BondState state) const
  {
    return state_names[index_of(state)];
  }



  namespace
  {
    /// Sets the state of node @p i from its displacement and force. @p
    /// largest_s: of all nodes.
    template <int dim>
    void
    set_state(const unsigned int           i,
              const AdhesionIntegral<dim> &adhesion,
              const LawScale              &scale,
              const double                 largest_s,
              const double                 tolerance,
              Verification<dim>           &result)
    {
      // The branch follows from the opening alone, and from what bonds have
      // left for good. The state is contact if s is zero within a tolerance, or
      // if a gap under pressure is as small as the violation of the node; else
      // it is a kink if the opening is at an end of a piece, and otherwise the
      // branch.
      const BondScale        bonds       = adhesion.points().bonds_at(i);
      const AdhesiveLaw     &law         = *bonds.law;
      const PiecewiseEnergy &branches    = law.pieces();
      const unsigned int     least_piece = adhesion.least_piece(i);
      ContactNodeState      &node        = result.nodes[i];
      const auto             state_of    = [&](const unsigned int piece) {
        return state_named(law.name(piece), result.state_names);
      };
      node.branch =
        bonds.energy == 0. ?
          BondState::free :
          state_of(std::max(least_piece,
                            branches.index(-node.opening / bonds.length)));
      const double threshold = first_threshold(law) * bonds.length;
      // The tolerance is relative to the first threshold, but not above the
      // largest displacement, as a threshold may be far above all of them; and
      // what rounding of forces is in displacements counts as closed as well.
      const double no_gap =
        std::max(scale.rounding,
                 tolerance * (threshold > 0. ? std::min(threshold, largest_s) :
                                               largest_s));
      // A small gap under pressure is contact that an iterative method has not
      // closed yet: contact has to be within delta L_i, with the delta of the
      // node's violation, and that within 1e-3.
      const double gap =
        std::max(tolerance,
                 std::min(Tolerance::open_contact, 1.01 * node.violation));
      if (node.s >= -no_gap ||
          (node.normal_force > 0. && node.s >= -gap * scale.length))
        {
          // What is closed may slide, and soften or break by it: then it has
          // the state of its bonds. It is broken but closed if the bonds have
          // broken for good or in shear, and in contact otherwise.
          node.state = node.branch == BondState::broken &&
                           (least_piece > 0 || node.mode_mixity) ?
                         BondState::broken_but_closed :
                       node.opening > no_gap && node.branch > BondState::held ?
                         node.branch :
                         BondState::contact;
          return;
        }
      node.state = node.branch;
      for (unsigned int k = least_piece + 1;
           k < branches.size() && bonds.energy > 0.;
           ++k)
        {
          // The kinks that the bond can still come to. At a kink the branch is
          // the piece on the side of 0.
          const double kink = branches[k].upper * bonds.length;
          if (std::abs(-node.opening - kink) <= tolerance * std::abs(kink))
            {
              node.state  = BondState::kink;
              node.branch = state_of(k - 1);
            }
        }
    }



    /// Sets the tractions at node @p i, whose state is known. @p by_law:
    /// node_tractions().
    template <int dim>
    void
    set_tractions(const unsigned int            i,
                  const AdhesionIntegral<dim>  &adhesion,
                  const Eigen::VectorXd        &forces,
                  const Jump<dim>              &by_law,
                  const dealii::Tensor<1, dim> &slip,
                  Verification<dim>            &result)
    {
      // At contact and kinks the graph of the law is vertical, so that only the
      // force tells the traction. Elsewhere the traction is that of the law at
      // the node itself, while the force is a mean around the node.
      ContactNodeState &node     = result.nodes[i];
      const BondScale   bonds    = adhesion.points().bonds_at(i);
      const bool        by_force = node.normal_force > 0. ||
                            node.state == BondState::contact ||
                            node.state == BondState::kink;
      node.normal_traction =
        by_force ?
          node.normal_force / adhesion.contact_boundary().nodes[i].measure :
          by_law.normal;
      // Bonds that break separately are points of their own in shear.
      result.shear_tractions.push_back(
        -(by_law.tangential +
          (bonds.shear_energy > 0. ?
             bonds.shear * node.bond_stiffness * (1. - node.shear_damage) :
             0.) *
            slip));
      if (!node.slides)
        return;
      // Nor does the law say what friction bears where nothing slides.
      const auto &boundary_node     = adhesion.contact_boundary().nodes[i];
      result.shear_tractions.back() = {};
      for (const auto &tangent : boundary_node.tangents)
        if (!tangent.is_held)
          result.shear_tractions.back() -=
            forces(tangent.index) / boundary_node.measure * tangent.direction;
    }



    /// The scales that forces are compared with.
    struct ForceScales
    {
      /// The largest |A u - f| where nothing but equilibrium is asked for, and
      /// where supports or the foundation exert it.
      double free = 0., supported = 0.;

      /// The largest nodal force that is applied.
      double load = 0.;

      /// What rounding of u can make of A u - f, at each degree of freedom.
      DofVector rounding;

      /// The largest that rounding of w = u - gap makes of it: if the body
      /// stays far from the foundation, w is larger than u.
      double rounding_of_gaps = 0.;

      /// The least force that is resolved beside these loads and those of other
      /// times, whatever rounding is where it acts. A body that no force
      /// presses has only rounding of gaps. Thermal loads balance each other:
      /// if heat has loosened a press fit, only rounding remains of the forces,
      /// and the condensation leaves up to 20 times what residual_rounding()
      /// counts.
      double resolved_beside_loads = 0.;

      double
      largest() const
      {
        return std::max(load, supported);
      }

      /// The least force that is resolved wherever it acts.
      double
      resolved() const
      {
        return std::max(Tolerance::resolved * rounding.linfty_norm(),
                        resolved_beside_loads);
      }
    };



    /// @p residual: A u - f.
    template <int dim>
    ForceScales
    force_scales(const ElasticProblem<dim> &problem,
                 const DofVector           &u,
                 const DofVector           &residual,
                 const LoadFactors          factors,
                 const double               least_force)
    {
      // A u - f is the force of supports, foundation and bonds at their
      // unknowns, and should be zero at all others, which is how good the
      // equilibrium is. Both are judged beside the rounding of A u: its rows
      // are sums of large terms that cancel, and what they leave in double
      // precision is no error of the solver.
      const ElasticUnknowns<dim> &unknowns = problem.unknowns();
      const ElasticFields<dim>   &fields   = problem.fields();
      ForceScales                 result;
      std::vector<bool>           is_contact(unknowns.n_dofs(), false);
      for (const auto dof : unknowns.contact().dofs())
        is_contact[dof] = true;
      for (unsigned int i = 0; i < unknowns.n_dofs(); ++i)
        {
          double &largest = is_contact[i] || unknowns.is_constrained(i) ?
                              result.supported :
                              result.free;
          largest         = std::max(largest, std::abs(residual(i)));
        }
      result.load     = fields.applied_nodal_forces(factors).linfty_norm();
      result.rounding = fields.residual_rounding(u, factors);
      if (unknowns.has_gap())
        result.rounding_of_gaps =
          fields.residual_rounding(DofVector(u.size()), factors).linfty_norm();
      // A body at rest, or one that has detached, has no other forces than the
      // rounding of gaps, which therefore counts at all unknowns.
      if (Tolerance::force_rounding * result.largest() <
          result.rounding_of_gaps)
        result.rounding.add(result.rounding_of_gaps);
      // If a part has detached and moves without stress, the other one has no
      // forces either, but the rounding of the part that moves.
      if (const double largest = result.rounding.linfty_norm();
          result.largest() < largest)
        result.rounding.add(largest);
      // Not more than a small part of the largest force may be taken for the
      // rounding of gaps, or a wrong force could hide behind a large gap.
      result.resolved_beside_loads =
        std::max(least_force,
                 Tolerance::resolved *
                   std::min(result.rounding_of_gaps,
                            Tolerance::negligible_force * result.largest()));
      return result;
    }



    /// What the displacements of contact nodes, @p displacement being w + G, or
    /// the jumps of glued ones are along the boundary.
    template <int dim>
    std::vector<dealii::Tensor<1, dim>>
    slips_of(const ElasticUnknowns<dim> &unknowns,
             const DofVector            &displacement)
    {
      const auto &nodes = unknowns.contact().boundary().nodes;
      std::vector<dealii::Tensor<1, dim>> slips = at_contact_nodes(
        unknowns.basis().to_nodal(displacement, BasisStep::frames), unknowns);
      for (unsigned int i = 0; i < slips.size(); ++i)
        slips[i] -= (slips[i] * nodes[i].normal) * nodes[i].normal;
      return slips;
    }



    /// The displacement and the force of contact node @p i, before the law is
    /// checked.
    template <int dim>
    ContactNodeState
    node_state(const unsigned int            i,
               const AdhesionIntegral<dim>  &adhesion,
               const double                  s,
               const dealii::Tensor<1, dim> &slip,
               const double                  normal_force,
               const Interval               &bond_forces)
    {
      const auto        &boundary_node = adhesion.contact_boundary().nodes[i];
      const BondScale    bonds         = adhesion.points().bonds_at(i);
      const AdhesiveLaw &law           = *bonds.law;
      ContactNodeState   node;
      node.s       = s;
      node.opening = -s;
      node.u_nu    = s + boundary_node.gap;
      if (!boundary_node.tangents.empty() && bonds.shear > 0.)
        {
          // The square of the opening, l^2 = p^2 + r |t|^2. What is closed has
          // p = 0, but its slip opens the bonds all the same. Bonds that break
          // separately have the opening p along the normal, and one of their
          // own in shear.
          const Jump<dim> jump   = {std::min(s, 0.), slip};
          const double    square = jump.product(jump, bonds.shear);
          node.mode_mixity =
            square == 0. ? 0. : jump.part_of_shear(bonds.shear);
          if (bonds.shear_energy == 0.)
            node.opening = std::sqrt(square);
        }
      node.normal_force  = normal_force;
      node.allowed_force = unbounded_above_if(s >= 0., bond_forces);
      // From j_1(s) = energy j(s / length): the second derivative is that of
      // the law times energy over squared length. Damage is that of the largest
      // opening, of this state or one before.
      node.bond_stiffness = std::max(0., law.second_derivative(0.)) *
                            bonds.energy / (bonds.length * bonds.length);
      node.bond_threshold = law.bond_threshold() * bonds.length;
      node.damage         = bonds.energy == 0. ?
                              0. :
                              law.damage(std::min(adhesion.reached(i),
                                          -node.opening / bonds.length));
      return node;
    }



    /// The Cartesian displacements of contact nodes, of an edge its
    /// coefficient; of glued nodes that of the body on the high side. @p
    /// displacement: w + G.
    template <int dim>
    std::vector<dealii::Tensor<1, dim>>
    contact_displacements(const ElasticUnknowns<dim> &unknowns,
                          const DofVector            &displacement)
    {
      DofVector u = unknowns.basis().to_nodal(displacement, BasisStep::jumps);
      for (const auto &pair : unknowns.pairs().all())
        // A pair with a minus has its first node on the low side, and its
        // second one on the high side.
        if (pair.sign < 0.)
          for (unsigned int d = 0; d < dim; ++d)
            u(dim * pair.first + d) = u(dim * pair.second + d);
      return at_contact_nodes(u, unknowns);
    }



    /// Adds the contact nodes, before the law is checked.
    template <int dim>
    void
    add_nodes(const AdhesionIntegral<dim>               &adhesion,
              const Eigen::VectorXd                     &s,
              const Eigen::VectorXd                     &forces,
              const std::vector<dealii::Tensor<1, dim>> &slips,
              Verification<dim>                         &result)
    {
      const std::vector<Interval> allowed = adhesion.force_intervals(s, 0.);
      const std::vector<double>   shear_damages = shear_damage(adhesion, s);
      result.penetration                        = 0.;
      result.largest_opening                    = 0.;
      for (unsigned int i = 0; i < adhesion.n_nodes(); ++i)
        {
          result.largest_opening = std::max(result.largest_opening, -s(i));
          result.penetration     = std::max(result.penetration, s(i));
          result.nodes.push_back(
            node_state(i, adhesion, s(i), slips[i], forces(i), allowed[i]));
          for (const auto &tangent :
               adhesion.contact_boundary().nodes[i].tangents)
            if (!tangent.is_held)
              {
                const Kinks &friction        = adhesion.kinks();
                result.nodes[i].shear_damage = shear_damages[tangent.index];
                // What sticks is exactly where it was.
                if (friction.has(tangent.index))
                  result.nodes[i].slides =
                    result.nodes[i].slides.value_or(false) ||
                    friction.way(tangent.index, s) != 0.;
              }
        }
    }



    /// Returns s with zeros for what is open by rounding, of which @p scales
    /// get the size: that of forces is @p least at least.
    template <int dim>
    Eigen::VectorXd
    closed_by_rounding(const ContactSpace<dim> &contact,
                       const DofVector         &diagonal,
                       const ForceScales       &found,
                       const double             least,
                       const Eigen::VectorXd   &s,
                       std::vector<LawScale>   &scales)
    {
      Eigen::VectorXd rounded = s;
      const auto     &normals = contact.normal_dofs();
      for (unsigned int i = 0; i < normals.size(); ++i)
        {
          // A force that is known to its rounding leaves a displacement that is
          // known to the rounding over the diagonal of A, the stiffness of this
          // unknown.
          scales[i].rounding =
            std::max(least, found.rounding(normals[i])) / diagonal(normals[i]);
          if (std::abs(s(i)) <= scales[i].rounding)
            rounded(i) = 0.;
        }
      return rounded;
    }



    /// The largest displacement of a bond now or, if it broke for good, before:
    /// if all of these are closed again, s is rounding.
    template <int dim>
    double
    largest_displacement(const AdhesionIntegral<dim> &adhesion,
                         const Eigen::VectorXd       &s)
    {
      const unsigned int n_nodes = adhesion.n_nodes();
      double largest = s.head(n_nodes).template lpNorm<Eigen::Infinity>();
      for (unsigned int i = 0; i < n_nodes; ++i)
        largest =
          std::max(largest,
                   -adhesion.reached(i) * adhesion.points().bonds_at(i).length);
      return largest;
    }
  } // namespace



  template <int dim>
  Verification<dim>
  verify(const ElasticProblem<dim>   &problem,
         const AdhesionIntegral<dim> &bonds,
         const DofVector             &u,
         const LoadFactors            factors,
         const double                 least_force,
         const double                 tolerance)
  {
    if (!std::all_of(u.begin(), u.end(), [](const double x) {
          return std::isfinite(x);
        }))
      throw std::invalid_argument(
        "The displacement is not finite and cannot be verified: the data of "
        "the scene are too large or too small for double precision.");

    // All that follows is from A u - f, which is summed up from the stresses in
    // the cells, without any figure of the solver. At the contact normals it is
    // the force of the foundation on the body; along -nu it is positive if the
    // foundation pushes, and negative if bonds pull.
    const ContactSpace<dim>    &contact  = problem.unknowns().contact();
    const ContactBoundary<dim> &boundary = contact.boundary();
    const DofVector residual = problem.fields().residual(u, factors);

    const Eigen::VectorXd s            = contact.trace(u);
    const Eigen::VectorXd forces       = -contact.trace(residual);
    const DofVector       displacement = problem.unknowns().lifted(u, factors);
    // Friction by the pressure is that of these forces, whatever the solver has
    // taken for it.
    std::optional<AdhesionIntegral<dim>> pressed;
    if (bonds.friction().depends_on_pressure())
      {
        pressed.emplace(bonds);
        pressed->press(
          (s.array() >= 0.).select(forces, 0.).head(bonds.n_nodes()));
      }
    const AdhesionIntegral<dim> &adhesion = pressed ? *pressed : bonds;
    const std::vector<dealii::Tensor<1, dim>> slips =
      slips_of(problem.unknowns(), displacement);

    Verification<dim> result;
    result.has_friction  = !bonds.friction().empty();
    result.state_names   = state_names(adhesion.adhesive_law());
    result.without_bonds = zone_without_bonds(boundary, adhesion);
    add_nodes(adhesion, s, forces, slips, result);

    // The order matters: the scales of the law need the rounding of forces,
    // violations need these scales, and the states of nodes need the
    // violations, within which a gap under pressure counts as contact.
    const ForceScales found =
      force_scales(problem, u, residual, factors, least_force);
    std::vector<LawScale> scales =
      law_scales<dim>(adhesion,
                      boundary,
                      forces,
                      (Tolerance::resolved * contact.trace(found.rounding))
                        .cwiseMax(found.resolved_beside_loads),
                      {displacement.linfty_norm(), found.supported});
    const std::vector<double> distances =
      violations(adhesion, s, forces, scales);

    // Violations are those of s as it is. For the broken zone, openings by
    // rounding alone are closed, since a crack that is closed has no length.
    const Eigen::VectorXd rounded = closed_by_rounding(
      contact, problem.diagonal(), found, tolerance * least_force, s, scales);
    result.broken_zone = broken_zone(boundary, adhesion, rounded);

    const std::vector<Jump<dim>> tractions = node_tractions(adhesion, s);
    const unsigned int           n_nodes   = adhesion.n_nodes();
    const double                 largest_s = largest_displacement(adhesion, s);
    result.law_violation =
      distances.empty() ? 0. :
                          *std::max_element(distances.begin(), distances.end());
    for (unsigned int i = 0; i < n_nodes; ++i)
      {
        // A node is as far from the law as the worst of its unknowns, along the
        // normal and along its tangents.
        double &violation = result.nodes[i].violation;
        violation         = distances[i];
        for (const auto &tangent : boundary.nodes[i].tangents)
          if (!tangent.is_held)
            violation = std::max(violation, distances[tangent.index]);
        set_state(i, adhesion, scales[i], largest_s, tolerance, result);
        set_tractions(i, adhesion, forces, tractions[i], slips[i], result);
      }
    if (adhesion.shears())
      result.slips = slips;
    else
      result.shear_tractions.clear();

    // The largest force at an unknown where there should be none, relative to
    // the largest one of all, or to what is resolved beside rounding if there
    // is no other.
    result.equilibrium_residual =
      found.free > 0. ?
        found.free / std::max({found.free, found.supported, found.resolved()}) :
        0.;
    // The rounding of a sum is that of all its terms.
    compute_force_balance(problem,
                          residual,
                          factors,
                          std::max(found.resolved(),
                                   Tolerance::resolved *
                                     found.rounding.l1_norm()),
                          held_forces(adhesion, s),
                          result);

    // If this is above a tenth, all forces may be rounding, and nothing has
    // been verified; error() is infinite then.
    result.force_rounding =
      found.load > 0. ?
        std::max(found.rounding.linfty_norm(), found.rounding_of_gaps) /
          found.largest() :
        0.;
    result.displacement_factor = factors.displacements;
    result.displacements =
      contact_displacements(problem.unknowns(), displacement);
    return result;
  }



  DEBOND_INSTANTIATE_CLASS(Verification);
  DEBOND_INSTANTIATE(verify);
} // namespace Debond
