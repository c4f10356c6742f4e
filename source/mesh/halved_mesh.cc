// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/mesh/crossed_lattice.h>
#include <debond/mesh/crossed_mesh.h>
#include <debond/mesh/halved_mesh.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>
#include <string>

namespace Debond
{
  namespace
  {
    constexpr unsigned int unset = dealii::numbers::invalid_unsigned_int;

    /// So that shares of a few ranks differ by some percent.
    constexpr std::size_t fewest_units = 512;

    /// Sums have a number for each.
    constexpr std::size_t most_slabs = 4096;

    /// Around own cells. A vertex of a coarser level depends on vertices in
    /// cells up to two away, and frames of the finest level's are made of all
    /// faces around; coarser frames come from their owners.
    constexpr unsigned int n_ghosts = 2, n_finest_ghosts = 3;

    /// The cells of the next finer level up to four away, which are more than
    /// those with the ghosts' neighbours.
    constexpr unsigned int n_halved_ghosts = 2;



    /// What a cell has of vertices of the crossed mesh: its corners, in 3D the
    /// centres of its faces, and its centre, in this order.
    template <int dim>
    struct CrossedCell
    {
      static constexpr unsigned int n_corners   = 1 << dim;
      static constexpr unsigned int n_centres   = dim == 3 ? 2 * dim : 0;
      static constexpr unsigned int size        = n_corners + n_centres + 1;
      static constexpr unsigned int n_simplices = dim == 2 ? 4 : 24;

      /// In units of half the cell.
      using Coordinates = std::array<unsigned int, dim>;

      static Coordinates
      coordinates(const unsigned int vertex)
      {
        Coordinates result;
        for (unsigned int d = 0; d < dim; ++d)
          result[d] = vertex < n_corners ? 2 * (vertex >> d & 1) : 1;
        if (vertex >= n_corners && vertex + 1 < size)
          result[(vertex - n_corners) / 2] = 2 * ((vertex - n_corners) % 2);
        return result;
      }

      static unsigned int
      vertex_at(const Coordinates &at)
      {
        unsigned int result = 0;
        while (coordinates(result) != at)
          ++result;
        return result;
      }

      CrossedCell()
      {
        BoxParameters one;
        one.lengths = {{1., 1., 1.}};
        one.cells   = {{1, 1, 1}};
        dealii::Triangulation<dim> mesh;
        make_box(one, mesh);
        const CrossedLattice<dim> lattice(one);
        unsigned int              simplex = 0;
        for (const auto &cell : mesh.active_cell_iterators())
          {
            for (const unsigned int v : cell->vertex_indices())
              {
                const unsigned int vertex =
                  vertex_at(lattice.coordinates(cell->vertex(v)));
                if (std::find(order.begin(), order.end(), vertex) !=
                    order.end())
                  continue;
                order.push_back(vertex);
                corners.push_back({{simplex, v}});
              }
            ++simplex;
          }

        one.lengths = {{2., 2., 2.}};
        const CrossedLattice<dim> parent(one);
        for (unsigned int child = 0; child < n_corners; ++child)
          for (unsigned int vertex = 0; vertex < size; ++vertex)
            {
              const Coordinates  offset = coordinates(vertex);
              dealii::Point<dim> point;
              for (unsigned int d = 0; d < dim; ++d)
                point[d] = (child >> d & 1) + 0.5 * offset[d];
              parent.visit_weights(
                point, [&](const std::size_t i, const double weight) {
                  if (weight > 0.)
                    weights[child][vertex].emplace_back(
                      vertex_at(parent.coordinates(parent.point(i))),
                      static_cast<float>(weight));
                });
            }
      }

      /// The vertices in the order in which the simplices come to them, and
      /// where: at which corner of which simplex.
      std::vector<unsigned int>                order;
      std::vector<std::array<unsigned int, 2>> corners;

      /// For each vertex of each child the vertices that it depends on.
      using Weights = std::vector<std::pair<unsigned int, float>>;
      std::array<std::array<Weights, size>, n_corners> weights;
    };



    template <int dim>
    const CrossedCell<dim> &
    crossed_cell()
    {
      static const CrossedCell<dim> cell;
      return cell;
    }



    /// Where a list of the cell's kind of vertices has one of them.
    template <typename Cell, typename Vertices>
    auto &
    entry(const Cell &cell, const unsigned int vertex, Vertices &vertices)
    {
      constexpr int dim = Cell::AccessorType::dimension;
      using Pattern     = CrossedCell<dim>;
      if (vertex < Pattern::n_corners)
        return vertices.of_vertices[cell->vertex_index(vertex)];
      if (vertex + 1 < Pattern::size)
        return vertices.of_faces[cell->face_index(vertex - Pattern::n_corners)];
      return vertices.of_cells[cell->index()];
    }
  } // namespace



