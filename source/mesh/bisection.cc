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
      // The ends of an edge in one number, the smaller one in the upper half:
      // both directions of the edge have the same key.
      return (std::uint64_t{std::min(a, b)} << 32) + std::max(a, b);
    }



    template <std::size_t n>
    bool
    has_middle(const std::array<unsigned int, n> &vertices,
               const EdgeMiddles                 &middles)
    {
      // A middle that has been made on any edge of a cell is a hanging node as
      // long as this cell is not cut there.
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
      // Maubach's rule, with the boundary ids of the faces opposite to the
      // vertices. A face of a child lies in the face of its parent that is
      // opposite to the same vertex, if both have that vertex. The face between
      // the children is inside, and the face opposite to z is the whole face of
      // the parent opposite to the vertex that the child has lost.
      const unsigned int k = cell.tag;
      const unsigned int last =
        static_cast<unsigned int>(cell.vertices.size()) - 1;
      std::array<Simplex, 2> children{{cell, cell}};
      if (cell.cuts_left > 0)
        children[0].cuts_left = children[1].cuts_left = cell.cuts_left - 1;

      // The first child has z in place of x_k. Its face opposite z is the whole
      // face opposite x_k and keeps that id at the same position; its face
      // opposite x_0 is the one between the children.
      children[0].vertices[k]   = middle;
      children[0].boundaries[0] = dealii::numbers::internal_face_boundary_id;

      // The second child begins with x_1, and z is at the position k. Therefore
      // x_k has moved to k - 1, whose opposite face is the one between the
      // children, and the face opposite z has the id of the face opposite x_0.
      for (unsigned int i = 0; i < k; ++i)
        {
          children[1].vertices[i]   = cell.vertices[i + 1];
          children[1].boundaries[i] = cell.boundaries[i + 1];
        }
      children[1].vertices[k]   = middle;
      children[1].boundaries[k] = cell.boundaries[0];
      children[1].boundaries[k - 1] =
        dealii::numbers::internal_face_boundary_id;

      // The tag counts down from dim to 1 over dim generations, and then the
      // cycle begins again.
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
        // deal.II numbers the faces of a triangle by their first vertex and
        // those of a tetrahedron in an order of its own. The expression is the
        // vertex opposite to the face f.
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f))
            simplex.boundaries[dim == 2 ? (f + 2) % 3 : 3 - f] =
              cell->face(f)->boundary_id();
        cells.push_back(simplex);
      }
    // Twins come first, since neighbours across a cut are found by them. Then
    // one of three ways gives the cells orders and tags that fit together. The
    // crossed mesh has them as it is; in 2D any choice of edges will do, and
    // the longest ones keep angles large.
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
    // Vertices at one place have equal coordinates to the last bit, since a cut
    // copies them. Sorting therefore brings them together, and the sort is
    // stable so that the least number stands for all of them. Meshes without a
    // cut do without the list.
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
    // A face is found from the sorted numbers of its vertices. It waits in the
    // map for its second cell, and is removed with that, so that the map
    // contains only the faces between what has been visited and what has not.
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
    // All cells have the tag 1, so that x_0 x_1 is the edge that is cut first.
    // A face contains it if the vertex opposite to the face is neither of its
    // ends, i >= 2. Stevenson's condition for neighbours is checked position by
    // position, and one violation is enough to try another order.
    for (const auto &[pair, opposite] : neighbours())
      {
        const auto x        = joined(cells[pair[0]].vertices);
        const auto y        = joined(cells[pair[1]].vertices);
        const auto [i, j]   = opposite;
        const bool has_edge = i >= 2;
        if (has_edge != (j >= 2))
          return false;
        // Neighbours whose common face has the refinement edge share it, in any
        // direction, and differ in the one vertex that is not on the face. At
        // other faces the children that meet there have to be such neighbours:
        // the vertex of the edge that is on the face is the same for both, and
        // so are the vertices from x_2 on.
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
    // The refinement edge of the tag 1 is x_0 x_1, so that the vertex opposite
    // to the longest edge becomes x_2. Its boundary id moves with it.
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
    // A simplex whose vertices are in the order of four colours has neighbours
    // that differ from it in one position only, which satisfies the condition
    // with the tag dim. The colouring is found by a walk from cell to
    // neighbour, breadth first, and takes one visit for each cell.
    std::vector<std::vector<std::array<unsigned int, 2>>> beyond(cells.size());
    for (const auto &[pair, opposite] : neighbours())
      {
        beyond[pair[0]].push_back({{pair[1], opposite[1]}});
        beyond[pair[1]].push_back({{pair[0], opposite[0]}});
      }

    // A neighbour shares all vertices but one with a cell that is coloured
    // already. The remaining vertex has no choice of colour, so that nothing
    // has to be tried and taken back.
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
            // The last entry of `used` belongs to vertices without a colour and
            // is no colour itself.
            const auto free = std::find(used.begin(), used.end() - 1, false);
            if (free == used.end() - 1)
              return false;
            *free = true;
            colours[v] = static_cast<unsigned int>(free - used.begin());
          }
      // A cell that has been reached on two ways may have one colour twice;
      // another one is missing then.
      return std::all_of(used.begin(), used.end() - 1, [](const bool u) {
        return u;
      });
    };
    // Bodies that are not connected through faces are coloured one after the
    // other.
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

    // Vertices and the ids of the faces opposite to them take the positions of
    // their colours.
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
    // Cells are cut in rounds over all of them, until none has cuts to do and
    // none has the middle of one of its edges as a hanging node. A cell may be
    // cut several times in the following rounds, since the edge with the middle
    // need not be its refinement edge. The rounds end by the compatibility of
    // the orders. Children stand at the place of their parent, so that the
    // order of cells, and with it all sums over them, follows from the input
    // alone.
    //
    // The middle of an edge remains in the map when all cells around that edge
    // are cut; no cell has that edge any more.
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
            goes_on = true;
            // The middle is the mean of the ends, also on a curved boundary, so
            // that the P1 space of the coarse mesh is contained in that of the
            // fine one. On a cut each side has a vertex of its own there, and
            // the first of them stands for both in `twins`.
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
        // deal.II asks for cells of positive volume. The last two vertices are
        // exchanged in the copy for deal.II alone: the order that bisection
        // needs stays in `cells`.
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
