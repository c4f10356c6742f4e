// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/contact/laws/winkler.h>

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    void
    require(const bool         condition,
            const std::string &parameter,
            const double       value,
            const std::string &range)
    {
      if (condition && std::isfinite(value))
        return;

      std::ostringstream message;
      message << parameter << " = " << value << " is out of range: it must be "
              << range << " and finite";
      throw std::invalid_argument(message.str());
    }
  } // namespace



  WinklerLaw::WinklerLaw(const double bond_stiffness,
                         const double bond_threshold)
    : a(bond_stiffness)
    , M(bond_threshold)
  {
    require(a >= 0., "Bond stiffness", a, ">= 0");
    require(M > 0., "Bond threshold", M, "> 0");
  }



  double
  WinklerLaw::value(const double s) const
  {
    if (s < -M)
      return a * M * M / 2.;
    if (s <= 0.)
      return a * s * s / 2.;
    return 0.;
  }



  Interval
  WinklerLaw::clarke_interval(const double s) const
  {
    if (s < -M || s >= 0.)
      return {0., 0.};
    if (s == -M)
      return {-a * M, 0.};
    return {a * s, a * s};
  }



  double
  WinklerLaw::curvature(const double s) const
  {
    return (s < -M || s > 0.) ? 0. : a;
  }



  LawShape
  WinklerLaw::shape() const
  {
    return a > 0. ? LawShape::two_branches : LawShape::convex;
  }



  std::vector<double>
  WinklerLaw::kinks() const
  {
    return {-M, 0.};
  }



  double
  WinklerLaw::bond_threshold() const
  {
    return a > 0. ? M : 0.;
  }



  double
  WinklerLaw::bond_strength() const
  {
    return a * M;
  }
} // namespace Debond
