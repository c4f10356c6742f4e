// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/tensor.h>

#include <debond/base/instantiate.h>
#include <debond/mesh/bisection.h>
#include <debond/mesh/mesh_data.h>

#include <cstdint>
#include <map>
#include <numeric>
#include <queue>
#include <stdexcept>
#include <unordered_map>
#include <utility>

namespace Debond
{
  namespace
  {
    /// The vertices that were put in the middle of edges, by the edges' key().
    using EdgeMiddles = std::unordered_map<std::uint64_t, unsigned int>;

    std::uint64_t
    key(const unsigned int a, const unsigned int b)
    {
      return (std::uint64_t{std::min(a, b)} << 32) + std::max(a, b);
    }



    template <std::size_t n>
    bool
    has_middle(const std::array<unsigned int, n> &vertices,
               const EdgeMiddles                 &middles)
    {
      if (middles.empty())
        return false;
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = i + 1; j < n; ++j)
          if (middles.count(key(vertices[i], vertices[j])) > 0)
            return true;
      return false;
    }



    /// The vertices of the face opposite to the vertex @p v of a cell.
    template <std::size_t n>
    std::array<unsigned int, n - 1>
    without(const unsigned int v, const std::array<unsigned int, n> &vertices)
    {
      std::array<unsigned int, n - 1> face;
      std::copy_n(vertices.begin(), v, face.begin());
      std::copy(vertices.begin() + v + 1, vertices.end(), face.begin() + v);
      return face;
    }



