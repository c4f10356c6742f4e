// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_halved_mesh_h
#define debond_mesh_halved_mesh_h

#include <debond/mesh/source_mesh.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace Debond
{
  /**
   * Quadrilaterals (hexahedra) that are halved in each direction again and
   * again, and the crossed meshes of all levels, which need not be made; or
   * what one of several ranks needs of them. Level 0 is what is halved first.
   *
   * The cells of the first level with some hundreds of them, the units, are on
   * all ranks. Along a space-filling curve they are put together to slabs, and
   * each rank has some slabs in a row. Of finer levels it has cells around its
   * own ones only.
   *
   * Cells of a level are in the order of the cells that they are parts of,
   * vertices of a crossed mesh in the order in which its cells come to them:
   * the order of a mesh that is halved as a whole.
   */
  template <int dim>
  class HalvedMesh
  {
  public:
    using CellIterator = typename dealii::Triangulation<dim>::cell_iterator;

    /// The level of the units of @p n_coarse cells that are halved @p
    /// n_refinements times.
    static unsigned int
    level_of_units(const std::size_t  n_coarse,
                   const unsigned int n_refinements);

    /// Takes a mesh that has been halved to the level of the units, and halves
    /// it to the level @p finest; a rank's part of it, if @p n_ranks > 1.
    /// Throws std::invalid_argument if the units cannot be shared out to so
    /// many ranks.
    HalvedMesh(std::unique_ptr<SourceMesh<dim>> source,
               const unsigned int               level_of_units,
               const unsigned int               finest,
               const unsigned int               rank    = 0,
               const unsigned int               n_ranks = 1);

    unsigned int
    n_units() const;

    unsigned int
    n_slabs() const
    {
      return n_of_slabs;
    }

    unsigned int
    slab_of_unit(const unsigned int unit) const
    {
      return slabs_of_units[unit];
    }

    /// The rank that has a slab.
    unsigned int
    owner(const unsigned int slab) const;

    /// Own cells and those around them, of each level.
    struct Cell
    {
      CellIterator cell;
      std::size_t  number; ///< in the whole level
      unsigned int slab;
    };

    std::vector<Cell>
    cells(const unsigned int level) const;

    /// The vertices of the crossed mesh of the cells().
    struct Vertices
    {
      /// By which they are ordered, in the whole as well.
      std::vector<std::size_t> keys;

      /// The first unit that has the vertex, and its slab.
      std::vector<unsigned int> units, slabs;

      std::vector<dealii::Point<dim>> points;

      /// Where vertices, face centres and centres of cells are in these lists.
      std::vector<unsigned int> of_vertices, of_faces, of_cells;

      /// For each vertex of the lists a new number: of what is here, only those
      /// lists change.
      void
      renumber(const std::vector<unsigned int> &numbers);
    };

    /// Levels coarser than the units are whole.
    Vertices
    vertices(const unsigned int level) const;

    /// The P1 fields of the crossed mesh of a level at the vertices of the next
    /// finer one.
    Interpolation
    interpolation(const unsigned int level,
                  const Vertices    &coarse,
                  const Vertices    &fine) const;

    /// The next @p n coarser levels of one with the vertices @p fine.
    std::vector<CoarseLevel<dim>>
    coarse_levels(const unsigned int level,
                  const Vertices    &fine,
                  const unsigned int n) const;

    /// For each vertex in the crossed mesh of the finest cells() its place
    /// among their vertices().
    std::vector<unsigned int>
    places(const dealii::Triangulation<dim> &crossed,
           const Vertices                   &finest) const;

  private:
    /// Makes the lists of existing cells.
    void
    list_cells();

    /// For each existing cell of a level whether it is at most so many cells
    /// away from an own one.
    std::vector<bool>
    around_own(const unsigned int level, const unsigned int n_layers) const;

    bool
    is_own(const unsigned int slab) const
    {
      return first <= slab && slab < end;
    }

    std::unique_ptr<SourceMesh<dim>> source;
    const unsigned int               unit_level, finest_level;
    unsigned int                     base = 0; ///< deal.II's level of level 0
    const unsigned int               n_ranks;
    unsigned int                     first = 0, end = 0; ///< own slabs
    std::vector<unsigned int>        slabs_of_units;
    unsigned int                     n_of_slabs = 0;

    /// All that exist, by level.
    std::vector<std::vector<Cell>> existing;
  };
} // namespace Debond

#endif
