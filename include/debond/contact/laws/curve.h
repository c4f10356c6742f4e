// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_laws_curve_h
#define debond_contact_laws_curve_h

#include <debond/contact/law.h>

#include <utility>

namespace Debond
{
  /// Openings (length) and tractions (force per area) of a polygon.
  using TractionCurve = std::vector<std::pair<double, double>>;

  /**
   * Bonds by their traction over the opening -s: straight from one point of the
   * curve to the next, at an opening that is repeated a drop, and beyond the
   * last point what it has there. So
   *
   *     j_1(s) = int_0^{-s} traction(opening) d opening.
   *
   * Bonds are bonded as long as the traction rises from the beginning,
   * softening where it falls or stays, partly broken (1), (2), ... where it
   * rises after a drop, and broken where there is none any more.
   *
   * Throws std::invalid_argument unless the openings begin at 0 and do not
   * fall, tractions are not negative and finite, and rise at no opening that
   * is repeated.
   */
  ContactLawParameters
  curve_law(const TractionCurve &curve);

  /// Contact law/Curve, or the columns of a file.
  LawKind
  curve_kind();

  /// Gives what multiplies the tractions in a scene to a law, whose numbers
  /// hold everywhere else.
  void
  add_traction_factor(const ParameterTable &table, ContactLawParameters &law);

  /// The name of its entry.
  extern const char *const traction_factor;
} // namespace Debond

#endif
