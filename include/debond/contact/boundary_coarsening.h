// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_boundary_coarsening_h
#define debond_contact_boundary_coarsening_h

#include <debond/contact/boundary.h>

#include <Eigen/SparseCore>

namespace Debond
{
  /**
   * Coarser and coarser spaces of normal displacements, made from the graph of
   * the contact nodes alone: of neighbours at most one is kept, and the others
   * take the mean of their kept neighbours, weighted by the inverse distances
   * (on a line of nodes, every second one and linear interpolation). Ends when
   * a space has at most @p coarsest nodes.
   *
   * Returns the prolongations to the next finer space, the finest first.
   */
  template <int dim>
  std::vector<Eigen::SparseMatrix<double>>
  coarsen(const ContactBoundary<dim> &boundary, const unsigned int coarsest);
} // namespace Debond

#endif
