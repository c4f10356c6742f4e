// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_crossed_mesh_h
#define debond_mesh_crossed_mesh_h

#include <debond/mesh/mesh_data.h>

#include <array>
#include <map>

namespace Debond
{
  /// Cuts the cells of a mesh into simplices that are spanned by the centre of
  /// a cell and its faces, of which quadrilaterals are cut into triangles by
  /// their own centre. Centres are means of the corners, which are given as
  /// numbers of vertices in deal.II's order.
  template <int dim>
  class CellCrossing
  {
  public:
    using Corners = std::vector<unsigned int>;

    /// The centres are appended to the @p vertices.
    explicit CellCrossing(std::vector<dealii::Point<dim>> &vertices)
      : vertices(vertices)
    {}

    /// The simplices of a cell, face by face, with their vertices on that face
    /// first, or the cell itself if it is one. Those of a quadrilateral or
    /// hexahedron have a positive volume if its centre sees all of its faces.
    std::vector<Corners>
    simplices(const Corners &cell);

    /// The triangles that a quadrilateral is cut into, or the face itself.
    std::vector<Corners>
    parts(const Corners &face);

  private:
    unsigned int
    add_centre(const Corners &corners);

    std::vector<dealii::Point<dim>>                    &vertices;
    std::map<std::array<unsigned int, 4>, unsigned int> centres; ///< of faces
  };



  /**
   * The crossed subdivision. In 2D each quadrilateral is cut along both
   * diagonals into 4 triangles that meet in its centre (paper's Fig. 3), in
   * 3D each hexahedron into 24 tetrahedra spanned by its centre, the centre of
   * a face and an edge of that face.
   *
   * The material ids of cells, the boundary ids of faces and the manifold ids
   * of those inside are kept, manifolds are not: a curved boundary is sampled
   * at the vertices, and all faces are flat.
   *
   * @p coarse must be a mesh of quadrilaterals (hexahedra) without hanging
   * nodes, all active cells on one level, and each cell's centre must see all
   * of its faces. Throws std::invalid_argument otherwise.
   */
  template <int dim>
  MeshData<dim>
  crossed_subdivision(const dealii::Triangulation<dim> &coarse);
} // namespace Debond

#endif
