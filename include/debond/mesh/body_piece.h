// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_body_piece_h
#define debond_mesh_body_piece_h

#include <debond/mesh/body.h>

#include <cstddef>
#include <map>
#include <memory>
#include <vector>

namespace Debond
{
  /**
   * The part of a body that one of several ranks has: its own slabs, and around
   * them cells that are those of others (ghosts). No rank has the whole mesh.
   * What is said of the body (its names, its size) is of the whole.
   *
   * A vertex belongs to the rank of its slab. It has the same number on all
   * ranks, that of the whole mesh on one rank: vertices in the order in which
   * the cells come to them. Cells and vertices of a piece are to the last bit
   * as in the whole mesh, cells in the same order.
   */
  template <int dim>
  class BodyPiece : public Body<dim>
  {
  public:
    std::set<std::string>
    whole_boundaries() const override
    {
      return whole->boundaries();
    }

    std::set<std::string>
    whole_regions() const override
    {
      return whole->regions();
    }

    double
    n_cells() const override
    {
      return whole->n_cells();
    }

    double
    n_vertices() const override
    {
      return whole->n_vertices();
    }

    BodyShape
    shape() const override
    {
      return whole->shape();
    }

    bool
    has_coarse_levels() const override
    {
      return whole->has_coarse_levels();
    }

    std::unique_ptr<Body<dim>>
    coarser_whole() const override
    {
      return whole->coarser();
    }

    std::vector<dealii::Tensor<1, dim>>
    interpolate(const dealii::Triangulation<dim>          &mesh,
                const std::vector<dealii::Tensor<1, dim>> &values,
                const std::vector<dealii::Point<dim>> &points) const override
    {
      return whole->interpolate(mesh, values, points);
    }

    /// Of the whole boundary, by ids.
    virtual std::map<dealii::types::boundary_id, unsigned int>
    n_faces() const = 0;

    unsigned int
    n_slabs() const
    {
      return n_of_slabs;
    }

    bool
    owns_slab(const unsigned int slab) const
    {
      return first <= slab && slab < end;
    }

    /// For each vertex of make_mesh() its number in the whole mesh.
    virtual std::vector<unsigned int>
    numbers(const dealii::Triangulation<dim> &mesh) const = 0;

    /// The number in the whole of what a cell of make_mesh() is a part of: a
    /// quadrilateral or hexahedron before it is crossed. Parts follow each
    /// other.
    virtual std::size_t
    cell_number(const unsigned int active_cell) const = 0;

    virtual bool
    owns_cell(const unsigned int active_cell) const = 0;

    /// How many levels, the finest one counted, have vertices for each rank; at
    /// least one, and not the coarsest.
    virtual unsigned int
    n_shared_levels() const = 0;

    /// What a rank has of a coarser mesh: vertices in its own slabs of the
    /// finest mesh, and of some cells around them.
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

    /// The first @p n coarser meshes, at most n_shared_levels(); interpolation
    /// is to the vertices of @p mesh in the order @p vertices, which is that of
    /// their numbers. To be called by all ranks.
    virtual std::vector<CoarsePiece>
    coarse_pieces(const dealii::Triangulation<dim> &mesh,
                  const std::vector<unsigned int>  &vertices,
                  const unsigned int                n) const = 0;

    /// The vertices of the whole @p n th coarser mesh and the coarser levels on
    /// it.
    struct CoarseWhole
    {
      std::vector<dealii::Point<dim>> vertices;
      std::vector<unsigned int>       slabs;
      std::vector<CoarseLevel<dim>>   coarser;
    };

    virtual CoarseWhole
    coarse_whole(const unsigned int n) const = 0;

  protected:
    /// The rank has the slabs [first, end).
    BodyPiece(const std::shared_ptr<const Body<dim>> &whole,
              const unsigned int                      n_slabs,
              const unsigned int                      rank,
              const unsigned int                      n_ranks);

    const unsigned int n_ranks;
    const unsigned int first, end;

  private:
    const std::shared_ptr<const Body<dim>> whole;
    const unsigned int                     n_of_slabs;
  };
} // namespace Debond

#endif
