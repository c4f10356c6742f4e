// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/edge_coefficients.h>

namespace Debond
{
  template <int dim>
  EdgeCoefficients<dim>::EdgeCoefficients(
    const unsigned int                    n_nodes,
    const std::vector<BoundaryFace<dim>> &contact)
  {
    for (const BoundaryFace<dim> &face : contact)
      for (unsigned int k = dim; k < face.n_nodes; ++k)
        {
          number_of_node.resize(n_nodes, dealii::numbers::invalid_unsigned_int);
          if (find(face.indices[k]) != nullptr)
            continue;
          const auto &[a, b] = simplex_edges[k - dim];
          number_of_node[face.indices[k]] =
            static_cast<unsigned int>(edges.size());
          edges.push_back(
            {face.indices[k], {{face.indices[a], face.indices[b]}}});
        }
  }



  template class EdgeCoefficients<2>;
  template class EdgeCoefficients<3>;
} // namespace Debond
