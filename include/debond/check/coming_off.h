// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_check_coming_off_h
#define debond_check_coming_off_h

#include <debond/contact/adhesion_integral.h>
#include <debond/elasticity/elastic_problem.h>

namespace Debond
{
  /// A rigid motion along which J falls without end: no contact node goes
  /// towards the foundation, the loads do work, and what bonds take of it ends.
  template <int dim>
  struct ComingOff
  {
    /// About the mean of the contact nodes, whose largest displacement, along
    /// the normal or along a tangent that is an unknown, is 1.
    RigidMotion<dim> motion;

    /// The work of the loads for each unit of that displacement: a force.
    double work;

    /// The largest normal displacement of a contact node towards the
    /// foundation: rounding.
    double towards_foundation;
  };

  /**
   * Whether the loads times @p factors pull the body off, from loads, supports
   * and law, without the solver: the motion is the projection of the loads'
   * resultant, less what bonds still pull with, on the rigid motions that
   * supports and foundation allow. Far enough along it all bonds that move are
   * on the last piece of the law, where they pull with one traction or none.
   *
   * None if the foundation alone balances the loads, if what is left is
   * rounding, or if bonds pull the more the further they are opened, or with a
   * traction in shear too: then the body does not come off, or it cannot be
   * told.
   */
  template <int dim>
  std::optional<ComingOff<dim>>
  coming_off(const ElasticProblem<dim>   &problem,
             const AdhesionIntegral<dim> &adhesion,
             const LoadFactors            factors);
} // namespace Debond

#endif
