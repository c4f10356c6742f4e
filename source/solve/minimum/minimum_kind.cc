// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/contact/adhesion_sums.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/optimization/global/convexity_shift.h>
#include <debond/solve/minimum/minimum_kind.h>

namespace Debond
{
  std::string
  to_string(const MinimumKind kind)
  {
    static const std::array<const char *, 4> words = {
      {"stationary", "local minimum", "best known", "global"}};
    return words[static_cast<std::size_t>(kind)];
  }



  template <int dim>
  MinimumKind
  kind_without_search(const AdhesionIntegral<dim> &adhesion,
                      const VectorView            &s,
                      const Condensation          *condensed)
  {
    // Nor has Coulomb's friction a functional that is least.
    if (adhesion.friction().depends_on_pressure())
      return MinimumKind::stationary;
    // Without a second piece of the law, or without contact nodes, J is convex
    // and any stationary point is the minimum.
    if (adhesion.adhesive_law().pieces().size() == 1 || s.size() == 0)
      return MinimumKind::global;
    // With an energy that depends on the mode there is no J that it would be a
    // minimum of.
    if (adhesion.points().depends_on_mode())
      return MinimumKind::stationary;
    // At a drop of the traction J has a concave kink, from which one of the two
    // directions descends. So close to it rounding decides on which side a bond
    // is, and nothing is claimed.
    if (is_at_drop(adhesion, s, Tolerance::at_kink))
      return MinimumKind::stationary;
    // Away from kinks J is a convex quadratic on s <= 0: it rises around the
    // point.
    if (!adhesion.softens())
      return MinimumKind::local_minimum;
    // If bonds soften, Phi'' is negative, and only S can tell whether it
    // outweighs that.
    if (condensed == nullptr)
      return MinimumKind::stationary;
    // The second-order condition: S + Phi'' is positive definite on the s_i
    // that are free, with the smaller Phi'' if a bond is next to a kink. Nodes
    // at s = 0 under pressure cannot move to first order, nor can those that
    // stick below the bound of friction; those that only touch the foundation
    // can, and are free too.
    const Eigen::MatrixXd S = condensed->schur_complement();
    const Eigen::VectorXd pressure =
      condensed->load() - S * s - adhesion.subgradient(s);
    const double least =
      Tolerance::at_kink * condensed->load().cwiseAbs().maxCoeff();
    const Kinks              &kinks = adhesion.kinks();
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < s.size(); ++i)
      if (kinks.has(i) ? kinks.way(i, s) != 0. ||
                           kinks.size(i, pressure) >= kinks.weight(i) - least :
                         s(i) < 0. || pressure(i) <= least)
        free.push_back(i);
    Eigen::MatrixXd A = S;
    A += least_second_derivative(adhesion, s, Tolerance::at_kink) +
         kinks.curvature(s);
    return is_safely_positive_definite(A(free, free)) ?
             MinimumKind::local_minimum :
             MinimumKind::stationary;
  }



  DEBOND_INSTANTIATE(kind_without_search);
} // namespace Debond
