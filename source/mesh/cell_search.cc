// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/base/tolerances.h>
#include <debond/mesh/cell_search.h>
#include <debond/mesh/owned_cells.h>

namespace Debond
{
  template <int dim>
  std::array<double, dim + 1>
  barycentric_coordinates(
    const std::array<dealii::Point<dim>, dim + 1> &vertices,
    const dealii::Point<dim>                      &point)
  {
    // With the edges from vertex 0 as columns of E, the point is x_0 + E xi.
    // The components of xi are the coordinates of the other vertices, and that
    // of vertex 0 is what remains to one.
    dealii::Tensor<2, dim> edges; // as columns
    for (unsigned int d = 0; d < dim; ++d)
      for (unsigned int c = 0; c < dim; ++c)
        edges[c][d] = vertices[d + 1][c] - vertices[0][c];
    const dealii::Tensor<1, dim> xi =
      dealii::invert(edges) * (point - vertices[0]);
    std::array<double, dim + 1> coordinates = {{1.}};
    for (unsigned int d = 0; d < dim; ++d)
      {
        coordinates[0] -= xi[d];
        coordinates[d + 1] = xi[d];
      }
    return coordinates;
  }



  namespace
  {
    /// Boxes around the cells, and around points that are beside them by
    /// rounding.
    template <int dim>
    std::vector<dealii::BoundingBox<dim>>
    boxes_of_cells(const dealii::Triangulation<dim> &mesh)
    {
      // A point on the side of a cell may be beside its box by rounding, as in
      // turned bodies. The boxes are enlarged by that, relative to the diameter
      // of the cell.
      std::vector<dealii::BoundingBox<dim>> boxes;
      for (const auto &cell : owned_cells(mesh))
        {
          boxes.push_back(cell->bounding_box());
          boxes.back().extend(Tolerance::point_in_body * cell->diameter());
        }
      return boxes;
    }
  } // namespace



  template <int dim>
  CellSearch<dim>::CellSearch(const dealii::Triangulation<dim> &mesh)
    : boxes(boxes_of_cells(mesh))
    // The tree contains numbers of boxes and keeps a reference to them: it is
    // initialised after them, and the object cannot be copied.
    , tree(dealii::pack_rtree_of_indices(boxes))
  {
    for (const auto &cell : owned_cells(mesh))
      cells.push_back(cell);
  }



  template <int dim>
  typename CellSearch<dim>::Place
  CellSearch<dim>::operator()(const dealii::Point<dim> &point) const
  {
    // The depth of a point in a cell is its least barycentric coordinate:
    // negative outside, and the larger the farther from the sides. Of the cells
    // whose box contains the point the deepest one counts, and the search ends
    // at the first one that contains it up to rounding. That takes a time of
    // the order of log n.
    namespace index          = boost::geometry::index;
    constexpr double nowhere = -std::numeric_limits<double>::max();
    Place            best    = {{}, {}, nowhere};
    const auto       look_at = [&](const std::size_t candidate) {
      std::array<dealii::Point<dim>, dim + 1> vertices;
      for (unsigned int v = 0; v <= dim; ++v)
        vertices[v] = cells[candidate]->vertex(v);
      const auto   coordinates = barycentric_coordinates<dim>(vertices, point);
      const double depth =
        *std::min_element(coordinates.begin(), coordinates.end());
      if (depth > best.depth)
        best = {cells[candidate], coordinates, depth};
    };
    // Any cell that the point is inside of will do.
    for (auto found = tree.qbegin(index::intersects(point));
         found != tree.qend() && best.depth < -Tolerance::same_cell;
         ++found)
      look_at(*found);
    // A point beside all boxes, on the curved side of a finer mesh for
    // instance, gets the cell whose box is nearest. Its coordinates there
    // extrapolate by little, and `depth` tells the caller how far outside it
    // is.
    if (best.depth == nowhere)
      for (auto found = tree.qbegin(index::nearest(point, 1));
           found != tree.qend();
           ++found)
        look_at(*found);
    return best;
  }



  DEBOND_INSTANTIATE(barycentric_coordinates);
  DEBOND_INSTANTIATE_CLASS(CellSearch);
} // namespace Debond