  template <int dim>
  unsigned int
  HalvedMesh<dim>::level_of_units(const std::size_t  n_coarse,
                                  const unsigned int n_refinements)
  {
    unsigned int level = 0;
    for (std::size_t n = n_coarse; n < fewest_units && level < n_refinements;
         n <<= dim)
      ++level;
    return level;
  }



  template <int dim>
  HalvedMesh<dim>::HalvedMesh(std::unique_ptr<SourceMesh<dim>> source_mesh,
                              const unsigned int               level_of_units,
                              const unsigned int               finest,
                              const unsigned int               rank,
                              const unsigned int               n_of_ranks)
    : source(std::move(source_mesh))
    , unit_level(level_of_units)
    , finest_level(finest)
    , n_ranks(n_of_ranks)
  {
    dealii::Triangulation<dim> &mesh = source->mesh;
    base                             = mesh.n_levels() - 1 - unit_level;
    if (n_ranks == 1)
      mesh.refine_global(finest - unit_level);
    list_cells();

    const std::vector<Cell>        &units = existing[unit_level];
    std::vector<dealii::Point<dim>> centres;
    for (const Cell &unit : units)
      centres.push_back(unit.cell->center());
    const auto curve =
      dealii::Utilities::inverse_Hilbert_space_filling_curve<dim>(centres);
    std::vector<unsigned int> order(units.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(),
                     order.end(),
                     [&curve](const unsigned int a, const unsigned int b) {
                       return curve[a] < curve[b];
                     });
    n_of_slabs = static_cast<unsigned int>(std::min(units.size(), most_slabs));
    slabs_of_units.resize(units.size());
    for (std::size_t k = 0; k < order.size(); ++k)
      slabs_of_units[order[k]] =
        static_cast<unsigned int>(k * n_of_slabs / units.size());
    if (n_ranks > n_of_slabs)
      throw std::invalid_argument(
        "a mesh of " + std::to_string(units.size()) +
        " quadrilaterals or hexahedra can be cut for at most as many ranks, "
        "not " +
        std::to_string(n_ranks));
    first = static_cast<unsigned int>(std::size_t(n_of_slabs) * rank / n_ranks);
    end =
      static_cast<unsigned int>(std::size_t(n_of_slabs) * (rank + 1) / n_ranks);
    list_cells();

    if (n_ranks > 1)
      for (unsigned int level = unit_level; level < finest_level; ++level)
        {
          const std::vector<bool> is_near = around_own(level, n_halved_ghosts);
          for (std::size_t k = 0; k < existing[level].size(); ++k)
            if (is_near[k] && existing[level][k].cell->is_active())
              existing[level][k].cell->set_refine_flag();
          mesh.execute_coarsening_and_refinement();
          list_cells();
        }
  }



  template <int dim>
  void
  HalvedMesh<dim>::list_cells()
  {
    existing.assign(finest_level + 1, {});
    std::size_t n_coarse = 0;
    const auto  add      = [&](const auto         &self,
                         const CellIterator &cell,
                         const std::size_t   number,
                         const unsigned int  unit) -> void {
      const unsigned int level = cell->level() - base;
      const unsigned int own_unit =
        level == unit_level ? static_cast<unsigned int>(number) : unit;
      existing[level].push_back({cell,
                                 number,
                                 level < unit_level || slabs_of_units.empty() ?
                                         unset :
                                         slabs_of_units[own_unit]});
      for (unsigned int c = 0; c < cell->n_children(); ++c)
        self(self, cell->child(c), (number << dim) + c, own_unit);
    };
    const auto start = [&](const auto &self, const CellIterator &cell) -> void {
      if (static_cast<unsigned int>(cell->level()) == base)
        add(add, cell, n_coarse++, unset);
      else
        for (unsigned int c = 0; c < cell->n_children(); ++c)
          self(self, cell->child(c));
    };
    for (const auto &cell : source->mesh.cell_iterators_on_level(0))
      start(start, cell);
  }



  template <int dim>
  unsigned int
  HalvedMesh<dim>::n_units() const
  {
    return static_cast<unsigned int>(slabs_of_units.size());
  }



  template <int dim>
  unsigned int
  HalvedMesh<dim>::owner(const unsigned int slab) const
  {
    return static_cast<unsigned int>(((std::size_t(slab) + 1) * n_ranks - 1) /
                                     n_of_slabs);
  }



