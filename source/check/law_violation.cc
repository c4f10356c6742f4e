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
    // Pieces are listed from s = 0 downwards, so that the first kink is the
    // upper end of the second piece. It is negative, as openings are negative
    // displacements.
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
    // F_i and L_i make errors of forces and of displacements comparable. F_i is
    // what the bond can bear, but at most the largest contact force, since a
    // strength far above all forces would make any error small; and it is at
    // least what rounding resolves. L_i is the displacement at which bonds pull
    // with F_i, but at most the largest displacement of the body.
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
        // With j_1(s) = energy j(s / length), kinks are multiplied by the
        // length and tractions by energy over length. A traction times the
        // measure of the node is a force.
        const double threshold = first_threshold(law) * bonds.length;
        const double strength =
          law.bond_strength() * bonds.energy / bonds.length * measure;
        const bool has_bonds = threshold > 0. && strength > 0.;
        LawScale  &scale     = scales[i];
        if (has_bonds)
          scale.force = std::min(scale.force, strength);
        scale.force = std::max(scale.force, resolved(i));
        if (has_bonds)
          // The bond is taken for a spring that bears its strength at the first
          // kink, so that F_i opens it by this part of the threshold.
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
    // The distance of a node from the graph of the law is the least delta for
    // which its force is within delta F_i of a force that the law allows within
    // delta L_i of s_i. A larger delta allows more, so that bisection finds the
    // least one. It bisects the exponent, because a node next to a jump of the
    // law is close to the graph, however far its force is from what is allowed
    // at its very displacement: delta may be 1e-12 there, or 1, and is wanted
    // to the same relative accuracy.
    const unsigned int          n       = adhesion.n_unknowns();
    const unsigned int          n_nodes = adhesion.n_nodes();
    const std::vector<Interval> at_s    = adhesion.force_intervals(s, 0.);

    // The first upper end of delta is the one that is needed if displacements
    // are fixed: the distance of the force from the Clarke interval at s_i, or
    // the penetration. It is exactly zero for a node on the graph, and stays
    // so. Otherwise the lower end is the least positive number, since zero has
    // no exponent.
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

    // Eleven steps find the binary exponent among the 2^11 of double precision,
    // and 53 more find the mantissa.
    std::vector<double> delta(n);
    std::vector<double> radius(n);
    for (unsigned int step = 0; step < 11 + 53; ++step)
      {
        // The middle of the exponents is the geometric mean. Its roots are
        // taken apart, as the product of two small numbers would underflow.
        for (unsigned int i = 0; i < n; ++i)
          {
            delta[i]  = std::sqrt(lower[i]) * std::sqrt(upper[i]);
            radius[i] = delta[i] * scales[i].length;
          }
        const std::vector<Interval> intervals =
          adhesion.force_intervals(s, radius);
        for (unsigned int i = 0; i < n; ++i)
          {
            // The allowed forces are the hull of the Clarke intervals over s_i
            // +- delta L_i (Goldstein's subdifferential), and all above it if
            // contact is within that distance. Unknowns along tangents have no
            // bound and no contact.
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

    // Both components of friction in a plane may be what it can bear, and its
    // size more than that. It is what bonds leave of the force.
    const Kinks    &kinks = adhesion.kinks();
    Eigen::VectorXd left  = Eigen::VectorXd::Zero(n);
    for (const Eigen::Index i : kinks.pairs())
      if (kinks.way(i, s) == 0.)
        {
          const auto pair = kinks.group(i);
          for (const Eigen::Index j : pair)
            left(j) = distance(forces(j),
                               {at_s[j].lower + kinks.weight(j),
                                at_s[j].upper - kinks.weight(j)});
          for (const Eigen::Index j : pair)
            upper[j] = std::max(upper[j],
                                (kinks.size(i, left) - kinks.weight(i)) /
                                  scales[j].force);
        }
    return upper;
  }



  DEBOND_INSTANTIATE(law_scales);
  DEBOND_INSTANTIATE(violations);
} // namespace Debond
