// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>
#include <deal.II/numerics/rtree.h>

#include <debond/mesh/body.h>
#include <debond/mesh/parts.h>

#include <algorithm>
#include <limits>

namespace Debond
{
  std::string
  boundary_name(const BoundaryNames &names, const dealii::types::boundary_id id)
  {
    auto narrowest = names.end();
    for (auto named = names.begin(); named != names.end(); ++named)
      if (named->second.count(id) > 0 &&
          (narrowest == names.end() ||
           named->second.size() < narrowest->second.size()))
        narrowest = named;
    return narrowest != names.end() ? narrowest->first :
                                      "boundary " + std::to_string(id);
  }



  template <int dim>
  std::set<std::string>
  Body<dim>::boundaries() const
  {
    std::set<std::string> names = whole_boundaries();
    for (const Part<dim> &part : parts)
      if (!part.boundary.empty())
        names.insert(part.name);
    return names;
  }



  template <int dim>
  std::set<std::string>
  Body<dim>::regions() const
  {
    std::set<std::string> names = whole_regions();
    for (const Part<dim> &part : parts)
      if (part.boundary.empty())
        names.insert(part.name);
    return names;
  }



  template <int dim>
  PieceNames
  Body<dim>::make_mesh(dealii::Triangulation<dim> &mesh) const
  {
    const PieceNames names = make_whole_mesh(mesh);
    return parts.empty() ? names : name_parts(parts, names, mesh);
  }



  template <int dim>
  std::unique_ptr<Body<dim>>
  Body<dim>::coarser() const
  {
    std::unique_ptr<Body> body = coarser_whole();
    if (!body || parts.empty())
      return body;
    body->parts = parts;
    try
      {
        dealii::Triangulation<dim> mesh;
        body->make_mesh(mesh);
      }
    catch (const PartError &)
      {
        return nullptr;
      }
    return body;
  }



  template <int dim>
  std::vector<dealii::Tensor<1, dim>>
  Body<dim>::interpolate(const dealii::Triangulation<dim>          &mesh,
                         const std::vector<dealii::Tensor<1, dim>> &values,
                         const std::vector<dealii::Point<dim>> &points) const
  {
    namespace index = boost::geometry::index;
    std::vector<typename dealii::Triangulation<dim>::active_cell_iterator>
                                          cells;
    std::vector<dealii::BoundingBox<dim>> boxes;
    for (const auto &cell : mesh.active_cell_iterators())
      {
        cells.push_back(cell);
        boxes.push_back(cell->bounding_box());
      }
    const auto tree = dealii::pack_rtree_of_indices(boxes);

    std::vector<dealii::Tensor<1, dim>> result;
    for (const dealii::Point<dim> &point : points)
      {
        std::vector<std::size_t> candidates;
        tree.query(index::intersects(point), std::back_inserter(candidates));
        if (candidates.empty())
          tree.query(index::nearest(point, 1), std::back_inserter(candidates));

        // The value of the cell that the point is farthest inside of.
        double                 farthest = -std::numeric_limits<double>::max();
        dealii::Tensor<1, dim> value;
        for (const std::size_t candidate : candidates)
          {
            const auto              &cell   = cells[candidate];
            const dealii::Point<dim> origin = cell->vertex(0);
            dealii::Tensor<2, dim>   edges; // as columns
            for (unsigned int d = 0; d < dim; ++d)
              for (unsigned int c = 0; c < dim; ++c)
                edges[c][d] = cell->vertex(d + 1)[c] - origin[c];
            const dealii::Tensor<1, dim> xi =
              dealii::invert(edges) * (point - origin);

            double                 first = 1., least = 1.;
            dealii::Tensor<1, dim> sum;
            for (unsigned int d = 0; d < dim; ++d)
              {
                first -= xi[d];
                least = std::min(least, xi[d]);
                sum += xi[d] * values[cell->vertex_index(d + 1)];
              }
            if (std::min(least, first) > farthest)
              {
                farthest = std::min(least, first);
                value    = sum + first * values[cell->vertex_index(0)];
              }
          }
        result.push_back(value);
      }
    return result;
  }



  template class Body<2>;
  template class Body<3>;
} // namespace Debond
