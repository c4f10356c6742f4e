// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/elasticity/node_pairs.h>
#include <debond/mesh/field_value.h>

#include <algorithm>
#include <map>
#include <stdexcept>

namespace Debond
{
  template <int dim>
  NodePairs<dim>::NodePairs(const unsigned int                    n_nodes,
                            const std::vector<BoundaryFace<dim>> &high,
                            const std::vector<BoundaryFace<dim>> &low)
  {
    if (high.empty())
      return;
    std::multimap<double, std::pair<unsigned int, dealii::Point<dim>>> of_low;
    std::vector<char> is_known(n_nodes, 0);
    for (const BoundaryFace<dim> &face : low)
      for (unsigned int n = 0; n < face.n_nodes; ++n)
        if (is_known[face.indices[n]] == 0)
          {
            is_known[face.indices[n]] = 1;
            of_low.emplace(place_on_line(face.positions[n]),
                           std::pair(face.indices[n], face.positions[n]));
          }
    number_of_node.assign(n_nodes, dealii::numbers::invalid_unsigned_int);
    for (const BoundaryFace<dim> &face : high)
      for (unsigned int n = 0; n < face.n_nodes; ++n)
        {
          const unsigned int node = face.indices[n];
          if (is_known[node] == 1)
            shared.insert(node);
          if (is_known[node] == 1 ||
              number_of_node[node] != dealii::numbers::invalid_unsigned_int)
            continue;
          const dealii::Point<dim> &point = face.positions[n];
          const double              near  = Tolerance::same_place *
                              face.positions[0].distance(face.positions[1]);
          const double place = place_on_line(point);
          auto         other = of_low.lower_bound(place - 2. * near);
          while (other != of_low.end() && other->first <= place + 2. * near &&
                 point.distance(other->second.second) > near)
            ++other;
          if (other == of_low.end() ||
              point.distance(other->second.second) > near)
            throw std::invalid_argument(
              "the meshes on the two sides of an interface do not match at " +
              point_text(point));
          number_of_node[node] = number_of_node[other->second.first] =
            static_cast<unsigned int>(pairs.size());
          pairs.push_back({node, other->second.first, 1.});
        }
  }



  template class NodePairs<2>;
  template class NodePairs<3>;
} // namespace Debond
