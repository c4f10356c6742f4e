// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_exact_energy_h
#define debond_certify_exact_energy_h

#include <debond/contact/adhesion_integral.h>

namespace Debond
{
  /// int_{Gamma_C} j_1(s) dGamma but for rounding, of the trace that
  /// @p adhesion has for s on the faces of @p boundary, where bonds of @p law
  /// do not vary along a face: in place of points on each face, points between
  /// the kinks that the trace crosses there. For upper bounds of J.
  double
  exact_energy(const AdhesionIntegral<2> &adhesion,
               const ContactBoundary<2>  &boundary,
               const AdhesiveLaw         &law,
               const VectorView          &s);
} // namespace Debond

#endif
