// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/mesh/box_piece.h>
#include <debond/mesh/crossed_lattice.h>
#include <debond/mesh/crossed_mesh.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace Debond
{
  namespace
  {
    /// On each side of the own slabs: a coarser vertex depends on vertices less
    /// than two cells away, whose rows in A need the cells around them.
    constexpr unsigned int n_ghost_slabs = 2;

    /// The same on a coarser mesh. Where cells of a level lie across those of
    /// the next coarser one, products P'AP couple vertices up to three cells
    /// away, as cells grow by a factor of at least 1.5.
    constexpr unsigned int n_coarse_ghosts = 2, n_ghosts_if_not_nested = 5;



    /// Numbers of the vertices of a crossed mesh in the order in which its
    /// cells, the first direction running fastest, come to them.
    template <int dim>
    class VertexNumbers
    {
    public:
      using Coordinates = typename CrossedLattice<dim>::Coordinates;

      explicit VertexNumbers(const std::array<unsigned int, 3> &cells)
        : n(cells)
      {
        BoxParameters one;
        one.lengths = {{1., 1., 1.}};
        one.cells   = {{1, 1, 1}};
        dealii::Triangulation<dim> mesh;
        make_box(one, mesh);
        const CrossedLattice<dim> lattice(one);
        for (const auto &cell : mesh.active_cell_iterators())
          for (const unsigned int v : cell->vertex_indices())
            {
              const Coordinates offset = lattice.coordinates(cell->vertex(v));
              if (std::find(pattern.begin(), pattern.end(), offset) ==
                  pattern.end())
                pattern.push_back(offset);
            }
        for (unsigned int at_begin = 0; at_begin < 1u << dim; ++at_begin)
          n_new[at_begin] = static_cast<unsigned int>(std::count_if(
            pattern.begin(), pattern.end(), [&](const Coordinates &offset) {
              return is_new(offset, at_begin);
            }));
      }

      unsigned int
      operator()(const Coordinates &lattice) const
      {
        // The first cell that comes to the vertex.
        unsigned int at_begin = 0, result = 0;
        Coordinates  offset;
        for (unsigned int d = dim; d-- > 0;)
          {
            const unsigned int cell =
              lattice[d] == 0 ? 0 : (lattice[d] - 1) / 2;
            offset[d] = lattice[d] - 2 * cell;
            if (cell > 0)
              result += n_new_in(d, at_begin | 1u << d) +
                        (cell - 1) * n_new_in(d, at_begin);
            else
              at_begin |= 1u << d;
          }
        for (const Coordinates &other : pattern)
          {
            if (other == offset)
              return result;
            result += is_new(other, at_begin);
          }
        throw std::logic_error("This is no vertex of a crossed mesh.");
      }

    private:
      /// Whether a cell is the first one to come to its vertex; it lies at the
      /// beginning of the directions whose bits are set.
      static bool
      is_new(const Coordinates &offset, const unsigned int at_begin)
      {
        for (unsigned int d = 0; d < dim; ++d)
          if (offset[d] == 0 && (at_begin & 1u << d) == 0)
            return false;
        return true;
      }

      /// Of all cells along the directions below @p d.
      unsigned int
      n_new_in(const unsigned int d, const unsigned int at_begin) const
      {
        return d == 0 ? n_new[at_begin] :
                        n_new_in(d - 1, at_begin | 1u << (d - 1)) +
                          (n[d - 1] - 1) * n_new_in(d - 1, at_begin);
      }

      const std::array<unsigned int, 3>   n;
      std::vector<Coordinates>            pattern; ///< of a cell
      std::array<unsigned int, 1u << dim> n_new;
    };



    /// The id of faces at which the piece ends and the box does not.
    template <int dim>
    constexpr dealii::types::boundary_id id_of_cuts = 2 * dim;
  } // namespace



  template <int dim>
  BoxPiece<dim>::BoxPiece(const std::shared_ptr<const Box<dim>> &box,
                          const unsigned int                     rank,
                          const unsigned int                     n_ranks)
    : BodyPiece<dim>(box, box->parameters.cells[0], rank, n_ranks)
    , box(box)
  {
    if (n_ranks > this->n_slabs())
      throw std::invalid_argument(
        "a box with " + std::to_string(this->n_slabs()) +
        " cells along x can be cut for at most as many ranks, not " +
        std::to_string(n_ranks));
    if (box->parameters.rotation != 0.)
      throw std::invalid_argument("a turned box cannot be cut for ranks");
  }



  template <int dim>
  std::array<unsigned int, 2>
  BoxPiece<dim>::range() const
  {
    return {{std::max(this->first, n_ghost_slabs) - n_ghost_slabs,
             std::min(this->end + n_ghost_slabs, this->n_slabs())}};
  }



  template <int dim>
  PieceNames
  BoxPiece<dim>::make_whole_mesh(dealii::Triangulation<dim> &mesh) const
  {
    const BoxParameters &whole             = box->parameters;
    const auto [begin, end]                = range();
    const unsigned int          first_cell = begin; // no binding in a lambda
    std::array<unsigned int, 3> n = whole.cells, n_vertices = {{1, 1, 1}};
    n[0] = end - begin;
    if (dim == 2)
      n[2] = 1;
    for (unsigned int d = 0; d < dim; ++d)
      n_vertices[d] = n[d] + 1;
    const auto for_each = [](const std::array<unsigned int, 3> &counts,
                             const auto                        &action) {
      for (unsigned int k = 0; k < counts[2]; ++k)
        for (unsigned int j = 0; j < counts[1]; ++j)
          for (unsigned int i = 0; i < counts[0]; ++i)
            action(std::array<unsigned int, 3>{{i, j, k}});
    };

    // As GridGenerator::subdivided_hyper_rectangle() does, to the last bit.
    std::vector<dealii::Point<dim>>    vertices;
    std::vector<dealii::CellData<dim>> cells;
    for_each(n_vertices, [&](const std::array<unsigned int, 3> &i) {
      dealii::Point<dim> point;
      for (unsigned int d = 0; d < dim; ++d)
        point[d] = (d == 0 ? first_cell + i[d] : i[d]) *
                   (whole.lengths[d] / whole.cells[d]);
      vertices.push_back(point);
    });
    for_each(n, [&](const std::array<unsigned int, 3> &i) {
      cells.emplace_back();
      for (unsigned int v = 0; v < 1u << dim; ++v)
        cells.back().vertices[v] =
          i[0] + (v & 1) +
          n_vertices[0] *
            (i[1] + (v >> 1 & 1) + n_vertices[1] * (i[2] + (v >> 2 & 1)));
    });
    dealii::Triangulation<dim> coarse;
    coarse.create_triangulation(vertices, cells, dealii::SubCellData());
    for (const auto &cell : coarse.active_cell_iterators())
      for (const unsigned int f : cell->face_indices())
        if (cell->face(f)->at_boundary())
          cell->face(f)->set_boundary_id((f == 0 && begin > 0) ||
                                             (f == 1 && end < whole.cells[0]) ?
                                           id_of_cuts<dim> :
                                           f);
    crossed_subdivision(coarse, mesh);
    return {box_boundaries<dim>(), {}};
  }



  template <int dim>
  std::map<dealii::types::boundary_id, unsigned int>
  BoxPiece<dim>::n_faces() const
  {
    std::map<dealii::types::boundary_id, unsigned int> result;
    for (const auto &[side, id] : box_sides<dim>())
      {
        unsigned int &n = result[id];
        n               = dim == 2 ? 1 : 4;
        for (unsigned int d = 0; d < dim; ++d)
          if (d != id / 2)
            n *= box->parameters.cells[d];
      }
    return result;
  }



  template <int dim>
  std::vector<unsigned int>
  BoxPiece<dim>::numbers(const dealii::Triangulation<dim> &mesh) const
  {
    const CrossedLattice<dim> lattice(box->parameters);
    const VertexNumbers<dim>  number(box->parameters.cells);
    std::vector<unsigned int> result;
    result.reserve(mesh.n_vertices());
    for (const dealii::Point<dim> &vertex : mesh.get_vertices())
      result.push_back(number(lattice.coordinates(vertex)));
    return result;
  }



  template <int dim>
  std::array<std::size_t, 2>
  BoxPiece<dim>::place_and_number(const unsigned int active_cell) const
  {
    const auto [begin, end]  = range();
    const unsigned int width = end - begin;
    const std::size_t  cell  = active_cell / (dim == 2 ? 4 : 24);
    const std::size_t  place = begin + cell % width;
    return {{place, cell / width * this->n_slabs() + place}};
  }



  template <int dim>
  bool
  BoxPiece<dim>::owns_cell(const unsigned int active_cell) const
  {
    return this->owns_slab(
      static_cast<unsigned int>(place_and_number(active_cell)[0]));
  }



  template <int dim>
  unsigned int
  BoxPiece<dim>::n_shared_levels() const
  {
    const std::vector<BoxParameters> boxes  = box->coarse_boxes();
    unsigned int                     result = 1;
    while (result < boxes.size() &&
           2 * boxes[result - 1].cells[0] >= this->n_ranks)
      ++result;
    return result;
  }



  template <int dim>
  std::vector<typename BoxPiece<dim>::CoarsePiece>
  BoxPiece<dim>::coarse_pieces(const dealii::Triangulation<dim> &mesh,
                               const std::vector<unsigned int>  &vertices,
                               const unsigned int                n) const
  {
    std::vector<dealii::Point<dim>> points;
    points.reserve(vertices.size());
    for (const unsigned int v : vertices)
      points.push_back(mesh.get_vertices()[v]);
    const std::vector<BoxParameters> boxes = box->coarse_boxes();
    std::vector<CoarsePiece>         result(n);
    std::size_t n_finer = this->n_slabs(), n_ghosts = n_coarse_ghosts;
    for (unsigned int l = 0; l < n; ++l)
      {
        // Of the lattice points along x, those in the cells of own slabs and
        // ghosts.
        const CrossedLattice<dim> lattice(boxes[l]);
        const std::size_t         n_cells = boxes[l].cells[0];
        if (n_finer != n_cells && n_finer != 2 * n_cells)
          n_ghosts = n_ghosts_if_not_nested;
        n_finer                      = n_cells;
        const std::size_t begin_cell = n_cells * this->first / this->n_slabs();
        const std::size_t end_cell =
          (n_cells * this->end + this->n_slabs() - 1) / this->n_slabs();
        const std::size_t begin =
          2 * (std::max(begin_cell, n_ghosts) - n_ghosts);
        const std::size_t width =
          2 * std::min(end_cell + n_ghosts, n_cells) + 1 - begin;
        const std::size_t whole_width = 2 * n_cells + 1;

        CoarsePiece              &piece = result[l];
        std::vector<unsigned int> places(lattice.size() / whole_width * width);
        for (std::size_t k = 0; k < places.size(); ++k)
          {
            const std::size_t i = k / width * whole_width + begin + k % width;
            if (!lattice.is_vertex(i))
              continue;
            places[k] = static_cast<unsigned int>(piece.numbers.size());
            piece.numbers.push_back(
              static_cast<unsigned int>(lattice.number(i)));
            piece.level.vertices.push_back(lattice.point(i));
            const unsigned int slab = lattice.slab(i, this->n_slabs());
            piece.level.slabs.push_back(slab);
            piece.is_own.push_back(this->owns_slab(slab));
          }
        piece.n_whole        = static_cast<unsigned int>(lattice.n_vertices());
        piece.level.to_finer = lattice.interpolation(
          l == 0 ? points : result[l - 1].level.vertices,
          static_cast<unsigned int>(piece.numbers.size()),
          [&](const std::size_t i) {
            return places[i / whole_width * width + i % whole_width - begin];
          });
      }
    return result;
  }



  template <int dim>
  typename BoxPiece<dim>::CoarseWhole
  BoxPiece<dim>::coarse_whole(const unsigned int n) const
  {
    std::vector<BoxParameters> boxes = box->coarse_boxes();
    const BoxParameters        first = boxes.at(n - 1);
    boxes.erase(boxes.begin(), boxes.begin() + n);
    const CrossedLattice<dim> lattice(first);
    CoarseWhole               result;
    for (std::size_t i = 0; i < lattice.size(); ++i)
      if (lattice.is_vertex(i))
        {
          result.vertices.push_back(lattice.point(i));
          result.slabs.push_back(lattice.slab(i, this->n_slabs()));
        }
    result.coarser = box->levels_of(boxes, result.vertices);
    return result;
  }



  template class BoxPiece<2>;
  template class BoxPiece<3>;
} // namespace Debond
