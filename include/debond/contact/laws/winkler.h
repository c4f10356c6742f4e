// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_laws_winkler_h
#define debond_contact_laws_winkler_h

#include <debond/contact/law.h>

namespace Debond
{
  /**
   * The paper's law, eq. (10): bonds are linear springs of stiffness a (force
   * per volume) that break at the displacement -M (length),
   *
   *     j_1(s) = a M^2 / 2  for s < -M,
   *              a s^2 / 2  for s in [-M, 0],
   *              0          for s > 0.
   *
   * The kink at -M is concave; at 0 only the second derivative jumps. Without
   * stiffness there is no adhesion.
   *
   * Throws std::invalid_argument unless a >= 0 and M > 0, both finite.
   */
  ContactLawParameters
  winkler_law(const double bond_stiffness, const double bond_threshold);

  LawKind
  winkler_kind();
} // namespace Debond

#endif
