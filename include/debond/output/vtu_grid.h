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
   * Cells of one kind that share points, with fields at the points and in the
   * cells: what one file of VTK's unstructured grids (VTU) holds. deal.II
   * writes such files too, but each cell with points of its own, and no fields
   * in cells.
   */
  struct VtuGrid
  {
    /// With VTK's numbers.
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
      unsigned int       n_components; ///< 1 or, of a vector, 3
      std::vector<float> numbers;      ///< n_components after each other
    };

    CellType                   type;
    std::vector<float>         points; ///< three for each
    std::vector<std::uint32_t> cells;  ///< the points of each, in VTK's order
    std::vector<Field>         at_points;
    std::vector<Field>         in_cells;

    /// Returns its number.
    template <int dim>
    std::uint32_t
    add_point(const dealii::Point<dim> &position)
    {
      for (unsigned int d = 0; d < 3; ++d)
        points.push_back(d < dim ? static_cast<float>(position[d]) : 0.F);
      return static_cast<std::uint32_t>(points.size() / 3 - 1);
    }
  };



  unsigned int
  n_points(const VtuGrid::CellType type);

  /// In binary, compressed by zlib, behind the description ("appended raw"
  /// data). Throws std::runtime_error if zlib cannot compress it.
  void
  write_vtu(const VtuGrid &grid, std::ostream &out);

  /// The file (PVTU) that joins those of the @p pieces, which have the fields
  /// of @p grid.
  void
  write_pvtu(const VtuGrid                  &grid,
             const std::vector<std::string> &pieces,
             std::ostream                   &out);
} // namespace Debond

#endif
