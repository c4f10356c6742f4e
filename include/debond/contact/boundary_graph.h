// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_boundary_graph_h
#define debond_contact_boundary_graph_h

#include <debond/contact/boundary.h>

#include <set>

namespace Debond
{
  /// For each node of the contact boundary those that share a face with it.
  template <int dim>
  std::vector<std::set<unsigned int>>
  neighbours(const ContactBoundary<dim> &boundary);
} // namespace Debond

#endif
