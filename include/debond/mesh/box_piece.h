// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_box_piece_h
#define debond_mesh_box_piece_h

#include <debond/mesh/box.h>

#include <cstddef>

namespace Debond
{
  /**
   * The part of a box that one of several ranks has: its own slabs (layers of
   * cells along x), and two slabs on each side that are those of others
   * (ghosts). No rank has the whole mesh. What is said of the body (its names,
   * its size) is of the whole box.
   *
   * A vertex belongs to the rank of its slab. It has the same number on all
   * ranks, that of the whole mesh on one rank: vertices in the order in which
   * the cells come to them.
   */
  template <int dim>
  class BoxPiece : public Box<dim>
  {
  public:
    /// Throws std::invalid_argument if there are more ranks than slabs, or the
    /// box is turned: coordinates of turned boxes are rounded.
    BoxPiece(const Box<dim>    &box,
             const unsigned int rank,
             const unsigned int n_ranks);

    /// That of the own slabs and ghosts, with cells and vertices to the last
    /// bit as in the whole mesh, in the same order. Faces between them and what
    /// is not there have an id without a name.
    PieceNames
    make_mesh(dealii::Triangulation<dim> &mesh) const override;

    /// The number of faces on a side of the whole box.
    unsigned int
    n_faces_on(const std::string &side) const;

    unsigned int
    n_slabs() const;

    /// Of vertices in the whole mesh.
    std::vector<unsigned int>
    numbers(const std::vector<dealii::Point<dim>> &vertices) const;

    /// Of the own slabs.
    unsigned int
    first_slab() const;

    unsigned int
    end_slab() const;

    /// The cell (of the box, not a simplex) in which a point lies, in the order
    /// of cells, and whether it is an own one.
    std::size_t
    cell_at(const dealii::Point<dim> &point) const;

    bool
    owns_cell_at(const dealii::Point<dim> &point) const;

    /// What a rank has of the first coarser mesh.
    struct CoarsePiece
    {
      /// On the vertices that are needed, in the order of their ids.
      CoarseLevel<dim> level;

      /// The same number on all ranks, in the order of the whole coarser mesh.
      std::vector<unsigned int> ids;

      /// Those in an own slab.
      std::vector<bool> is_own;
    };

    /// @p vertices are those of the mesh.
    CoarsePiece
    coarse_piece(const std::vector<dealii::Point<dim>> &vertices) const;

    /// The whole first coarser mesh, for one rank: the ids of its vertices and
    /// the coarser levels on it.
    struct CoarseWhole
    {
      std::vector<dealii::Point<dim>> vertices;
      std::vector<unsigned int>       ids;
      std::vector<CoarseLevel<dim>>   coarser;
    };

    CoarseWhole
    coarse_whole() const;

  private:
    unsigned int first, end; ///< own slabs
  };
} // namespace Debond

#endif
