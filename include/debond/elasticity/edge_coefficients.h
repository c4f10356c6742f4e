// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_edge_coefficients_h
#define debond_elasticity_edge_coefficients_h

#include <debond/elasticity/boundary_face.h>
#include <debond/elasticity/change_of_basis.h>

namespace Debond
{
  /// The coefficient of a quadratic function in the Bernstein basis (see
  /// bernstein()) that belongs to node @p n >= dim of a face, the middle of an
  /// edge. @p value: of the function at each of the face's nodes.
  template <int dim, typename Value>
  double
  edge_coefficient(const unsigned int n, const Value &value)
  {
    const auto &[a, b] = simplex_edges[n - dim];
    return 2. * value(n) - 0.5 * (value(a) + value(b));
  }



  /**
   * The step from the displacements in the middles of the edges of these faces,
   * those of the contact boundary, to edge_coefficient(): the displacement
   * along a normal is nowhere on a face larger than its largest coefficient, so
   * that u_nu <= 0 are bounds on unknowns. It has no rows for degree 1.
   */
  template <int dim>
  std::vector<BasisRow<dim>>
  edge_coefficients(const std::vector<BoundaryFace<dim>> &contact);
} // namespace Debond

#endif
