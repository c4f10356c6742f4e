// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_trace_constant_h
#define debond_certify_trace_constant_h

#include <debond/elasticity/material.h>

namespace Debond
{
  /// A rectangle above one of its sides.
  struct RectangleAboveSide
  {
    double width;  ///< of the side
    double height; ///< of the rectangle above it
  };



  /// A triangle above one of its sides.
  struct TriangleAboveSide
  {
    double width;  ///< of the side
    double height; ///< of the apex above its line
    double apex;   ///< where the apex is along the side, from one end of it
  };



  /**
   * A number Lambda, force per volume, with
   *
   *     int_Q epsilon(v) : C epsilon(v) >= Lambda min_p int_I (v_nu - p)^2
   *
   * for all displacements v of the rectangle Q, p linear on its side I, where
   * the tangential displacement is zero or free.
   *
   * This one follows from integrating twice along I the relation between v_nu
   * and the strains in Q (doc/reference/certificate.md, Lemma 2).
   */
  double
  elementary_trace_constant(const RectangleAboveSide &Q,
                            const Material           &material,
                            const bool                tangential_fixed);

  /**
   * A larger one. The rectangle is divided into n x n of its kind; a part
   * theta of the stiffness of those at I bounds by their own constants what is
   * not linear on each of them, and equilibrated stresses bound the energy of
   * the rest from below as a function of what is: so a constant Lambda
   * makes another one,
   *
   *     min(lambda_min(theta), theta n Lambda).
   *
   * That is repeated from the elementary one until it rises no more, with the
   * best theta.
   */
  double
  trace_constant(const RectangleAboveSide &Q,
                 const Material           &material,
                 const bool                tangential_fixed,
                 const unsigned int        n = 16);

  /**
   * The same for a triangle, from its division into n x n triangles of its
   * kind, n of them at I as the triangle itself is. That the best constant
   * Lambda is not 0 is known (Korn's inequality), and with theta n > 1
   *
   *     Lambda >= min(lambda_min(theta), theta n Lambda)
   *
   * says that it is at least lambda_min(theta).
   */
  double
  trace_constant(const TriangleAboveSide &Q,
                 const Material          &material,
                 const bool               tangential_fixed,
                 const unsigned int       n = 8);
} // namespace Debond

#endif