    /// The children of a cell, @p middle being that of its refinement edge.
    template <typename Simplex>
    std::array<Simplex, 2>
    halves(const Simplex &cell, const unsigned int middle)
    {
      const unsigned int k = cell.tag;
      const unsigned int last =
        static_cast<unsigned int>(cell.vertices.size()) - 1;
      std::array<Simplex, 2> children{{cell, cell}};
      if (cell.cuts_left > 0)
        children[0].cuts_left = children[1].cuts_left = cell.cuts_left - 1;

      // The first one loses x_k; its face opposite x_0 is new.
      children[0].vertices[k]   = middle;
      children[0].boundaries[0] = dealii::numbers::internal_face_boundary_id;

      // The second one loses x_0; its face opposite x_k is new.
      for (unsigned int i = 0; i < k; ++i)
        {
          children[1].vertices[i]   = cell.vertices[i + 1];
          children[1].boundaries[i] = cell.boundaries[i + 1];
        }
      children[1].vertices[k]   = middle;
      children[1].boundaries[k] = cell.boundaries[0];
      children[1].boundaries[k - 1] =
        dealii::numbers::internal_face_boundary_id;

      children[0].tag = children[1].tag = k > 1 ? k - 1 : last;
      return children;
    }
  } // namespace



  template <int dim>
  Bisection<dim>::Bisection(const dealii::Triangulation<dim> &mesh)
    : points(mesh.get_vertices())
  {
    for (const auto &cell : mesh.active_cell_iterators())
      {
        Simplex simplex;
        simplex.tag      = 1;
        simplex.material = cell->material_id();
        simplex.boundaries.fill(dealii::numbers::internal_face_boundary_id);
        for (unsigned int v = 0; v <= dim; ++v)
          simplex.vertices[v] = cell->vertex_index(v);
        // deal.II's order of the faces.
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f))
            simplex.boundaries[dim == 2 ? (f + 2) % 3 : 3 - f] =
              cell->face(f)->boundary_id();
        cells.push_back(simplex);
      }
    find_twins();

    if (is_compatible_as_it_is())
      return;
    if (dim == 2)
      put_longest_edges_first();
    else if (!order_by_colours())
      throw std::invalid_argument(
        "the mesh cannot be refined locally: its tetrahedra are not those of "
        "crossed hexahedra, and its vertices cannot have four colours such that "
        "no two of a tetrahedron are alike. A smaller Mesh/Size, or Mesh/Degree "
        "= 2, is more accurate too");
  }



  template <int dim>
  void
  Bisection<dim>::find_twins()
  {
    std::vector<unsigned int> order(points.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto is_less = [this](const unsigned int a, const unsigned int b) {
      return std::lexicographical_compare(points[a].begin_raw(),
                                          points[a].end_raw(),
                                          points[b].begin_raw(),
                                          points[b].end_raw());
    };
    std::stable_sort(order.begin(), order.end(), is_less);
    twins.resize(points.size());
    bool has_twins = false;
    for (unsigned int k = 0; k < order.size(); ++k)
      {
        const bool is_twin = k > 0 && !is_less(order[k - 1], order[k]);
        twins[order[k]]    = is_twin ? twins[order[k - 1]] : order[k];
        has_twins          = has_twins || is_twin;
      }
    if (!has_twins)
      twins.clear();
  }



  template <int dim>
  std::vector<typename Bisection<dim>::Neighbours>
  Bisection<dim>::neighbours() const
  {
    std::map<std::array<unsigned int, dim>, std::array<unsigned int, 2>> open;
    std::vector<Neighbours>                                              result;
    for (unsigned int c = 0; c < cells.size(); ++c)
      for (unsigned int v = 0; v <= dim; ++v)
        {
          auto face = joined(without(v, cells[c].vertices));
          std::sort(face.begin(), face.end());
          const auto [entry, is_first] =
            open.emplace(face, std::array<unsigned int, 2>{{c, v}});
          if (!is_first)
            {
              result.push_back(
                {{{entry->second[0], c}}, {{entry->second[1], v}}});
              open.erase(entry);
            }
        }
    return result;
  }



  template <int dim>
  bool
  Bisection<dim>::is_compatible_as_it_is() const
  {
    for (const auto &[pair, opposite] : neighbours())
      {
        const auto x        = joined(cells[pair[0]].vertices);
        const auto y        = joined(cells[pair[1]].vertices);
        const auto [i, j]   = opposite;
        const bool has_edge = i >= 2;
        if (has_edge != (j >= 2))
          return false;
        // Neighbours at a face with the refinement edge share that edge and
        // differ in one place; at other faces their halves do.
        if (has_edge ?
              i != j || std::minmax(x[0], x[1]) != std::minmax(y[0], y[1]) :
              x[1 - i] != y[1 - j])
          return false;
        for (unsigned int v = 2; v <= dim; ++v)
          if (x[v] != y[v] && !(has_edge && v == i))
            return false;
      }
    return true;
  }



  template <int dim>
  void
  Bisection<dim>::put_longest_edges_first()
  {
    for (Simplex &cell : cells)
      {
        const auto length = [&](const unsigned int a, const unsigned int b) {
          return points[cell.vertices[a]].distance_square(
            points[cell.vertices[b]]);
        };
        unsigned int longest = dim; // by the vertex opposite to it
        for (unsigned int v = 0; v < dim; ++v)
          if (length((v + 1) % (dim + 1), (v + 2) % (dim + 1)) >
              length((longest + 1) % (dim + 1), (longest + 2) % (dim + 1)))
            longest = v;
        std::swap(cell.vertices[longest], cell.vertices[dim]);
        std::swap(cell.boundaries[longest], cell.boundaries[dim]);
      }
  }



  template <int dim>
  bool
  Bisection<dim>::order_by_colours()
  {
    std::vector<std::vector<std::array<unsigned int, 2>>> beyond(cells.size());
    for (const auto &[pair, opposite] : neighbours())
      {
        beyond[pair[0]].push_back({{pair[1], opposite[1]}});
        beyond[pair[1]].push_back({{pair[0], opposite[0]}});
      }

    // Three vertices have their colours from the neighbour: the fourth one has
    // no choice.
    constexpr unsigned int    none = dim + 1;
    std::vector<unsigned int> colours(points.size(), none);
    const auto                colour = [&](const unsigned int c) {
      std::array<bool, dim + 2> used     = {};
      const auto                vertices = joined(cells[c].vertices);
      for (const unsigned int v : vertices)
        used[colours[v]] = true;
      for (const unsigned int v : vertices)
        if (colours[v] == none)
          {
            const auto free = std::find(used.begin(), used.end() - 1, false);
            if (free == used.end() - 1)
              return false;
            *free = true;
            colours[v] = static_cast<unsigned int>(free - used.begin());
          }
      return std::all_of(used.begin(), used.end() - 1, [](const bool u) {
        return u;
      });
    };
    std::vector<bool> visited(cells.size(), false);
    for (unsigned int first = 0; first < cells.size(); ++first)
      {
        std::queue<unsigned int> todo;
        if (!visited[first])
          todo.push(first);
        visited[first] = true;
        for (; !todo.empty(); todo.pop())
          {
            if (!colour(todo.front()))
              return false;
            for (const auto &[c, unused] : beyond[todo.front()])
              if (!visited[c])
                {
                  visited[c] = true;
                  todo.push(c);
                }
          }
      }

    for (Simplex &cell : cells)
      {
        const Simplex before = cell;
        for (unsigned int v = 0; v <= dim; ++v)
          {
            const unsigned int place = colours[joined(before.vertices)[v]];
            cell.vertices[place]     = before.vertices[v];
            cell.boundaries[place]   = before.boundaries[v];
          }
        cell.tag = dim;
      }
    return true;
  }



  template <int dim>
  void
  Bisection<dim>::refine(const std::vector<unsigned int> &times)
  {
    AssertDimension(times.size(), cells.size());

    for (unsigned int c = 0; c < cells.size(); ++c)
      {
        cells[c].cuts_left = times[c];
        cells[c].whole     = c;
      }
    // The middle of an edge is a vertex only until all its cells are cut.
    EdgeMiddles middles;
    EdgeMiddles joined_middles; // of edges with joined() ends
    for (bool goes_on = true; goes_on;)
      {
        goes_on = false;
        std::vector<Simplex> next;
        next.reserve(cells.size());
        for (const Simplex &cell : cells)
          {
            if (cell.cuts_left == 0 &&
                !has_middle(joined(cell.vertices),
                            twins.empty() ? middles : joined_middles))
              {
                next.push_back(cell);
                continue;
              }
            goes_on              = true;
            const unsigned int a = cell.vertices[0];
            const unsigned int b = cell.vertices[cell.tag];
            const auto [middle, is_new] =
              middles.emplace(key(a, b),
                              static_cast<unsigned int>(points.size()));
            if (is_new)
              {
                points.push_back(points[a] + 0.5 * (points[b] - points[a]));
                if (!twins.empty())
                  twins.push_back(
                    joined_middles
                      .emplace(key(twins[a], twins[b]), middle->second)
                      .first->second);
              }
            for (const Simplex &half : halves(cell, middle->second))
              next.push_back(half);
          }
        cells = std::move(next);
      }
    whole_cells.clear();
    for (const Simplex &cell : cells)
      whole_cells.push_back(cell.whole);
  }



  template <int dim>
  void
  Bisection<dim>::make_mesh(dealii::Triangulation<dim> &mesh) const
  {
    MeshData<dim> data;
    data.vertices = points;
    data.cells.reserve(cells.size());
    for (const Simplex &cell : cells)
      {
        dealii::Tensor<2, dim> edges;
        for (unsigned int d = 0; d < dim; ++d)
          edges[d] = points[cell.vertices[d + 1]] - points[cell.vertices[0]];
        auto corners = cell.vertices;
        if (dealii::determinant(edges) < 0.)
          std::swap(corners[dim - 1], corners[dim]);
        data.add_cell(corners, cell.material);

        for (unsigned int v = 0; v <= dim; ++v)
          if (cell.boundaries[v] != dealii::numbers::internal_face_boundary_id)
            data.add_face(without(v, cell.vertices), cell.boundaries[v]);
      }
    data.make_mesh(mesh);
  }



  DEBOND_INSTANTIATE_CLASS(Bisection);
} // namespace Debond
