// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_trace_constant_h
#define debond_certify_trace_constant_h

#include <debond/elasticity/material.h>

namespace Debond
{
  /// A triangle above one of its sides, the length of which is 1.
  struct TriangleAboveSide
  {
    double height; ///< of the apex above its line
    double apex;   ///< where the apex is along the side, from one end of it
  };



  /**
   * A number Lambda, force per volume, with
   *
   *     int_Q epsilon(v) : C epsilon(v) >= Lambda min_p int_I (v_nu - p)^2
   *
   * for all displacements v of the triangle Q, p linear on its side I, where
   * the tangential displacement is zero or free. For a side that is h times as
   * long it is 1/h times as large.
   *
   * Q is divided into n x n triangles of its kind; a part theta of the
   * stiffness of the n ones at I goes to what is not linear on each of their
   * sides, for which they have n times the best constant, and equilibrated
   * stresses bound the energy of the rest from below as a function of what is
   * linear: lambda_min(theta). That the best constant is not 0 is known (Korn's
   * inequality), and with theta n > 1
   *
   *     Lambda >= min(lambda_min(theta), theta n Lambda)
   *
   * says that it is at least lambda_min(theta) (doc/reference/certificate.md).
   */
  double
  trace_constant(const TriangleAboveSide &Q,
                 const Material          &material,
                 const bool               tangential_fixed,
                 const unsigned int       n = 8);
} // namespace Debond

#endif
