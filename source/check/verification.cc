// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/check/broken_zone.h>
#include <debond/check/verification.h>
#include <debond/contact/adhesion_sums.h>

namespace Debond
{
  std::vector<std::string>
  state_names(const AdhesiveLaw &law)
  {
    std::vector<std::string> names = {"broken but closed",
                                      "contact",
                                      "bonded",
                                      "kink",
                                      "broken",
                                      "free",
                                      "held"};
    for (unsigned int k = 0; k < law.pieces().size(); ++k)
      if (std::find(names.begin(), names.end(), law.name(k)) == names.end())
        names.push_back(law.name(k));
    return names;
  }



  template <int dim>
  double
  Verification<dim>::error() const
  {
    // Were all forces rounding, they would balance whatever u is. The
    // comparisons of std::max would lose a NaN.
    if (!(force_rounding <= Tolerance::force_rounding))
      return std::numeric_limits<double>::infinity();
    return std::isfinite(equilibrium_residual + force_imbalance +
                         law_violation) ?
             std::max({equilibrium_residual, force_imbalance, law_violation}) :
             std::numeric_limits<double>::infinity();
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
    return state_names[static_cast<int>(state) + 1];
  }



  namespace
  {
    /// The displacement at which bonds first change their branch, as a positive
    /// length; zero if they never do.
    double
    first_threshold(const AdhesiveLaw &law)
    {
      return law.pieces().size() > 1 ? -law.pieces()[1].upper : 0.;
    }



    /// L_i and F_i of Verification::law_violation, with which the displacement
    /// and the force of a node are compared.
    struct LawScale
    {
      double length;
      double force;

      /// What rounding of forces is of the displacement.
      double rounding = 0.;
    };



    /// The scales of each unknown of the contact boundary. @p forces: along
    /// them; @p resolved: the least force that is, of each; @p largest:
    /// displacement of the body and force of a support.
    template <int dim>
    std::vector<LawScale>
    law_scales(const AdhesionIntegral<dim> &adhesion,
               const ContactBoundary<dim>  &boundary,
               const VectorView            &forces,
               const VectorView            &resolved,
               const LawScale              &largest)
    {
      const AdhesiveLaw &law = adhesion.adhesive_law();
      const double       largest_force =
        std::max(Tolerance::contact_force * largest.force,
                 forces.size() == 0 ? 0. : forces.lpNorm<Eigen::Infinity>());

      // Of vertices that are held along the normal too, which are no nodes.
      std::vector<LawScale> scales;
      for (const double least : resolved)
        scales.push_back({largest.length, std::max(largest_force, least)});
      const auto set = [&](const unsigned int i,
                           const BondScale   &bonds,
                           const double       measure) {
        const double threshold = first_threshold(law) * bonds.stretch;
        const double strength =
          law.bond_strength() * bonds.energy / bonds.stretch * measure;
        const bool has_bonds = threshold > 0. && strength > 0.;
        LawScale  &scale     = scales[i];
        if (has_bonds)
          scale.force = std::min(scale.force, strength);
        scale.force = std::max(scale.force, resolved(i));
        if (has_bonds)
          scale.length =
            std::min(scale.length,
                     threshold * std::min(1., scale.force / strength));
      };
      for (unsigned int i = 0; i < boundary.nodes.size(); ++i)
        {
          const auto     &node  = boundary.nodes[i];
          const BondScale bonds = adhesion.points().bonds_at(i);
          set(i, bonds, node.measure);
          // In shear the same opening is a larger or a smaller displacement,
          // and it is another one of bonds that break separately.
          BondScale shear = bonds;
          if (bonds.shear_energy > 0.)
            shear = bonds.in_shear();
          else if (bonds.shear > 0.)
            shear.stretch /= std::sqrt(bonds.shear);
          for (const auto &tangent : node.tangents)
            if (!tangent.is_held)
              set(tangent.index,
                  bonds.shear > 0. ? shear : BondScale{0., 1.},
                  node.measure);
        }
      return scales;
    }



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
      const AdhesiveLaw     &law         = adhesion.adhesive_law();
      const PiecewiseEnergy &branches    = law.pieces();
      const BondScale        bonds       = adhesion.points().bonds_at(i);
      const unsigned int     least_piece = adhesion.least_piece(i);
      ContactNodeState      &node        = result.nodes[i];
      const auto             state_of    = [&](const unsigned int piece) {
        return static_cast<BondState>(std::find(result.state_names.begin(),
                                                result.state_names.end(),
                                                law.name(piece)) -
                                      result.state_names.begin() - 1);
      };
      node.branch =
        bonds.energy == 0. ?
          BondState::free :
          state_of(std::max(least_piece,
                            branches.index(-node.opening / bonds.stretch)));
      const double threshold = first_threshold(law) * bonds.stretch;
      const double no_gap =
        std::max(scale.rounding,
                 tolerance * (threshold > 0. ? std::min(threshold, largest_s) :
                                               largest_s));
      // A small gap under pressure is contact that an iterative method has not
      // closed yet.
      const double gap =
        std::max(tolerance,
                 std::min(Tolerance::open_contact, 1.01 * node.violation));
      if (node.s >= -no_gap ||
          (node.normal_force > 0. && node.s >= -gap * scale.length))
        {
          // What is closed may slide, and soften or break by it.
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
          const double kink = branches[k].upper * bonds.stretch;
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
                  const Jump<dim>              &by_law,
                  const dealii::Tensor<1, dim> &slip,
                  Verification<dim>            &result)
    {
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
    }



