// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>

#include <debond/base/infinity.h>
#include <debond/base/instantiate.h>
#include <debond/base/text.h>
#include <debond/base/tolerances.h>
#include <debond/elasticity/contact_frame.h>
#include <debond/elasticity/mortar.h>
#include <debond/mesh/field_value.h>

namespace Debond
{
  namespace
  {
    /// The overlaps of two sides that are near each other, or as far apart as
    /// it takes to cover the first one.
    template <int dim>
    std::vector<Overlap<dim>>
    covering_overlaps(const std::vector<Facet<dim>> &first,
                      const std::vector<Facet<dim>> &second)
    {
      std::vector<dealii::Point<dim>> corners;
      double                          smallest = infinity;
      for (const auto *side : {&first, &second})
        for (const Facet<dim> &facet : *side)
          {
            corners.insert(corners.end(),
                           facet.corners.begin(),
                           facet.corners.end());
            smallest =
              std::min(smallest, facet.corners[0].distance(facet.corners[1]));
          }
      const auto ends = dealii::BoundingBox<dim>(corners).get_boundary_points();
      const double extent = ends.first.distance(ends.second);
      // Few pairs are looked at as long as the sides are near.
      for (double reach = Tolerance::touching;; reach *= 8.)
        {
          const auto overlaps = find_overlaps(first, second, reach);
          const auto parts    = covered_parts(first, overlaps);
          if (*std::min_element(parts.begin(), parts.end()) >=
                Tolerance::covered ||
              reach * smallest > extent)
            return overlaps;
        }
    }
  } // namespace



  template <int dim>
  MortarInterface<dim>::MortarInterface(
    const std::string                    &name,
    const std::vector<BoundaryFace<dim>> &high,
    const std::vector<BoundaryFace<dim>> &low,
    const NodeSupports<dim>              &supports,
    const BoundaryConditions             &conditions)
  {
    const std::vector<Facet<dim>> first  = facets_of(high),
                                  second = facets_of(low);
    const auto overlaps                  = covering_overlaps(first, second);
    const auto parts                     = covered_parts(first, overlaps);
    touches                              = touch(first, second, overlaps);
    for (std::size_t f = 0; f < high.size(); ++f)
      {
        const std::string at =
          words(" at ", point_text(high[f].positions[0]), ": ");
        if (parts[f] < Tolerance::covered)
          throw EntryError("Mesh/Interfaces",
                           words("the second side of ",
                                 name,
                                 " is not across all of the first one",
                                 at,
                                 "exchange the sides, or name a part of the "
                                 "first one that the other covers"));
        if (parts[f] > 2. - Tolerance::covered)
          throw EntryError("Mesh/Interfaces",
                           words("two parts of the second side of ",
                                 name,
                                 " lie across the first one",
                                 at,
                                 "one of them has to be left out"));
      }
    find_nodes(high, supports, conditions);
    // The overlaps come in the order of the faces.
    auto begin = overlaps.begin();
    for (std::size_t f = 0; f < high.size(); ++f)
      {
        const auto end =
          std::find_if(begin, overlaps.end(), [f](const auto &overlap) {
            return overlap.first != f;
          });
        integrate(high[f], low, conditions.symmetry, begin, end);
        begin = end;
      }
    make_rows();
  }



  template <int dim>
  void
  MortarInterface<dim>::find_nodes(const std::vector<BoundaryFace<dim>> &high,
                                   const NodeSupports<dim>  &supports,
                                   const BoundaryConditions &conditions)
  {
    bool ties_tangents = false;
    for (const BoundaryFace<dim> &face : high)
      {
        ties_tangents = ties_tangents || conditions.fixes_tangential(face.id) ||
                        conditions.has_tangents(face.id);
        for (unsigned int n = 0; n < face.n_nodes; ++n)
          {
            Node &node    = nodes[face.indices[n]];
            node.position = face.positions[n];
            node.jump     = face.indices[n];
            node.normals.push_back(face.normal);
            node.measures.push_back(face.measure);
          }
      }
    std::set<unsigned int> held;
    for (auto &[index, node] : nodes)
      {
        const VertexNormals<dim> normals(node.normals, node.measures);
        if (normals.normals.size() > 1)
          throw EntryError(
            "Mesh/Interfaces",
            "the side of an interface whose nodes carry the jumps has a corner "
            "at " +
              point_text(node.position) +
              ": both sides of the corner are interfaces of their own");
        const auto rows = supports.at(index, node.position).rows;
        if (rows.empty())
          continue;
        std::vector<dealii::Tensor<1, dim>> directions = normals.normals;
        // Across the axis is the same face once more.
        if (supports.on_axis().count(index) > 0)
          {
            directions[0][0] = 0.;
            directions[0] /= directions[0].norm();
          }
        double along = 0.;
        for (const auto &row : rows)
          {
            along += std::pow(row.direction * directions[0], 2);
            directions.push_back(row.direction);
          }
        if (ties_tangents || along > most_inclined * most_inclined)
          {
            held.insert(index);
            continue;
          }
        // In the frame that the node will have only the first component is that
        // of the jump.
        const dealii::Tensor<2, dim> to_nodal =
          dealii::invert(contact_frame(directions));
        dealii::Tensor<1, dim> first;
        for (unsigned int d = 0; d < dim; ++d)
          first[d] = to_nodal[d][0];
        node.jumps = outer_product(first, directions[0]);
      }
    replace_held(held);
  }



