// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/elasticity/edge_coefficients.h>

namespace Debond
{
  template <int dim>
  std::vector<BasisRow<dim>>
  edge_coefficients(const std::vector<BoundaryFace<dim>> &contact)
  {
    // On an edge with the ends a, b the quadratic polynomial is l_a^2 u_a + 2
    // l_a l_b c + l_b^2 u_b, whose value in the middle is (u_a + 2 c + u_b) /
    // 4. This is the row of the step, u(middle) = c / 2 + (u_a + u_b) / 4, for
    // each component of the displacement. An edge of two contact faces has it
    // once.
    std::set<unsigned int>     middles;
    std::vector<BasisRow<dim>> rows;
    for (const BoundaryFace<dim> &face : contact)
      for (unsigned int n = dim; n < face.n_nodes; ++n)
        if (middles.insert(face.indices[n]).second)
          {
            const auto &[a, b] = simplex_edges[n - dim];
            rows.push_back(BasisRow<dim>::scaled(face.indices[n],
                                                 0.5,
                                                 {{face.indices[a], 0.25},
                                                  {face.indices[b], 0.25}}));
          }
    return rows;
  }



  DEBOND_INSTANTIATE(edge_coefficients);
} // namespace Debond
