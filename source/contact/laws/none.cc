// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/contact/laws/none.h>

namespace Debond
{
  double
  NoAdhesion::value(const double /*s*/) const
  {
    return 0.;
  }



  Interval
  NoAdhesion::clarke_interval(const double /*s*/) const
  {
    return {0., 0.};
  }



  double
  NoAdhesion::curvature(const double /*s*/) const
  {
    return 0.;
  }



  LawShape
  NoAdhesion::shape() const
  {
    return LawShape::convex;
  }



  std::vector<double>
  NoAdhesion::kinks() const
  {
    return {};
  }



  double
  NoAdhesion::bond_threshold() const
  {
    return 0.;
  }



  double
  NoAdhesion::bond_strength() const
  {
    return 0.;
  }
} // namespace Debond