    /// The distance of a force to the allowed ones.
    double
    distance(const double force, const Interval &allowed)
    {
      return std::max({0., allowed.lower - force, force - allowed.upper});
    }



    Interval
    unbounded_above_if(const bool contact, const Interval &interval)
    {
      return {interval.lower,
              contact ? std::numeric_limits<double>::infinity() :
                        interval.upper};
    }



    /**
     * The distances of Verification::law_violation, one for each unknown of the
     * contact boundary, of which those from @p n_nodes on have no bound. A
     * larger delta allows more, so that bisection finds the least one. It
     * bisects the exponent, because a node next to a jump of the law is close
     * to the graph, however far its force is from what is allowed at its
     * very displacement.
     */
    template <int dim>
    std::vector<double>
    violations(const AdhesionIntegral<dim> &adhesion,
               const VectorView            &s,
               const VectorView            &forces,
               const std::vector<LawScale> &scales)
    {
      const unsigned int          n       = adhesion.n_unknowns();
      const unsigned int          n_nodes = adhesion.n_nodes();
      const std::vector<Interval> at_s    = adhesion.force_intervals(s, 0.);

      // What is needed at fixed displacements is enough. It is exactly zero
      // for a node on the graph.
      std::vector<double> lower(n, 0.);
      std::vector<double> upper(n, 0.);
      for (unsigned int i = 0; i < n; ++i)
        {
          const double force_distance =
            distance(forces(i),
                     unbounded_above_if(i < n_nodes && s(i) >= 0., at_s[i]));
          if (force_distance > 0.)
            upper[i] = force_distance / scales[i].force;
          if (i < n_nodes && s(i) > 0.)
            upper[i] = std::max(upper[i], s(i) / scales[i].length);
          if (upper[i] > 0.)
            lower[i] = std::numeric_limits<double>::min();
        }

      // The exponents of double are 2^11, its mantissa has 2^53 values.
      std::vector<double> delta(n);
      std::vector<double> radius(n);
      for (unsigned int step = 0; step < 11 + 53; ++step)
        {
          for (unsigned int i = 0; i < n; ++i)
            {
              delta[i]  = std::sqrt(lower[i]) * std::sqrt(upper[i]);
              radius[i] = delta[i] * scales[i].length;
            }
          const std::vector<Interval> intervals =
            adhesion.force_intervals(s, radius);
          for (unsigned int i = 0; i < n; ++i)
            {
              const bool     is_bounded = i < n_nodes;
              const Interval allowed =
                unbounded_above_if(is_bounded && s(i) >= -radius[i],
                                   intervals[i]);
              const bool enough =
                (!is_bounded || s(i) <= radius[i]) &&
                distance(forces(i), allowed) <= delta[i] * scales[i].force;
              (enough ? upper : lower)[i] = delta[i];
            }
        }

      return upper;
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

      /// The largest that rounding of w = u - gap makes of it: where the body
      /// stays far from the foundation, w is larger than u.
      double rounding_of_gaps = 0.;

      /// The least force that is resolved beside these loads and those of other
      /// times, whatever rounding is where it acts. A body that no force
      /// presses has only rounding of gaps. Thermal loads balance each other:
      /// where heat has loosened a press fit, nothing but rounding is left of
      /// the forces, and the condensation leaves up to 20 times what
      /// residual_rounding() counts.
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
      // A body at rest, or off, has no other forces.
      if (Tolerance::force_rounding * result.largest() <
          result.rounding_of_gaps)
        result.rounding.add(result.rounding_of_gaps);
      // Where a part has come off and moves without stress, the other one has
      // no forces either, but the rounding of the part that moves.
      if (const double largest = result.rounding.linfty_norm();
          result.largest() < largest)
        result.rounding.add(largest);
      result.resolved_beside_loads =
        std::max(least_force,
                 Tolerance::resolved *
                   std::min(result.rounding_of_gaps,
                            Tolerance::negligible_force * result.largest()));
      return result;
    }



