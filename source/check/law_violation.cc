// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/infinity.h>
#include <debond/base/instantiate.h>
#include <debond/check/law_violation.h>

namespace Debond
{
  namespace
  {
    /// The distance of a force to the allowed ones.
    double
    distance(const double force, const Interval &allowed)
    {
      return std::max({0., allowed.lower - force, force - allowed.upper});
    }
  } // namespace



  double
  first_threshold(const AdhesiveLaw &law)
  {
    return law.pieces().size() > 1 ? -law.pieces()[1].upper : 0.;
  }



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
    const auto set =
      [&](const unsigned int i, const BondScale &bonds, const double measure) {
        const double threshold = first_threshold(law) * bonds.length;
        const double strength =
          law.bond_strength() * bonds.energy / bonds.length * measure;
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
          shear.length /= std::sqrt(bonds.shear);
        for (const auto &tangent : node.tangents)
          if (!tangent.is_held)
            set(tangent.index,
                bonds.shear > 0. ? shear : BondScale{0., 1.},
                node.measure);
      }
    return scales;
  }



  Interval
  unbounded_above_if(const bool contact, const Interval &interval)
  {
    return {interval.lower, contact ? infinity : interval.upper};
  }



  template <int dim>
  std::vector<double>
  violations(const AdhesionIntegral<dim> &adhesion,
             const VectorView            &s,
             const VectorView            &forces,
             const std::vector<LawScale> &scales)
  {
    // A larger delta allows more, so that bisection finds the least one. It
    // bisects the exponent, because a node next to a jump of the law is close
    // to the graph, however far its force is from what is allowed at its very
    // displacement.
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



  DEBOND_INSTANTIATE(law_scales);
  DEBOND_INSTANTIATE(violations);
} // namespace Debond
