// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_crossed_mesh_h
#define debond_mesh_crossed_mesh_h

#include <deal.II/grid/tria.h>

#include <array>
#include <map>
#include <string>

namespace Debond
{
  /**
   * The crossed subdivision. In 2D each quadrilateral is cut along both
   * diagonals into 4 triangles that meet in its centre (paper's Fig. 3), in
   * 3D each hexahedron into 24 tetrahedra spanned by its centre, the centre of
   * a face and an edge of that face. Centres are means of the corners.
   *
   * The material and manifold ids of cells and the boundary and manifold ids
   * of faces are kept; manifold objects are not, so that a curved boundary is
   * sampled at the vertices only. Inside of a coarse cell faces are flat.
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



  /// The body (0, L_1) x (0, L_2) [x (0, L_3)], turned about the origin.
  struct BoxParameters
  {
    std::array<double, 3>       lengths  = {{0.4, 0.04, 0.04}};
    std::array<unsigned int, 3> cells    = {{40, 4, 4}};
    double                      rotation = 0.; ///< degrees, in the x-y plane
  };

  /// The crossed mesh of a box with the boundary ids of boundary_names().
  /// Throws std::invalid_argument if a length is not positive or there are no
  /// cells in a direction.
  template <int dim>
  void
  make_box(const BoxParameters        &parameters,
           dealii::Triangulation<dim> &crossed);

  /**
   * The sides of the (unturned) box by name: left and right are the smallest
   * and largest x, bottom and top y, back and front z (3D only).
   */
  template <int dim>
  const std::map<std::string, dealii::types::boundary_id> &
  boundary_names();

  /// The name of a boundary for messages: "bottom", or "boundary 7" if that is
  /// not a side of the box.
  template <int dim>
  std::string
  boundary_name(const dealii::types::boundary_id id);
} // namespace Debond

#endif