    /// The vectors of the contact nodes among those of all nodes. The unknowns
    /// of a node follow each other.
    template <int dim, typename Dofs>
    std::vector<dealii::Tensor<1, dim>>
    at_contact_nodes(const DofVector &vectors, const Dofs &normals)
    {
      std::vector<dealii::Tensor<1, dim>> result;
      for (const auto normal : normals)
        {
          result.emplace_back();
          for (unsigned int d = 0; d < dim; ++d)
            result.back()[d] = vectors(normal / dim * dim + d);
        }
      return result;
    }



    template <int dim>
    dealii::Tensor<1, dim>
    resultant(const DofVector &forces)
    {
      dealii::Tensor<1, dim> sum;
      for (unsigned int i = 0; i < forces.size(); ++i)
        sum[i % dim] += forces(i);
      return sum;
    }



    /// Sets the reaction of each support by its name. @p clamped: A u - f where
    /// supports exert it.
    template <int dim>
    void
    set_reactions(const ElasticUnknowns<dim> &unknowns,
                  const DofVector            &clamped,
                  Verification<dim>          &result)
    {
      const std::vector<std::string> &names = unknowns.support_names();
      for (const std::string &name : names)
        result.reactions[name];
      std::map<unsigned int, unsigned int> of_node;
      for (const auto &[dof, support] : unknowns.supported())
        of_node[static_cast<unsigned int>(dof / dim)] = support;
      for (const auto &[dof, support] : unknowns.supported())
        {
          dealii::Tensor<1, dim> force;
          force[dof % dim] = clamped(dof);
          // What holds a jump acts on both nodes, which two supports may hold.
          for (const BasisStep step : {BasisStep::frames, BasisStep::jumps})
            if (const auto *row =
                  unknowns.basis().find(step,
                                        static_cast<unsigned int>(dof / dim)))
              {
                force = force * row->to_unknowns;
                // The axis holds nodes without being a support.
                for (const auto &[other, weight] : row->others)
                  if (const auto held = of_node.find(other);
                      held != of_node.end())
                    result.reactions[names[held->second]] -= weight * force;
              }
          result.reactions[names[support]] += force;
        }
    }



    /// Bonds of vertices that a support moves pull at it with @p held_forces.
    template <int dim>
    void
    add_held_forces(const ElasticUnknowns<dim> &unknowns,
                    const std::vector<double>  &held_forces,
                    Verification<dim>          &result)
    {
      const std::vector<std::string> &names = unknowns.support_names();
      const auto &held = unknowns.contact().boundary().held_vertices;
      for (unsigned int k = 0; k < held.size(); ++k)
        {
          const dealii::Tensor<1, dim> force = held_forces[k] * held[k].normal;
          result.contact_reaction -= force;
          if (held[k].is_tangential)
            result.tangential_reaction -= force;
          if (held[k].low_support < names.size())
            result.reactions[names[held[k].low_support]] -= force;
          else
            result.clamped_reaction += force;
          if (held[k].support < names.size())
            result.reactions[names[held[k].support]] += force;
        }
    }



