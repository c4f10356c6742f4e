// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>
#include <deal.II/numerics/rtree.h>

#include <debond/mesh/simplex_interpolation.h>

#include <algorithm>
#include <limits>

namespace Debond
{
  template <int dim>
  std::vector<dealii::Tensor<1, dim>>
  interpolate_on_simplices(const dealii::Triangulation<dim>          &mesh,
                           const std::vector<dealii::Tensor<1, dim>> &values,
                           const std::vector<dealii::Point<dim>>     &points)
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



  template decltype(interpolate_on_simplices<2>) interpolate_on_simplices<2>;
  template decltype(interpolate_on_simplices<3>) interpolate_on_simplices<3>;
} // namespace Debond
