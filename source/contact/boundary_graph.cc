// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/contact/boundary_graph.h>

namespace Debond
{
  template <int dim>
  std::vector<std::set<unsigned int>>
  neighbours(const ContactBoundary<dim> &boundary)
  {
    // Coefficients of one face are those that a quadrature point can couple,
    // with quadratic displacements those of edges too. Held vertices are no
    // unknowns and connect nothing.
    std::vector<std::set<unsigned int>> result(boundary.nodes.size());
    for (const auto &face : boundary.faces)
      for (unsigned int k = 0; k < boundary.n_face_nodes(); ++k)
        for (unsigned int l = 0; l < boundary.n_face_nodes(); ++l)
          if (k != l && !face.is_held(k) && !face.is_held(l))
            result[face.node(k)].insert(face.node(l));
    return result;
  }



  DEBOND_INSTANTIATE(neighbours);
} // namespace Debond
