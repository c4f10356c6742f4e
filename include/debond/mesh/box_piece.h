// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_box_piece_h
#define debond_mesh_box_piece_h

#include <debond/mesh/box.h>

#include <cstddef>
#include <vector>

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

    /// How many levels, the finest one counted, have vertices for each rank (a
    /// slab has two layers of them); at least one, and not the coarsest.
    unsigned int
    n_shared_levels() const;

    /// What a rank has of a coarser mesh: vertices in its own slabs of the
    /// finest mesh, and on each side those of two coarser cells, of five where
    /// the meshes are not nested along x.
    struct CoarsePiece
    {
      CoarseLevel<dim> level;

      /// In the whole coarser mesh, ascending.
      std::vector<unsigned int> numbers;

      /// Those in an own slab.
      std::vector<bool> is_own;

      /// Of the vertices of the whole coarser mesh.
      unsigned int n_whole;
    };

    /// The first @p n coarser meshes; @p vertices are those of the mesh.
    std::vector<CoarsePiece>
    coarse_pieces(const std::vector<dealii::Point<dim>> &vertices,
                  const unsigned int                     n) const;

    /// The vertices of the whole @p n th coarser mesh and the coarser levels on
    /// it.
    struct CoarseWhole
    {
      std::vector<dealii::Point<dim>> vertices;
      std::vector<unsigned int>       slabs;
      std::vector<CoarseLevel<dim>>   coarser;
    };

    CoarseWhole
    coarse_whole(const unsigned int n) const;

  private:
    const unsigned int n_ranks;
    unsigned int       first, end; ///< own slabs
  };
} // namespace Debond

#endif
