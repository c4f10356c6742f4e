// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_minimum_kind_h
#define debond_solve_minimum_minimum_kind_h

#include <debond/contact/adhesion_integral.h>
#include <debond/linear_algebra/condensation.h>

namespace Debond
{
  /// The kind of a result among the stationary points of J.
  enum class MinimumKind
  {
    stationary,    ///< it satisfies the contact law
    local_minimum, ///< and no bond is on the kink, so that J rises around it
    best_known,    ///< and no state that the search tried has a lower J
    global         ///< and no point is lower, but for the gap
  };

  std::string
  to_string(const MinimumKind kind);

  /// stationary, local minimum, or global if J is convex: without contact
  /// nodes, or with a law of one piece, such as none. Where bonds soften, a
  /// minimum is known by S and g of @p condensed.
  template <int dim>
  MinimumKind
  kind_without_search(const AdhesionIntegral<dim> &adhesion,
                      const VectorView            &s,
                      const Condensation          *condensed = nullptr);
} // namespace Debond

#endif
