// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_crossed_mesh_h
#define debond_mesh_crossed_mesh_h

#include <deal.II/grid/tria.h>

#include <vector>

namespace Debond
{
  /**
   * The crossed subdivision. In 2D each quadrilateral is cut along both
   * diagonals into 4 triangles that meet in its centre (paper's Fig. 3), in
   * 3D each hexahedron into 24 tetrahedra spanned by its centre, the centre of
   * a face and an edge of that face. Centres are means of the corners.
   *
   * The material ids of cells and the boundary ids of faces are kept, manifolds
   * are not: a curved boundary is sampled at the vertices, and all faces are
   * flat.
   *
   * @p coarse must be a mesh of quadrilaterals (hexahedra) without hanging
   * nodes, all active cells on one level, and each cell's centre must see all
   * of its faces; @p crossed must be empty. Throws std::invalid_argument
   * otherwise.
   */
  template <int dim>
  void
  crossed_subdivision(const dealii::Triangulation<dim> &coarse,
                      dealii::Triangulation<dim>       &crossed);

  /// The arguments of dealii::Triangulation::create_triangulation().
  template <int dim>
  struct CellsAndVertices
  {
    std::vector<dealii::Point<dim>>    vertices;
    std::vector<dealii::CellData<dim>> cells;
    dealii::SubCellData                faces;
  };

  /// Returns some cells of a crossed mesh, in this order: simplices and
  /// vertices are to the last bit and in the order in which the whole has them,
  /// but for those that are not there. The 4 (24) simplices of a coarse cell
  /// follow each other, face by face, and have their vertices on that face
  /// first. Faces inside of the body at which the cells end get the id @p
  /// id_of_cuts.
  template <int dim>
  CellsAndVertices<dim>
  crossed_cells(
    const std::vector<typename dealii::Triangulation<dim>::cell_iterator>
                                    &coarse_cells,
    const dealii::types::boundary_id id_of_cuts);
} // namespace Debond

#endif
