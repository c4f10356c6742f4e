// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_check_law_violation_h
#define debond_check_law_violation_h

#include <debond/contact/adhesion_integral.h>

namespace Debond
{
  /// The displacement at which bonds first change their branch, as a positive
  /// length; zero if they never do.
  double
  first_threshold(const AdhesiveLaw &law);

  /// L_i and F_i of Verification::law_violation, with which the displacement
  /// and the force of a node are compared.
  struct LawScale
  {
    double length;
    double force;

    /// What rounding of forces is of the displacement.
    double rounding = 0.;
  };

  /// The scales of each unknown of the contact boundary. @p forces: along them;
  /// @p resolved: the least force that is, of each; @p largest: displacement of
  /// the body and force of a support.
  template <int dim>
  std::vector<LawScale>
  law_scales(const AdhesionIntegral<dim> &adhesion,
             const ContactBoundary<dim>  &boundary,
             const VectorView            &forces,
             const VectorView            &resolved,
             const LawScale              &largest);

  /// The interval of forces, without a bound above if the foundation presses.
  Interval
  unbounded_above_if(const bool contact, const Interval &interval);

  /// The distances of Verification::law_violation, one for each unknown of the
  /// contact boundary, of which those from n_nodes() on have no bound.
  template <int dim>
  std::vector<double>
  violations(const AdhesionIntegral<dim> &adhesion,
             const VectorView            &s,
             const VectorView            &forces,
             const std::vector<LawScale> &scales);
} // namespace Debond

#endif
