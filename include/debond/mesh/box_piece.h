// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_box_piece_h
#define debond_mesh_box_piece_h

#include <debond/mesh/body_piece.h>
#include <debond/mesh/box.h>

#include <array>

namespace Debond
{
  /// The part of a box that one of several ranks has: slabs are layers of cells
  /// along x, and two on each side are ghosts. Coarse pieces have two coarser
  /// cells on each side, five where the meshes are not nested along x.
  template <int dim>
  class BoxPiece : public BodyPiece<dim>
  {
  public:
    using typename BodyPiece<dim>::CoarsePiece;
    using typename BodyPiece<dim>::CoarseWhole;

    /// Throws std::invalid_argument if there are more ranks than slabs, or the
    /// box is turned: coordinates of turned boxes are rounded.
    BoxPiece(const std::shared_ptr<const Box<dim>> &box,
             const unsigned int                     rank,
             const unsigned int                     n_ranks);

    /// Faces between the piece and what is not there have an id without a name.
    PieceNames
    make_whole_mesh(dealii::Triangulation<dim> &mesh) const override;

    std::vector<unsigned int>
    slabs(const dealii::Triangulation<dim> &mesh) const override
    {
      return box->slabs(mesh);
    }

    std::map<dealii::types::boundary_id, unsigned int>
    n_faces() const override;

    std::vector<unsigned int>
    numbers(const dealii::Triangulation<dim> &mesh) const override;

    std::size_t
    cell_number(const unsigned int active_cell) const override
    {
      return place_and_number(active_cell)[1];
    }

    bool
    owns_cell(const unsigned int active_cell) const override;

    unsigned int
    n_shared_levels() const override;

    std::vector<CoarsePiece>
    coarse_pieces(const dealii::Triangulation<dim> &mesh,
                  const std::vector<unsigned int>  &vertices,
                  const unsigned int                n) const override;

    CoarseWhole
    coarse_whole(const unsigned int n) const override;

  private:
    /// Of the cells along x that the piece has.
    std::array<unsigned int, 2>
    range() const;

    /// The place of a cell along x, and its number.
    std::array<std::size_t, 2>
    place_and_number(const unsigned int active_cell) const;

    const std::shared_ptr<const Box<dim>> box;
  };
} // namespace Debond

#endif
