// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/global/convex_envelope.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Debond
{
  namespace
  {
    /// min r s + c/2 s^2 on [lower, upper].
    long double
    least_on_parabola(const long double r,
                      const long double c,
                      const long double lower,
                      const long double upper)
    {
      if (lower > upper)
        return std::numeric_limits<long double>::infinity();
      const long double s = c > 0. ? std::min(std::max(-r / c, lower), upper) :
                                     (r > 0. ? lower : upper);
      return r * s + 0.5L * c * s * s;
    }
  } // namespace



  double
  BondEnergy::value(const double s) const
  {
    const double bond = std::min(std::abs(s), threshold);
    return 0.5 * convexity * s * s + 0.5 * stiffness * bond * bond;
  }



  long double
  BondEnergy::energy_if_broken() const
  {
    return 0.5L * stiffness * threshold * threshold;
  }



  long double
  BondEnergy::least_bonded(const long double r,
                           const double      lower,
                           const double      upper) const
  {
    return least_on_parabola(r,
                             static_cast<long double>(convexity) + stiffness,
                             std::max(lower, -threshold),
                             upper);
  }



  long double
  BondEnergy::least_broken(const long double r,
                           const double      lower,
                           const double      upper) const
  {
    return least_on_parabola(r, convexity, lower, std::min(upper, -threshold)) +
           energy_if_broken();
  }



  long double
  BondEnergy::least(const long double r,
                    const double      lower,
                    const double      upper) const
  {
    constexpr long double epsilon = std::numeric_limits<long double>::epsilon();
    return std::min(least_bonded(r, lower, upper),
                    least_broken(r, lower, upper) -
                      16.L * epsilon * energy_if_broken());
  }



  ConvexEnvelope::ConvexEnvelope(const BondEnergy &energy,
                                 const double      lower,
                                 const double      upper)
    : f(energy)
  {
    const double M  = f.threshold;
    const double c0 = f.convexity;               // of the broken parabola
    const double c1 = f.convexity + f.stiffness; // of the bonded one
    const double h  = static_cast<double>(f.energy_if_broken());

    double first = lower, second = upper;
    if (f.stiffness == 0. || lower >= -M)
      second = lower;
    else if (upper <= -M)
      first = upper;
    else
      {
        // The line that touches both parabolas, as far as they reach.
        if (c0 > 0.)
          {
            const double slope = -std::sqrt(2. * h * c0 * c1 / f.stiffness);
            first              = std::max(lower, slope / c0);
            second             = std::min(upper, slope / c1);
          }
        if (first == lower)
          {
            const double value = 0.5 * c0 * lower * lower + h;
            second             = std::min(
              upper,
              lower + std::sqrt(std::max(0., lower * lower - 2. * value / c1)));
          }
        if (second == upper && c0 > 0.)
          {
            const double value = 0.5 * c1 * upper * upper;
            first              = std::max(
              lower,
              upper -
                std::sqrt(std::max(0., upper * upper + 2. * (h - value) / c0)));
          }
      }
    const double slope =
      second > first ? (f.value(second) - f.value(first)) / (second - first) :
                       0.;
    pieces[0] = {lower, first, 0., c0};
    pieces[1] = {first, second, slope, 0.};
    pieces[2] = {second, upper, 0., c1};
  }



  double
  ConvexEnvelope::value(const double s) const
  {
    if (s <= pieces[1].lower || s >= pieces[1].upper)
      return f.value(s);
    return f.value(pieces[1].lower) + pieces[1].slope * (s - pieces[1].lower);
  }



  double
  ConvexEnvelope::spread(const double s) const
  {
    return std::max(0., s - pieces[1].lower) *
           std::max(0., pieces[1].upper - s);
  }
} // namespace Debond
