// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/interval.h>
#include <debond/solve/certified_side.h>

#include <algorithm>
#include <cmath>

namespace Debond
{
  namespace
  {
    /// Of points on a side, relative to its length.
    constexpr double place_rounding = 1e-8;

    /// Intervals are made wider by so much of what is added up.
    constexpr double range_rounding = 1e-12;



    /// (1 - part) a + part b, part from 0 to 1; 0 times infinity is 0.
    Interval
    between(const Interval &a, const Interval &b, const double part)
    {
      if (part <= 0.)
        return a;
      if (part >= 1.)
        return b;
      const auto sum = [&](const double one, const double other) {
        return (1. - part) * one + part * other;
      };
      return {sum(a.lower, b.lower), sum(a.upper, b.upper)};
    }



    Interval
    widened(const Interval &interval, const double distance)
    {
      const auto rounding = [](const double value) {
        return std::isfinite(value) ? range_rounding * std::abs(value) : 0.;
      };
      return {interval.lower - distance - rounding(interval.lower),
              interval.upper + distance + rounding(interval.upper)};
    }



    /// p at xi, from -1 at the first end to 1 at the second one.
    Interval
    linear_at(const CertifiedSide &side, const double xi)
    {
      return intersection(between(side.at_ends[0],
                                  side.at_ends[1],
                                  0.5 * (1. + xi)),
                          xi < 0. ? between(side.mean, side.at_ends[0], -xi) :
                                    between(side.mean, side.at_ends[1], xi));
    }
  } // namespace



  CertifiedSide
  known_between(const std::array<dealii::Point<2>, 2> &ends,
                const std::vector<CertifiedSide>      &sides)
  {
    CertifiedSide result;
    result.ends = ends;
    for (const CertifiedSide &side : sides)
      {
        const dealii::Tensor<1, 2> along  = side.ends[1] - side.ends[0];
        const double               length = along.norm();
        std::array<double, 2>      xi;
        bool                       is_on = true;
        for (unsigned int k = 0; k < 2; ++k)
          {
            const dealii::Tensor<1, 2> here = ends[k] - side.ends[0];
            const double part = here * along / along.norm_square();
            xi[k]             = 2. * part - 1.;
            is_on             = is_on && part > -place_rounding &&
                    part < 1. + place_rounding &&
                    (here - part * along).norm() < place_rounding * length;
            // Ends that are the same are not known less well.
            for (const double end : {-1., 1.})
              if (std::abs(xi[k] - end) < 2. * place_rounding)
                xi[k] = end;
          }
        if (!is_on)
          continue;

        const double own = 0.5 * std::abs(xi[1] - xi[0]) * length;
        /// How far a functional of u_nu on the part, with this squared norm in
        /// L2, and 1 and @p place for the functions 1 and xi, is from that of
        /// p.
        const auto distance = [&](const double squared, const double place) {
          const double rest = squared - (1. + 3. * place * place) / length;
          return rest > place_rounding * squared ?
                   std::sqrt(rest) * side.deviation :
                   0.;
        };
        const double middle = 0.5 * (xi[0] + xi[1]);
        result.mean         = intersection(result.mean,
                                   widened(linear_at(side, middle),
                                           distance(1. / own, middle)));
        for (unsigned int k = 0; k < 2; ++k)
          result.at_ends[k] =
            widened(linear_at(side, xi[k]), distance(4. / own, xi[k]));
        result.deviation = side.deviation;
        return result;
      }
    return result;
  }



  CertifiedSide
  intersection(const CertifiedSide &a, const CertifiedSide &b)
  {
    CertifiedSide result;
    result.ends = a.ends;
    result.mean = intersection(a.mean, b.mean);
    for (unsigned int k = 0; k < 2; ++k)
      result.at_ends[k] = intersection(a.at_ends[k], b.at_ends[k]);
    result.deviation = std::min(a.deviation, b.deviation);
    return result;
  }
} // namespace Debond
