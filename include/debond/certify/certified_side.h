// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_certified_side_h
#define debond_certify_certified_side_h

#include <deal.II/base/point.h>

#include <debond/base/infinity.h>
#include <debond/optimization/interval.h>

#include <array>
#include <optional>

namespace Debond
{
  /// The ranges that each admissible displacement with J at most some value has
  /// on a side of the contact boundary: those of its normal displacement u_nu
  /// and of the linear function p that is nearest to it in L2 of the side.
  struct CertifiedSide
  {
    std::array<dealii::Point<2>, 2> ends;

    /// The mean of u_nu, which is that of p.
    Interval mean = {-infinity, 0.};

    /// p at the ends.
    std::array<Interval, 2> at_ends = {
      {{-infinity, infinity}, {-infinity, infinity}}};

    /// Combines all ranges with those of another side, by hull() or
    /// intersection().
    template <typename Function>
    void
    combine(const Function &function, const CertifiedSide &other)
    {
      mean = function(mean, other.mean);
      for (const unsigned int k : {0, 1})
        at_ends[k] = function(at_ends[k], other.at_ends[k]);
    }

    /// The piece of the law on which p is, if it is certain.
    std::optional<unsigned int> piece;

    /// Contains p at each point.
    Interval
    linear() const
    {
      return hull(at_ends[0], at_ends[1]);
    }
  };
} // namespace Debond

#endif
