// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_load_factors_h
#define debond_elasticity_load_factors_h

#include <tuple>

namespace Debond
{
  /// Multiples of what is applied (but for dead loads, which are constant) and
  /// of prescribed displacements.
  struct LoadFactors
  {
    LoadFactors(const double of_all = 1.)
      : loads(of_all)
      , displacements(of_all)
    {}

    LoadFactors(const double loads, const double displacements)
      : loads(loads)
      , displacements(displacements)
    {}

    double loads;
    double displacements;
  };



  inline bool
  operator==(const LoadFactors &a, const LoadFactors &b)
  {
    return a.loads == b.loads && a.displacements == b.displacements;
  }

  /// An order for maps: by the factor of the loads first.
  inline bool
  operator<(const LoadFactors &a, const LoadFactors &b)
  {
    return std::tie(a.loads, a.displacements) <
           std::tie(b.loads, b.displacements);
  }
} // namespace Debond

#endif