  template <int dim>
  std::vector<bool>
  HalvedMesh<dim>::around_own(const unsigned int level,
                              const unsigned int n_layers) const
  {
    const std::vector<Cell> &all = existing[level];
    std::vector<bool>        result(all.size());
    for (std::size_t k = 0; k < all.size(); ++k)
      result[k] = level < unit_level || is_own(all[k].slab);
    std::vector<bool> is_touched(source->mesh.n_vertices());
    for (unsigned int layer = 0; layer < n_layers && level >= unit_level;
         ++layer)
      {
        for (std::size_t k = 0; k < all.size(); ++k)
          if (result[k])
            for (const unsigned int v : all[k].cell->vertex_indices())
              is_touched[all[k].cell->vertex_index(v)] = true;
        for (std::size_t k = 0; k < all.size(); ++k)
          for (const unsigned int v : all[k].cell->vertex_indices())
            if (is_touched[all[k].cell->vertex_index(v)])
              result[k] = true;
      }
    return result;
  }



  template <int dim>
  std::vector<typename HalvedMesh<dim>::Cell>
  HalvedMesh<dim>::cells(const unsigned int level) const
  {
    const std::vector<bool> is_kept =
      around_own(level, level == finest_level ? n_finest_ghosts : n_ghosts);
    std::vector<Cell> result;
    for (std::size_t k = 0; k < is_kept.size(); ++k)
      if (is_kept[k])
        result.push_back(existing[level][k]);
    return result;
  }



  template <int dim>
  typename HalvedMesh<dim>::Vertices
  HalvedMesh<dim>::vertices(const unsigned int level) const
  {
    const CrossedCell<dim>           &pattern = crossed_cell<dim>();
    const dealii::Triangulation<dim> &mesh    = source->mesh;

    // The first of all cells around each vertex, more than are kept.
    struct First
    {
      std::size_t  key;
      std::size_t  unit;
      unsigned int slab;
    };
    std::vector<First> firsts;
    struct
    {
      std::vector<unsigned int> of_vertices, of_faces, of_cells;
    } number;
    Vertices result;
    for (auto *lists : {&number.of_vertices, &result.of_vertices})
      lists->assign(mesh.n_vertices(), unset);
    for (auto *lists : {&number.of_faces, &result.of_faces})
      lists->assign(dim == 3 ? mesh.n_raw_faces() : 0, unset);
    for (auto *lists : {&number.of_cells, &result.of_cells})
      lists->assign(mesh.n_raw_cells(base + level), unset);
    for (const Cell &cell : existing[level])
      for (unsigned int p = 0; p < CrossedCell<dim>::size; ++p)
        {
          unsigned int &place = entry(cell.cell, pattern.order[p], number);
          if (place != unset)
            continue;
          place = static_cast<unsigned int>(firsts.size());
          firsts.push_back({cell.number * CrossedCell<dim>::size + p,
                            level >= unit_level ?
                              cell.number >> dim * (level - unit_level) :
                              0,
                            cell.slab});
        }

    // Vertices of levels above the units belong to the unit that comes first.
    if (level < unit_level)
      {
        std::vector<unsigned int> unit_at(mesh.n_vertices(), unset);
        for (const Cell &unit : existing[unit_level])
          for (const unsigned int v : unit.cell->vertex_indices())
            {
              unsigned int &at = unit_at[unit.cell->vertex_index(v)];
              at = std::min(at, static_cast<unsigned int>(unit.number));
            }
        const auto set = [&](const unsigned int place, const unsigned int v) {
          firsts[place].unit = unit_at[v];
          firsts[place].slab = slabs_of_units[unit_at[v]];
        };
        for (const Cell &cell : existing[level])
          for (unsigned int n = 0; n < CrossedCell<dim>::size; ++n)
            {
              // The child next to it, and the corner of that child.
              const auto   at    = CrossedCell<dim>::coordinates(n);
              unsigned int child = 0, corner = 0;
              for (unsigned int d = 0; d < dim; ++d)
                {
                  child |= (at[d] == 2 ? 1u : 0u) << d;
                  corner |= (at[d] > 0 ? 1u : 0u) << d;
                }
              set(entry(cell.cell, n, number),
                  cell.cell->child(child)->vertex_index(corner));
            }
      }

    const std::vector<Cell> kept = cells(level);
    struct Kept
    {
      std::size_t        key;
      unsigned int      *place;
      dealii::Point<dim> point;
      const First       *first;
    };
    std::vector<Kept> found;
    for (const Cell &cell : kept)
      for (unsigned int n = 0; n < CrossedCell<dim>::size; ++n)
        {
          unsigned int &place = entry(cell.cell, n, result);
          if (place != unset)
            continue;
          place              = 0;
          const First &first = firsts[entry(cell.cell, n, number)];
          found.push_back(
            {first.key,
             &place,
             n < CrossedCell<dim>::n_corners ?
               cell.cell->vertex(n) :
             n + 1 < CrossedCell<dim>::size ?
               cell.cell->face(n - CrossedCell<dim>::n_corners)->center() :
               cell.cell->center(),
             &first});
        }
    std::sort(found.begin(), found.end(), [](const Kept &a, const Kept &b) {
      return a.key < b.key;
    });
    for (const Kept &vertex : found)
      {
        *vertex.place = static_cast<unsigned int>(result.keys.size());
        result.keys.push_back(vertex.key);
        result.units.push_back(static_cast<unsigned int>(vertex.first->unit));
        result.slabs.push_back(vertex.first->slab);
        result.points.push_back(vertex.point);
      }
    return result;
  }



