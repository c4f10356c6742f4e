// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/base/tolerances.h>
#include <debond/elasticity/node_pairs.h>

namespace Debond
{
  template <int dim>
  bool
  NodePairs<dim>::add(const std::vector<BoundaryFace<dim>> &high,
                      const std::vector<BoundaryFace<dim>> &low)
  {
    // Nodes of both sides are paired by their places. Those of the low side are
    // sorted by one number, their place along a line, and each node of the high
    // side looks among those in a narrow interval of that number: n log n
    // operations in place of n^2. The line has no special direction, so that
    // few nodes have the same number.
    using Node = std::pair<unsigned int, dealii::Point<dim>>;
    std::multimap<double, Node> by_place;
    std::set<unsigned int>      of_low, of_high, common;
    std::vector<Pair>           added;
    for (const BoundaryFace<dim> &face : low)
      for (unsigned int n = 0; n < face.n_nodes; ++n)
        if (of_low.insert(face.indices[n]).second)
          by_place.emplace(place_on_line(face.positions[n]),
                           Node(face.indices[n], face.positions[n]));
    for (const BoundaryFace<dim> &face : high)
      for (unsigned int n = 0; n < face.n_nodes; ++n)
        {
          const unsigned int node = face.indices[n];
          // A node that both sides have in common is an end of the interface,
          // and has no jump.
          if (of_low.count(node) > 0)
            common.insert(node);
          else if (of_high.insert(node).second)
            {
              // Places count as the same relative to the length of an edge of
              // the face: mesh files have rounded coordinates. Numbers on the
              // line differ by less than twice the distance of the points, so
              // that the interval of 2 near on both sides misses none.
              const dealii::Point<dim> &point = face.positions[n];
              const double              near  = Tolerance::same_place *
                                  face.positions[0].distance(face.positions[1]);
              const double place = place_on_line(point);
              const auto   end   = by_place.upper_bound(place + 2. * near);
              const auto   other =
                std::find_if(by_place.lower_bound(place - 2. * near),
                             end,
                             [&](const auto &entry) {
                               return point.distance(entry.second.second) <=
                                      near;
                             });
              if (other == end)
                return false;
              // The first node is the one on the high side at first, with the
              // sign 1; glue() may exchange them.
              added.push_back({node, other->second.first, 1.});
            }
        }
    if (of_high.size() + common.size() != of_low.size())
      return false;
    pairs.insert(pairs.end(), added.begin(), added.end());
    shared.insert(common.begin(), common.end());
    return true;
  }



  DEBOND_INSTANTIATE_CLASS(NodePairs);
} // namespace Debond
