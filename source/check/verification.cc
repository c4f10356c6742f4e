// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/check/broken_zone.h>
#include <debond/check/verification.h>
#include <debond/contact/adhesion_sums.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace Debond
{
  std::vector<std::string>
  state_names(const AdhesiveLaw &law)
  {
    std::vector<std::string> names = {
      "contact", "bonded", "kink", "broken", "free", "held"};
    for (unsigned int k = 0; k < law.branches().size(); ++k)
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
    return state_names[static_cast<unsigned int>(state)];
  }



  namespace
  {
    /// The displacement at which bonds first change their branch, as a positive
    /// length; zero if they never do.
    double
    first_threshold(const AdhesiveLaw &law)
    {
      return law.branches().size() > 1 ? -law.branches()[1].upper : 0.;
    }



    /// What the displacement and the force of a node are compared with, see
    /// Verification::law_violation.
    struct LawScale
    {
      double length;
      double force;
    };



    /// Of each node. @p resolved: the least force that is, of each; @p largest:
    /// displacement of the body and force of a support.
    template <int dim>
    std::vector<LawScale>
    law_scales(const AdhesionIntegral<dim>         &adhesion,
               const ContactBoundary<dim>          &boundary,
               const std::vector<ContactNodeState> &nodes,
               const VectorView                    &resolved,
               const LawScale                      &largest)
    {
      const AdhesiveLaw &law = adhesion.adhesive_law();
      double largest_force   = Tolerance::contact_force * largest.force;
      for (const ContactNodeState &node : nodes)
        largest_force = std::max(largest_force, std::abs(node.normal_force));

      std::vector<LawScale> scales;
      for (unsigned int i = 0; i < nodes.size(); ++i)
        {
          const BondScale bonds     = adhesion.points().bonds_at(i);
          const double    threshold = first_threshold(law) * bonds.stretch;
          const double    strength  = law.bond_strength() * bonds.energy /
                                  bonds.stretch * boundary.nodes[i].measure;
          const bool has_bonds = threshold > 0. && strength > 0.;
          LawScale   scale     = {largest.length, largest_force};
          if (has_bonds)
            scale.force = std::min(scale.force, strength);
          scale.force = std::max(scale.force, resolved(i));
          if (has_bonds)
            scale.length =
              std::min(scale.length,
                       threshold * std::min(1., scale.force / strength));
          scales.push_back(scale);
        }
      return scales;
    }



    /// Of node @p i, from its displacement and force. @p largest_s: of all
    /// nodes.
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
      const PiecewiseEnergy &branches    = law.branches();
      const BondScale        bonds       = adhesion.points().bonds_at(i);
      const unsigned int     least_piece = adhesion.least_piece(i);
      ContactNodeState      &node        = result.nodes[i];
      const auto             state_of    = [&](const unsigned int piece) {
        return static_cast<BondState>(std::find(result.state_names.begin(),
                                                result.state_names.end(),
                                                law.name(piece)) -
                                      result.state_names.begin());
      };
      node.branch =
        bonds.energy == 0. ?
          BondState::free :
          state_of(
            std::max(least_piece, branches.index(node.s / bonds.stretch)));
      const double threshold = first_threshold(law) * bonds.stretch;
      const double no_gap =
        tolerance *
        (threshold > 0. ? std::min(threshold, largest_s) : largest_s);
      // A small gap under pressure is contact that an iterative method has not
      // closed yet.
      const double gap =
        std::max(tolerance,
                 std::min(Tolerance::open_contact, 1.01 * node.violation));
      if (node.s >= -no_gap ||
          (node.normal_force > 0. && node.s >= -gap * scale.length))
        {
          node.state = BondState::contact;
          return;
        }
      node.state = node.branch;
      for (unsigned int k = least_piece + 1;
           k < branches.size() && bonds.energy > 0.;
           ++k)
        {
          const double kink = branches[k].upper * bonds.stretch;
          if (std::abs(node.s - kink) <= tolerance * std::abs(kink))
            {
              node.state  = BondState::kink;
              node.branch = state_of(k - 1);
            }
        }
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
     * The distances of Verification::law_violation, one for each node. A
     * larger delta allows more, so that bisection finds the least one. It
     * bisects the exponent, because a node next to a jump of the law is close
     * to the graph, however far its force is from what is allowed at its
     * very displacement.
     */
    template <int dim>
    void
    compute_violations(const AdhesionIntegral<dim>   &adhesion,
                       const VectorView              &s,
                       const std::vector<LawScale>   &scales,
                       std::vector<ContactNodeState> &nodes)
    {
      const unsigned int n = static_cast<unsigned int>(nodes.size());

      // What is needed at fixed displacements is enough. It is exactly zero
      // for a node on the graph.
      std::vector<double> lower(n, 0.);
      std::vector<double> upper(n, 0.);
      for (unsigned int i = 0; i < n; ++i)
        {
          const double force_distance =
            distance(nodes[i].normal_force, nodes[i].allowed_force);
          if (force_distance > 0.)
            upper[i] = force_distance / scales[i].force;
          if (s(i) > 0.)
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
              const Interval allowed =
                unbounded_above_if(s(i) >= -radius[i], intervals[i]);
              const bool enough =
                s(i) <= radius[i] && distance(nodes[i].normal_force, allowed) <=
                                       delta[i] * scales[i].force;
              (enough ? upper : lower)[i] = delta[i];
            }
        }

      for (unsigned int i = 0; i < n; ++i)
        nodes[i].violation = upper[i];
    }



    /// Largest |A u - f| where the body is free and where it is supported or
    /// touches the foundation.
    struct LargestResiduals
    {
      double free      = 0.;
      double supported = 0.;
    };



    template <int dim>
    LargestResiduals
    largest_residuals(const ElasticProblem<dim> &problem,
                      const DofVector           &residual)
    {
      std::vector<bool> supported(problem.unknowns().n_dofs(), false);
      for (const auto normal : problem.unknowns().contact().normal_dofs())
        supported[normal] = true;

      LargestResiduals result;
      for (unsigned int i = 0; i < problem.unknowns().n_dofs(); ++i)
        {
          double &largest =
            supported[i] || problem.unknowns().is_constrained(i) ?
              result.supported :
              result.free;
          largest = std::max(largest, std::abs(residual(i)));
        }
      return result;
    }



    /// Of all nodes' vectors, by unknown, those of the contact nodes; none from
    /// an empty vector. The unknowns of a node follow each other.
    template <int dim, typename Dofs>
    std::vector<dealii::Tensor<1, dim>>
    at_contact_nodes(const DofVector &vectors, const Dofs &normals)
    {
      std::vector<dealii::Tensor<1, dim>> result;
      if (vectors.size() == 0)
        return result;
      for (const auto normal : normals)
        {
          result.emplace_back();
          for (unsigned int d = 0; d < dim; ++d)
            result.back()[d] = vectors(normal / dim * dim + d);
        }
      return result;
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
      const auto       &normals = problem.unknowns().contact().normal_dofs();
      std::vector<bool> is_normal(problem.unknowns().n_dofs(), false);
      for (const auto normal : normals)
        is_normal[normal] = true;

      // What the supports and the foundation exert is the residual at their
      // degrees of freedom; what is held there and by no support is held by the
      // foundation.
      const ElasticUnknowns<dim> &unknowns = problem.unknowns();
      std::vector<bool>           is_supported(unknowns.n_dofs(), false);
      for (const auto &[dof, unused] : unknowns.supported())
        is_supported[dof] = true;
      DofVector clamped(unknowns.n_dofs());
      DofVector contact(unknowns.n_dofs());
      for (unsigned int dof = 0; dof < unknowns.n_dofs(); ++dof)
        if (is_supported[dof])
          clamped(dof) = residual(dof);
        else if (is_normal[dof] || unknowns.is_constrained(dof))
          contact(dof) = residual(dof);

      const auto resultant = [&](const DofVector &forces) {
        dealii::Tensor<1, dim> sum;
        for (unsigned int i = 0; i < forces.size(); ++i)
          sum[i % dim] += forces(i);
        return sum;
      };

      const DofVector applied = problem.fields().applied_nodal_forces(factors);
      for (unsigned int i = 0; i < applied.size(); ++i)
        result.applied_force[i % dim] += applied(i);
      result.clamped_reaction = resultant(unknowns.cartesian_forces(clamped));
      result.contact_reaction = resultant(unknowns.contact_forces(contact));

      const std::vector<std::string> &names = unknowns.support_names();
      for (const std::string &name :
           std::set<std::string>(names.begin(), names.end()))
        {
          DofVector of_support(unknowns.n_dofs());
          for (const auto &[dof, support] : unknowns.supported())
            if (names[support] == name)
              of_support(dof) = residual(dof);
          result.reactions[name] =
            resultant(unknowns.cartesian_forces(of_support));
        }
      // Of glued nodes that two supports hold.
      const DofVector on_high = unknowns.contact_forces(clamped);
      std::map<unsigned int, std::string> support_of;
      if (!unknowns.pairs().empty())
        for (const auto &[dof, support] : unknowns.supported())
          support_of[static_cast<unsigned int>(dof / dim)] = names[support];
      for (const auto &pair : unknowns.pairs().all())
        if (support_of.count(pair.first) > 0)
          for (unsigned int d = 0; d < dim; ++d)
            {
              const double force = pair.sign * on_high(dim * pair.first + d);
              result.reactions[support_of[pair.first]][d] += force;
              result.reactions[support_of[pair.second]][d] -= force;
            }
      // Bonds of vertices that a support moves pull at it.
      const auto &held = unknowns.contact().boundary().held_vertices;
      for (unsigned int k = 0; k < held.size(); ++k)
        {
          const dealii::Tensor<1, dim> force = held_forces[k] * held[k].normal;
          result.contact_reaction -= force;
          if (held[k].low_support < names.size())
            result.reactions[names[held[k].low_support]] -= force;
          else
            result.clamped_reaction += force;
          if (held[k].support < names.size())
            result.reactions[names[held[k].support]] += force;
        }

      DofVector tangential = contact;
      for (const auto normal : normals)
        tangential(normal) = 0.;
      result.tangential_reaction =
        resultant(unknowns.contact_forces(tangential));
      result.tangential_forces =
        at_contact_nodes<dim>(unknowns.contact_forces(tangential), normals);

      // Resultants can vanish where forces do not.
      DofVector supports = clamped;
      supports += contact;
      const double scale = supports.l1_norm() + applied.l1_norm();
      // Of each body.
      supports = unknowns.cartesian_forces(supports);
      supports += applied;
      std::vector<dealii::Tensor<1, dim>> sums(unknowns.n_bodies());
      for (unsigned int i = 0; i < supports.size(); ++i)
        sums[unknowns.body_of(i / dim)][i % dim] += supports(i);
      double imbalance = 0.;
      for (const dealii::Tensor<1, dim> &sum : sums)
        imbalance = std::max(imbalance, sum.norm());
      result.force_imbalance =
        imbalance > 0. ? imbalance / std::max(scale, resolved) : 0.;
    }
  } // namespace



  template <int dim>
  Verification<dim>
  verify(const ElasticProblem<dim>   &problem,
         const AdhesionIntegral<dim> &adhesion,
         const AdhesiveLaw           &law,
         const DofVector             &u,
         const LoadFactors            factors,
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

    const Eigen::VectorXd       s               = contact.trace(u);
    const Eigen::VectorXd       normal_residual = contact.trace(residual);
    const std::vector<Interval> forces = adhesion.force_intervals(s, 0.);

    Verification<dim> result;
    result.state_names     = state_names(law);
    result.penetration     = 0.;
    result.largest_opening = 0.;
    result.broken_zone     = broken_zone(boundary, law, adhesion, s);
    result.without_bonds   = zone_without_bonds(boundary, adhesion);
    for (unsigned int i = 0; i < s.size(); ++i)
      {
        ContactNodeState node;
        node.s                = s(i);
        node.u_nu             = s(i) + boundary.nodes[i].gap;
        node.normal_force     = -normal_residual(i);
        node.allowed_force    = unbounded_above_if(s(i) >= 0., forces[i]);
        const BondScale bonds = adhesion.points().bonds_at(i);
        node.bond_stiffness   = std::max(0., law.second_derivative(0.)) *
                              bonds.energy / (bonds.stretch * bonds.stretch);
        node.bond_threshold = law.bond_threshold() * bonds.stretch;
        node.damage =
          bonds.energy == 0. ?
            0. :
            law.damage(std::min(adhesion.reached(i), s(i) / bonds.stretch));
        result.largest_opening = std::max(result.largest_opening, -s(i));
        result.nodes.push_back(node);
        result.penetration = std::max(result.penetration, s(i));
      }

    DofVector              displacement = problem.unknowns().lifted(u, factors);
    const double           largest_displacement = displacement.linfty_norm();
    const LargestResiduals largest = largest_residuals(problem, residual);
    DofVector    rounding = problem.fields().residual_rounding(u, factors);
    const double largest_load =
      problem.fields().applied_nodal_forces(factors).linfty_norm();
    const double largest_force = std::max(largest_load, largest.supported);
    // Of w, where the body stays far from the foundation.
    const double rounding_of_gaps =
      problem.unknowns().has_gap() ?
        problem.fields()
          .residual_rounding(DofVector(u.size()), factors)
          .linfty_norm() :
        0.;
    // A body at rest, or off, has no other forces.
    if (Tolerance::force_rounding * largest_force < rounding_of_gaps)
      rounding.add(rounding_of_gaps);
    // Thermal loads balance each other. Where heat has loosened a press fit,
    // nothing but rounding is left of the forces, and the condensation leaves
    // up to 20 times what residual_rounding() counts.
    const double thermal_load =
      problem.fields().is_heated() ? largest_load : 0.;
    const double resolved_beside_loads =
      std::max(Tolerance::negligible_force * thermal_load,
               Tolerance::resolved *
                 std::min(rounding_of_gaps,
                          Tolerance::negligible_force * largest_force));
    const Eigen::VectorXd resolved_at_nodes =
      (Tolerance::resolved * contact.trace(rounding))
        .cwiseMax(resolved_beside_loads);
    const std::vector<LawScale> scales =
      law_scales(adhesion,
                 boundary,
                 result.nodes,
                 resolved_at_nodes,
                 {largest_displacement, largest.supported});
    compute_violations(adhesion, s, scales, result.nodes);

    const double largest_s = s.lpNorm<Eigen::Infinity>();
    result.law_violation   = 0.;
    for (unsigned int i = 0; i < result.nodes.size(); ++i)
      {
        set_state(i, adhesion, scales[i], largest_s, tolerance, result);
        result.law_violation =
          std::max(result.law_violation, result.nodes[i].violation);
      }

    const double resolved =
      std::max(Tolerance::resolved * rounding.linfty_norm(),
               resolved_beside_loads);
    result.equilibrium_residual =
      largest.free > 0. ?
        largest.free / std::max({largest.free, largest.supported, resolved}) :
        0.;
    // The rounding of a sum is that of all its terms.
    compute_force_balance(problem,
                          residual,
                          factors,
                          std::max(resolved,
                                   Tolerance::resolved * rounding.l1_norm()),
                          held_forces(adhesion, s),
                          result);

    result.force_rounding =
      largest_load > 0. ?
        std::max(rounding.linfty_norm(), rounding_of_gaps) / largest_force :
        0.;

    displacement =
      problem.unknowns().basis().to_nodal(displacement, BasisStep::jumps);
    // Of glued nodes that of the body on the high side.
    for (const auto &pair : problem.unknowns().pairs().all())
      if (pair.sign < 0.)
        for (unsigned int d = 0; d < dim; ++d)
          displacement(dim * pair.first + d) =
            displacement(dim * pair.second + d);
    result.displacements =
      at_contact_nodes<dim>(displacement, contact.normal_dofs());
    return result;
  }



  template struct Verification<2>;
  template struct Verification<3>;
  template decltype(verify<2>) verify<2>;
  template decltype(verify<3>) verify<3>;
} // namespace Debond
