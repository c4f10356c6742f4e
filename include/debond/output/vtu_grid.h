// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_vtu_grid_h
#define debond_output_vtu_grid_h

#include <deal.II/base/point.h>

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

namespace Debond
{
  /**
   * Cells of one kind with fields at their points and in the cells: what a file
   * of one of VTK's unstructured grids (VTU) holds. deal.II writes such files
   * too, but each cell with points of its own, and no fields in cells.
   */
  struct VtuGrid
  {
    /// The kinds of cells, with VTK's numbers.
    enum class CellType : std::uint8_t
    {
      line                  = 3,
      triangle              = 5,
      quadrilateral         = 9,
      tetrahedron           = 10,
      quadratic_triangle    = 22,
      quadratic_tetrahedron = 24
    };

    struct Field
    {
      std::string        name;
      unsigned int       n_components = 1; ///< or, of a vector, 3
      std::vector<float> numbers      = {};

      /// Appends a vector, in 2D with a third component, which VTK wants.
      template <int dim>
      void
      add(const dealii::Tensor<1, dim> &vector)
      {
        for (unsigned int d = 0; d < 3; ++d)
          numbers.push_back(d < dim ? static_cast<float>(vector[d]) : 0.F);
      }
    };

    CellType                  type;
    unsigned int              points_of_cell;
    Field                     points    = {"Points", 3};
    std::vector<std::int32_t> cells     = {}; ///< their points, in VTK's order
    std::vector<Field>        at_points = {}, in_cells = {};

    /// Appends a point and returns its number.
    template <int dim>
    std::int32_t
    add_point(const dealii::Point<dim> &position)
    {
      points.add(position);
      return static_cast<std::int32_t>(points.numbers.size() / 3 - 1);
    }
  };



  /// Writes the numbers behind the description ("appended raw" data),
  /// compressed by zlib. Equal grids give equal files.
  void
  write_vtu(const VtuGrid &grid, std::ostream &out);

  /// The file (PVTU) that joins @p pieces with the fields of @p grid.
  void
  write_pvtu(const VtuGrid                  &grid,
             const std::vector<std::string> &pieces,
             std::ostream                   &out);
} // namespace Debond

#endif