    /// @p residual: A u - f; @p resolved: the least sum of forces' sizes that
    /// rounding leaves; @p held_forces: of the bonds at vertices that are held.
    template <int dim>
    void
    compute_force_balance(const ElasticProblem<dim> &problem,
                          const DofVector           &residual,
                          const LoadFactors          factors,
                          const double               resolved,
                          const std::vector<double> &held_forces,
                          Verification<dim>         &result)
    {
      // What the supports and the foundation exert is the residual at their
      // degrees of freedom; what is held there and by no support is held by the
      // foundation.
      const ElasticUnknowns<dim> &unknowns = problem.unknowns();
      const auto                 &normals  = unknowns.contact().normal_dofs();
      DofVector                   clamped(unknowns.n_dofs());
      DofVector                   tangential(unknowns.n_dofs());
      for (const auto &line : unknowns.constraints().get_lines())
        if (unknowns.on_axis().count(line.index / dim) == 0)
          tangential(line.index) = residual(line.index);
      for (const auto &[dof, unused] : unknowns.supported())
        {
          clamped(dof)    = residual(dof);
          tangential(dof) = 0.;
        }
      const auto &dofs = unknowns.contact().dofs();
      for (std::size_t i = normals.size(); i < dofs.size(); ++i)
        tangential(dofs[i]) = residual(dofs[i]);
      DofVector contact = tangential;
      for (const auto normal : normals)
        contact(normal) = residual(normal);

      const DofVector applied = problem.fields().applied_nodal_forces(factors);
      result.applied_force    = resultant<dim>(applied);
      result.clamped_reaction =
        resultant<dim>(unknowns.cartesian_forces(clamped));
      result.contact_reaction =
        resultant<dim>(unknowns.contact_forces(contact));
      tangential                 = unknowns.contact_forces(tangential);
      result.tangential_reaction = resultant<dim>(tangential);
      result.tangential_forces   = at_contact_nodes<dim>(tangential, normals);
      set_reactions(unknowns, clamped, result);
      add_held_forces(unknowns, held_forces, result);
      const auto &nodes = unknowns.contact().boundary().nodes;
      for (unsigned int i = 0; i < nodes.size(); ++i)
        for (const auto &tangent : nodes[i].tangents)
          if (tangent.is_held)
            result.tangential_forces[i] -=
              held_forces[tangent.index] * tangent.direction;

      // Resultants can vanish where forces do not.
      DofVector all = clamped;
      all += contact;
      const double scale = all.l1_norm() + applied.l1_norm();
      // Each body is in balance by itself.
      all = unknowns.cartesian_forces(all);
      all += applied;
      std::vector<dealii::Tensor<1, dim>> sums(unknowns.n_bodies());
      for (unsigned int i = 0; i < all.size(); ++i)
        sums[unknowns.body_of(i / dim)][i % dim] += all(i);
      double imbalance = 0.;
      for (dealii::Tensor<1, dim> &sum : sums)
        {
          // Away from an axis hoop stresses hold what loads do not.
          if (unknowns.symmetry() == Symmetry::axis)
            sum[0] = 0.;
          imbalance = std::max(imbalance, sum.norm());
        }
      result.force_imbalance =
        imbalance > 0. ? imbalance / std::max(scale, resolved) : 0.;
    }



