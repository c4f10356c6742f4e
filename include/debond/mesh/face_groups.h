// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_face_groups_h
#define debond_mesh_face_groups_h

#include <debond/mesh/body.h>

#include <array>
#include <vector>

namespace Debond
{
  /// A face through which a cut goes, between two cells, or two outer faces at
  /// one place.
  template <int dim>
  struct CutFace
  {
    using Cell = typename dealii::Triangulation<dim>::active_cell_iterator;

    unsigned int        index; ///< in the mesh, of one of the outer ones
    std::array<Cell, 2> cells; ///< on the low side, on the high one

    /// Of the face as each of them has it, in the same order.
    std::array<std::vector<unsigned int>, 2> vertices;

    /// The boundary id of the outer faces, or internal_face_boundary_id.
    dealii::types::boundary_id before =
      dealii::numbers::internal_face_boundary_id;

    unsigned int cut = 0; ///< its number

    bool
    is_inner() const
    {
      return before == dealii::numbers::internal_face_boundary_id;
    }
  };

  /**
   * The faces of the group that @p cut is along, in a @p mesh of simplices.
   * From face to face across what they share, they are turned alike. The high
   * side is that to which their normals point on the whole, by the largest
   * coordinate of the body before it was turned; if there is none, as for the
   * surface of a body inside, the outside. Several pieces are turned each for
   * itself.
   *
   * Throws std::invalid_argument if there are none, if they branch or have one
   * side only, and if there are outer ones without another at the same place.
   */
  template <int dim>
  std::vector<CutFace<dim>>
  faces_of_group(const Cut<dim>                   &cut,
                 const PieceNames                 &names,
                 const dealii::Triangulation<dim> &mesh);
} // namespace Debond

#endif