  template <int dim>
  void
  MortarInterface<dim>::replace_held(const std::set<unsigned int> &held)
  {
    // Of nodes that are at the same distance but for rounding one is taken
    // whatever their numbers are, which differ between numbers of ranks.
    for (const unsigned int index : held)
      {
        Node  &node  = nodes.at(index);
        double least = infinity;
        for (const auto &[other, there] : nodes)
          if (held.count(other) == 0)
            {
              const double distance = node.position.distance(there.position);
              const double change =
                std::isfinite(least) ? (distance - least) / least : -1.;
              if (change < -Tolerance::same_place ||
                  (change < Tolerance::same_place &&
                   place_on_line(there.position) <
                     place_on_line(nodes.at(node.jump).position)))
                {
                  least     = distance;
                  node.jump = other;
                }
            }
        if (node.jump == index)
          throw EntryError(
            "Mesh/Interfaces",
            "supports hold the whole side of an interface whose nodes carry "
            "the jumps, as at " +
              point_text(node.position) + ": exchange its sides");
      }
  }



  template <int dim>
  void
  MortarInterface<dim>::integrate(const BoundaryFace<dim>              &face,
                                  const std::vector<BoundaryFace<dim>> &low,
                                  const Symmetry                    symmetry,
                                  typename Overlaps::const_iterator begin,
                                  typename Overlaps::const_iterator end)
  {
    const unsigned int n      = face.n_nodes;
    const unsigned int degree = n == dim ? 1 : 2;
    // The weight of a point of the piece, with the way around the axis.
    const auto weight_of = [&](const auto &point) {
      dealii::Point<dim> x;
      for (unsigned int v = 0; v < dim; ++v)
        x += point.on_first[v] * face.positions[v];
      return point.weight * circumference(symmetry, x);
    };
    // psi = diag(int phi) M^{-1} phi, M = int phi phi', over what is covered.
    dealii::FullMatrix<double> mass(n, n);
    std::vector<double>        integrals(n, 0.);
    for (auto overlap = begin; overlap != end; ++overlap)
      for (const auto &point : overlap->points)
        {
          const auto   phi    = bernstein(point.on_first, degree);
          const double weight = weight_of(point);
          for (unsigned int i = 0; i < n; ++i)
            {
              integrals[i] += weight * phi[i];
              for (unsigned int j = 0; j < n; ++j)
                mass(i, j) += weight * phi[i] * phi[j];
            }
        }
    mass.gauss_jordan();

    for (auto overlap = begin; overlap != end; ++overlap)
      for (const auto &point : overlap->points)
        {
          const BoundaryFace<dim> &across = low[overlap->second];
          const auto               phi    = bernstein(point.on_first, degree),
                     phi_low              = bernstein(point.on_second, degree);
          const double weight             = weight_of(point);
          for (unsigned int i = 0; i < n; ++i)
            {
              double psi = 0.;
              for (unsigned int j = 0; j < n; ++j)
                psi += integrals[i] * mass(i, j) * phi[j];
              const unsigned int index = nodes.at(face.indices[i]).jump;
              Node              &node  = nodes.at(index);
              node.weight += weight * psi;
              node.gap += weight * psi * point.distance;
              for (unsigned int j = 0; j < n; ++j)
                if (face.indices[j] == index)
                  node.diagonal += weight * psi * phi[j];
                else if (nodes.at(face.indices[j]).jump != face.indices[j])
                  node.of_held[face.indices[j]] += weight * psi * phi[j];
              for (unsigned int j = 0; j < n; ++j)
                node.of_low[across.indices[j]] += weight * psi * phi_low[j];
            }
        }
  }



  template <int dim>
  void
  MortarInterface<dim>::make_rows()
  {
    const dealii::Tensor<2, dim> identity =
      dealii::unit_symmetric_tensor<dim>();
    for (auto &[index, node] : nodes)
      {
        if (node.jump != index)
          continue;
        if (!(node.weight > 0. && node.diagonal > 0.))
          throw EntryError("Mesh/Interfaces",
                           "the faces of an interface are too distorted at " +
                             point_text(node.position));
        BasisRow<dim> row =
          BasisRow<dim>::scaled(index, node.weight / node.diagonal, {});
        for (const auto &[other, integral] : node.of_low)
          if (std::abs(integral) >
              Tolerance::zero_in_projection * node.diagonal)
            row.others.emplace_back(other, integral / node.diagonal);
        for (const auto &[other, integral] : node.of_held)
          if (std::abs(integral) >
              Tolerance::zero_in_projection * node.diagonal)
            row.others.emplace_back(other, -integral / node.diagonal);
        row.of_others   = node.jumps;
        row.to_nodal    = row.to_nodal * node.jumps + (identity - node.jumps);
        row.to_unknowns = dealii::invert(row.to_nodal);
        all_rows.push_back(row);
        node.gap = touches ? 0. : node.gap / node.weight;
      }
  }



  template <int dim>
  void
  MortarInterface<dim>::set_jumps(BoundaryFace<dim> &face) const
  {
    for (unsigned int n = 0; n < face.n_nodes; ++n)
      {
        const unsigned int index = face.indices[n];
        const Node        &node  = nodes.at(index);
        face.indices[n]          = node.jump;
        face.borrowed[n]         = node.jump != index;
        face.gaps[n]             = node.gap;
      }
  }



  DEBOND_INSTANTIATE_CLASS(MortarInterface);
} // namespace Debond