    /// What the displacements of contact nodes, @p displacement being w + G, or
    /// the jumps of glued ones are along the boundary.
    template <int dim>
    std::vector<dealii::Tensor<1, dim>>
    slips_of(const ElasticUnknowns<dim> &unknowns,
             const DofVector            &displacement)
    {
      const auto &nodes = unknowns.contact().boundary().nodes;
      std::vector<dealii::Tensor<1, dim>> slips =
        at_contact_nodes<dim>(unknowns.basis().to_nodal(displacement,
                                                        BasisStep::frames),
                              unknowns.contact().normal_dofs());
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
      const AdhesiveLaw &law           = adhesion.adhesive_law();
      const auto        &boundary_node = adhesion.contact_boundary().nodes[i];
      const BondScale    bonds         = adhesion.points().bonds_at(i);
      ContactNodeState   node;
      node.s       = s;
      node.opening = -s;
      node.u_nu    = s + boundary_node.gap;
      if (!boundary_node.tangents.empty() && bonds.shear > 0.)
        {
          const Jump<dim> jump   = {std::min(s, 0.), slip};
          const double    square = jump.product(jump, bonds.shear);
          node.mode_mixity =
            square == 0. ? 0. : jump.part_of_shear(bonds.shear);
          if (bonds.shear_energy == 0.)
            node.opening = std::sqrt(square);
        }
      node.normal_force   = normal_force;
      node.allowed_force  = unbounded_above_if(s >= 0., bond_forces);
      node.bond_stiffness = std::max(0., law.second_derivative(0.)) *
                            bonds.energy / (bonds.stretch * bonds.stretch);
      node.bond_threshold = law.bond_threshold() * bonds.stretch;
      node.damage         = bonds.energy == 0. ?
                              0. :
                              law.damage(std::min(adhesion.reached(i),
                                          -node.opening / bonds.stretch));
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
        if (pair.sign < 0.)
          for (unsigned int d = 0; d < dim; ++d)
            u(dim * pair.first + d) = u(dim * pair.second + d);
      return at_contact_nodes<dim>(u, unknowns.contact().normal_dofs());
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
              result.nodes[i].shear_damage = shear_damages[tangent.index];
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
          scales[i].rounding =
            std::max(least, found.rounding(normals[i])) / diagonal(normals[i]);
          if (std::abs(s(i)) <= scales[i].rounding)
            rounded(i) = 0.;
        }
      return rounded;
    }



    /// The largest displacement of a bond now or, if it broke for good, before:
    /// where all of these are closed again, s is rounding.
    template <int dim>
    double
    largest_displacement(const AdhesionIntegral<dim> &adhesion,
                         const Eigen::VectorXd       &s)
    {
      const unsigned int n_nodes = adhesion.n_nodes();
      double largest = s.head(n_nodes).template lpNorm<Eigen::Infinity>();
      for (unsigned int i = 0; i < n_nodes; ++i)
        largest = std::max(largest,
                           -adhesion.reached(i) *
                             adhesion.points().bonds_at(i).stretch);
      return largest;
    }
  } // namespace



  template <int dim>
  Verification<dim>
  verify(const ElasticProblem<dim>   &problem,
         const AdhesionIntegral<dim> &adhesion,
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
        "the "
        "scene are too large or too small for double precision.");

    const ContactSpace<dim>    &contact  = problem.unknowns().contact();
    const ContactBoundary<dim> &boundary = contact.boundary();
    const DofVector residual = problem.fields().residual(u, factors);

    const Eigen::VectorXd s            = contact.trace(u);
    const Eigen::VectorXd forces       = -contact.trace(residual);
    const DofVector       displacement = problem.unknowns().lifted(u, factors);
    const std::vector<dealii::Tensor<1, dim>> slips =
      slips_of(problem.unknowns(), displacement);

    Verification<dim> result;
    result.state_names   = state_names(adhesion.adhesive_law());
    result.without_bonds = zone_without_bonds(boundary, adhesion);
    add_nodes(adhesion, s, forces, slips, result);

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

    const Eigen::VectorXd rounded = closed_by_rounding(
      contact, problem.diagonal(), found, tolerance * least_force, s, scales);
    result.broken_zone =
      broken_zone(boundary, adhesion.adhesive_law(), adhesion, rounded);

    const std::vector<Jump<dim>> tractions = node_tractions(adhesion, s);
    const unsigned int           n_nodes   = adhesion.n_nodes();
    const double                 largest_s = largest_displacement(adhesion, s);
    result.law_violation =
      distances.empty() ? 0. :
                          *std::max_element(distances.begin(), distances.end());
    for (unsigned int i = 0; i < n_nodes; ++i)
      {
        double &violation = result.nodes[i].violation;
        violation         = distances[i];
        for (const auto &tangent : boundary.nodes[i].tangents)
          if (!tangent.is_held)
            violation = std::max(violation, distances[tangent.index]);
        set_state(i, adhesion, scales[i], largest_s, tolerance, result);
        set_tractions(i, adhesion, tractions[i], slips[i], result);
      }
    if (adhesion.shears())
      result.slips = slips;
    else
      result.shear_tractions.clear();

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
