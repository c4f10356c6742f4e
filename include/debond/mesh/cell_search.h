// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_cell_search_h
#define debond_mesh_cell_search_h

#include <deal.II/base/bounding_box.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/grid/tria.h>
#include <deal.II/numerics/rtree.h>

#include <algorithm>
#include <array>
#include <vector>

namespace Debond
{
  /// The barycentric coordinates of a point in the simplex with these
  /// @p vertices.
  template <int dim>
  std::array<double, dim + 1>
  barycentric_coordinates(
    const std::array<dealii::Point<dim>, dim + 1> &vertices,
    const dealii::Point<dim>                      &point);



  /// Finds the cells of this rank, in a mesh of simplices, that points lie in
  /// or next to.
  template <int dim>
  class CellSearch
  {
  public:
    struct Place
    {
      typename dealii::Triangulation<dim>::active_cell_iterator cell;
      std::array<double, dim + 1> coordinates; ///< barycentric, of the point
      double depth; ///< the least of them, negative outside of the cell

      typename dealii::DoFHandler<dim>::active_cell_iterator
      cell_of(const dealii::DoFHandler<dim> &dofs) const
      {
        return {&dofs.get_triangulation(), cell->level(), cell->index(), &dofs};
      }

      /// In the reference cell.
      dealii::Point<dim>
      unit_point() const
      {
        dealii::Point<dim> point;
        std::copy(coordinates.begin() + 1,
                  coordinates.end(),
                  point.begin_raw());
        return point;
      }
    };

    explicit CellSearch(const dealii::Triangulation<dim> &mesh);

    /// The tree keeps a reference to the boxes.
    CellSearch(const CellSearch &) = delete;

    /// A cell that the point is inside of, or one that it is next to.
    Place
    operator()(const dealii::Point<dim> &point) const;

  private:
    std::vector<typename dealii::Triangulation<dim>::active_cell_iterator>
                                                cells;
    const std::vector<dealii::BoundingBox<dim>> boxes; ///< of the cells
    const decltype(dealii::pack_rtree_of_indices(
      std::vector<dealii::BoundingBox<dim>>())) tree;
  };
} // namespace Debond

#endif