  template <int dim>
  Interpolation
  HalvedMesh<dim>::interpolation(const unsigned int level,
                                 const Vertices    &coarse,
                                 const Vertices    &fine) const
  {
    // A vertex inside of a coarser cell is between three others at most.
    struct Row
    {
      unsigned int                                  size = 0;
      std::array<std::pair<unsigned int, float>, 3> entries;
    };
    std::vector<Row> rows(fine.keys.size());
    for (const Cell &cell : cells(level + 1))
      {
        const CellIterator parent = cell.cell->parent();
        const unsigned int child =
          static_cast<unsigned int>(cell.number & ((1u << dim) - 1));
        for (unsigned int n = 0; n < CrossedCell<dim>::size; ++n)
          {
            Row &row = rows[entry(cell.cell, n, fine)];
            if (row.size > 0)
              continue;
            for (const auto &[vertex, weight] :
                 crossed_cell<dim>().weights[child][n])
              row.entries.at(row.size++) = {entry(parent, vertex, coarse),
                                            weight};
            std::sort(row.entries.begin(), row.entries.begin() + row.size);
          }
      }
    Interpolation result;
    result.n_nodes = static_cast<unsigned int>(coarse.keys.size());
    for (const Row &row : rows)
      {
        for (unsigned int k = 0; k < row.size; ++k)
          {
            result.nodes.push_back(row.entries[k].first);
            result.weights.push_back(row.entries[k].second);
          }
        result.starts.push_back(result.nodes.size());
      }
    return result;
  }



  template <int dim>
  void
  HalvedMesh<dim>::Vertices::renumber(const std::vector<unsigned int> &numbers)
  {
    for (auto *list : {&of_vertices, &of_faces, &of_cells})
      for (unsigned int &place : *list)
        if (place != unset)
          place = numbers[place];
  }



  template <int dim>
  std::vector<CoarseLevel<dim>>
  HalvedMesh<dim>::coarse_levels(const unsigned int level,
                                 const Vertices    &fine,
                                 const unsigned int n) const
  {
    std::vector<CoarseLevel<dim>> result;
    const Vertices               *finer = &fine;
    Vertices                      last;
    for (unsigned int k = 1; k <= n; ++k)
      {
        Vertices coarse = vertices(level - k);
        result.push_back({coarse.points,
                          interpolation(level - k, coarse, *finer),
                          coarse.slabs});
        last  = std::move(coarse);
        finer = &last;
      }
    return result;
  }



  template <int dim>
  std::vector<unsigned int>
  HalvedMesh<dim>::places(const dealii::Triangulation<dim> &crossed,
                          const Vertices                   &finest) const
  {
    const CrossedCell<dim>   &pattern = crossed_cell<dim>();
    std::vector<unsigned int> result(crossed.n_vertices(), unset);
    unsigned int              simplex = 0;
    for (const Cell &cell : cells(finest_level))
      {
        for (unsigned int p = 0; p < CrossedCell<dim>::size; ++p)
          {
            const auto &[s, v] = pattern.corners[p];
            const CellIterator at(&crossed, 0, static_cast<int>(simplex + s));
            result[at->vertex_index(v)] =
              entry(cell.cell, pattern.order[p], finest);
          }
        simplex += CrossedCell<dim>::n_simplices;
      }
    return result;
  }



  template class HalvedMesh<2>;
  template class HalvedMesh<3>;
} // namespace Debond
