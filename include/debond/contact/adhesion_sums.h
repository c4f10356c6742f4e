// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_adhesion_sums_h
#define debond_contact_adhesion_sums_h

#include <debond/contact/adhesion_integral.h>

/// @file
/// Sums over the points of an AdhesionIntegral that only results, checks and
/// the search for other minima need.

namespace Debond
{
  /// The length (area) of the points whose bonds are broken, or that have none,
  /// and that have a gap.
  template <int dim>
  double
  open_measure(const AdhesionIntegral<dim> &phi, const VectorView &s);

  /// The derivatives of Phi by the normal displacements of
  /// ContactBoundary::held_vertices.
  template <int dim>
  std::vector<double>
  held_forces(const AdhesionIntegral<dim> &phi, const VectorView &s);

  /// The derivative of j_1 at a place on a face (at a kink: that of the piece
  /// on the side of 0), minus the traction of the bonds on the body.
  template <int dim>
  Jump<dim>
  traction(const AdhesionIntegral<dim>                       &phi,
           const typename AdhesionIntegral<dim>::Face        &face,
           const typename AdhesionIntegral<dim>::Barycentric &place,
           const VectorView                                  &s);

  /// That derivative at the place of each node, which has a force of a mean
  /// around it: of its faces the largest.
  template <int dim>
  std::vector<Jump<dim>>
  node_tractions(const AdhesionIntegral<dim> &phi, const VectorView &s);

  /// For each unknown along a tangent the part of their stiffness that bonds in
  /// shear have lost which break by themselves, 0 if there are none.
  template <int dim>
  std::vector<double>
  shear_damage(const AdhesionIntegral<dim> &phi, const VectorView &s);

  /// Returns whether at some point the traction drops within @p part of its
  /// displacement.
  template <int dim>
  bool
  is_at_drop(const AdhesionIntegral<dim> &phi,
             const VectorView            &s,
             const double                 part);

  /// The second derivative of Phi with the least one of each point within
  /// @p part of its displacement: a bound where bonds are next to a kink.
  template <int dim>
  Eigen::SparseMatrix<double>
  least_second_derivative(const AdhesionIntegral<dim> &phi,
                          const VectorView            &s,
                          const double                 part);

  /// For each node the factor of the law's second derivative in that of Phi if
  /// all bonds are lumped at nodes.
  template <int dim>
  Eigen::VectorXd
  lumped_weights(const AdhesionIntegral<dim> &phi);
} // namespace Debond

#endif
