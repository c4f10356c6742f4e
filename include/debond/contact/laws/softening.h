// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_laws_softening_h
#define debond_contact_laws_softening_h

#include <debond/contact/law.h>

namespace Debond
{
  /// Bonds that are springs up to a strength and then soften.
  struct SofteningBonds
  {
    double stiffness; ///< force per volume
    double strength;  ///< force per area
    double energy;    ///< what it takes to break them, energy per area
  };

  /**
   * With a traction that falls in a straight line, to nothing at the opening 2
   * energy / strength: curve_law() of three points.
   *
   * Both laws throw std::invalid_argument unless all numbers are positive and
   * finite, and the energy exceeds strength^2 / (2 stiffness), what a bond
   * stores.
   */
  ContactLawParameters
  bilinear_law(const SofteningBonds &bonds);

  /// With one that falls as exp(-opening strength / (energy - strength^2 / (2
  /// stiffness))), so that bonds take the energy, but are never quite broken.
  ContactLawParameters
  exponential_law(const SofteningBonds &bonds);

  LawKind
  bilinear_kind();

  LawKind
  exponential_kind();
} // namespace Debond

#endif
