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



  template <int dim>
  void
  NodePairs<dim>::add_seconds(
    std::vector<dealii::types::global_dof_index> &dofs) const
  {
    if (pairs.empty())
      return;
    const std::size_t n = dofs.size();
    for (std::size_t i = 0; i < n; i += dim)
      if (const Pair *pair =
            find_first(static_cast<unsigned int>(dofs[i] / dim)))
        for (unsigned int d = 0; d < dim; ++d)
          dofs.push_back(pair->second * dim + d);
  }



  template <int dim>
  void
  NodePairs<dim>::to_unknowns(
    const std::vector<dealii::types::global_dof_index> &dofs,
    dealii::FullMatrix<double>                         &matrix) const
  {
    const auto n_own = static_cast<unsigned int>(matrix.m());
    const auto n     = static_cast<unsigned int>(dofs.size());
    if (n == n_own)
      return;
    dealii::FullMatrix<double> all(n);
    for (unsigned int i = 0; i < n_own; ++i)
      for (unsigned int j = 0; j < n_own; ++j)
        all(i, j) = matrix(i, j);
    unsigned int next = n_own;
    for (unsigned int i = 0; i < n_own; i += dim)
      if (const Pair *pair =
            find_first(static_cast<unsigned int>(dofs[i] / dim)))
        for (unsigned int d = i; d < i + dim; ++d, ++next)
          {
            for (unsigned int j = 0; j < n; ++j)
              {
                all(next, j) = all(d, j);
                all(d, j) *= pair->sign;
              }
            for (unsigned int j = 0; j < n; ++j)
              {
                all(j, next) = all(j, d);
                all(j, d) *= pair->sign;
              }
          }
    matrix = all;
  }



  template class NodePairs<2>;
  template class NodePairs<3>;
} // namespace Debond
