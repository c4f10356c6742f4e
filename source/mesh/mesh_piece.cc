// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/mesh/crossed_mesh.h>
#include <debond/mesh/mesh_piece.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace Debond
{
  namespace
  {
    constexpr unsigned int
    simplices_of_cell(const int dim)
    {
      return dim == 2 ? 4 : 24;
    }
  } // namespace



  template <int dim>
  MeshPiece<dim>::MeshPiece(const std::shared_ptr<const MeshBody<dim>> &body,
                            const MPI_Comm                              ranks)
    : MeshPiece(body,
                ranks,
                body->halved(body->finest_level(),
                             dealii::Utilities::MPI::this_mpi_process(ranks),
                             dealii::Utilities::MPI::n_mpi_processes(ranks)))
  {}



  template <int dim>
  MeshPiece<dim>::MeshPiece(const std::shared_ptr<const MeshBody<dim>> &body,
                            const MPI_Comm                              ranks,
                            HalvedMesh<dim>                           &&cells)
    : BodyPiece<dim>(body,
                     cells.n_slabs(),
                     dealii::Utilities::MPI::this_mpi_process(ranks),
                     dealii::Utilities::MPI::n_mpi_processes(ranks))
    , body(body)
    , ranks(ranks)
    , halved(std::move(cells))
    , cells(halved.cells(body->finest_level()))
    , finest(halved.vertices(body->finest_level()))
    , finest_numbers(numbers_of(finest))
  {}



  template <int dim>
  std::vector<unsigned int>
  MeshPiece<dim>::numbers_of(const Vertices &vertices) const
  {
    // Vertices are in the order of their units: how many each has, and so how
    // many there are before it.
    std::vector<unsigned int> starts(halved.n_units() + 1, 0);
    for (std::size_t i = 0; i < vertices.units.size(); ++i)
      if (this->owns_slab(vertices.slabs[i]))
        ++starts[vertices.units[i] + 1];
    dealii::Utilities::MPI::sum(starts, ranks, starts);
    std::partial_sum(starts.begin(), starts.end(), starts.begin());

    std::vector<unsigned int> result(vertices.keys.size());
    std::map<unsigned int, std::vector<std::size_t>> asked;
    for (std::size_t i = 0; i < result.size(); ++i)
      if (this->owns_slab(vertices.slabs[i]))
        result[i] = starts[vertices.units[i]]++;
      else
        asked[halved.owner(vertices.slabs[i])].push_back(vertices.keys[i]);

    std::map<unsigned int, std::vector<unsigned int>> answers;
    for (const auto &[rank, keys] :
         dealii::Utilities::MPI::some_to_some(ranks, asked))
      for (const std::size_t key : keys)
        answers[rank].push_back(
          result[std::lower_bound(
                   vertices.keys.begin(), vertices.keys.end(), key) -
                 vertices.keys.begin()]);
    answers = dealii::Utilities::MPI::some_to_some(ranks, answers);
    std::map<unsigned int, std::size_t> next;
    for (std::size_t i = 0; i < result.size(); ++i)
      if (!this->owns_slab(vertices.slabs[i]))
        {
          const unsigned int rank = halved.owner(vertices.slabs[i]);
          result[i]               = answers.at(rank)[next[rank]++];
        }
    return result;
  }



  template <int dim>
  PieceNames
  MeshPiece<dim>::make_whole_mesh(dealii::Triangulation<dim> &mesh) const
  {
    std::vector<typename HalvedMesh<dim>::CellIterator> parts;
    for (const auto &cell : cells)
      parts.push_back(cell.cell);
    dealii::types::boundary_id id_of_cuts = 0;
    for (const auto &[id, n] : n_faces())
      id_of_cuts = std::max(id_of_cuts, id + 1);
    crossed_part(parts, id_of_cuts, mesh);
    return body->names();
  }



  template <int dim>
  std::vector<unsigned int>
  MeshPiece<dim>::slabs(const dealii::Triangulation<dim> &mesh) const
  {
    std::vector<unsigned int> result = halved.places(mesh, finest);
    for (unsigned int &entry : result)
      entry = finest.slabs[entry];
    return result;
  }



  template <int dim>
  std::map<dealii::types::boundary_id, unsigned int>
  MeshPiece<dim>::n_faces() const
  {
    return body->n_faces();
  }



  template <int dim>
  std::vector<unsigned int>
  MeshPiece<dim>::numbers(const dealii::Triangulation<dim> &mesh) const
  {
    std::vector<unsigned int> result = halved.places(mesh, finest);
    for (unsigned int &entry : result)
      entry = finest_numbers[entry];
    return result;
  }



  template <int dim>
  std::size_t
  MeshPiece<dim>::cell_number(const unsigned int active_cell) const
  {
    return cells[active_cell / simplices_of_cell(dim)].number;
  }



  template <int dim>
  bool
  MeshPiece<dim>::owns_cell(const unsigned int active_cell) const
  {
    return this->owns_slab(cells[active_cell / simplices_of_cell(dim)].slab);
  }



  template <int dim>
  unsigned int
  MeshPiece<dim>::n_shared_levels() const
  {
    // Each rank has a unit, which has a vertex in its centre.
    return std::max(1u,
                    std::min(body->n_coarse_levels(),
                             1 + body->finest_level() -
                               body->level_of_units()));
  }



  template <int dim>
  std::vector<typename MeshPiece<dim>::CoarsePiece>
  MeshPiece<dim>::coarse_pieces(const dealii::Triangulation<dim> &mesh,
                                const std::vector<unsigned int>  &vertices,
                                const unsigned int                n) const
  {
    Vertices                        finer  = finest;
    const std::vector<unsigned int> places = halved.places(mesh, finest);
    std::vector<unsigned int>       nodes(vertices.size());
    for (unsigned int i = 0; i < vertices.size(); ++i)
      nodes[places[vertices[i]]] = i;
    finer.renumber(nodes);

    std::vector<CoarsePiece> result;
    for (unsigned int k = 1; k <= n; ++k)
      {
        const unsigned int level  = body->finest_level() - k;
        Vertices           coarse = halved.vertices(level);
        CoarsePiece       &piece  = result.emplace_back();
        piece.level               = {coarse.points,
                                     halved.interpolation(level, coarse, finer),
                                     coarse.slabs};
        for (const unsigned int slab : coarse.slabs)
          piece.is_own.push_back(this->owns_slab(slab));
        if (level >= body->level_of_units())
          piece.numbers = numbers_of(coarse);
        else
          {
            piece.numbers.resize(coarse.keys.size());
            std::iota(piece.numbers.begin(), piece.numbers.end(), 0u);
          }
        piece.n_whole =
          static_cast<unsigned int>(body->n_vertices_of_level(level));
        finer = std::move(coarse);
      }
    return result;
  }



  template <int dim>
  typename MeshPiece<dim>::CoarseWhole
  MeshPiece<dim>::coarse_whole(const unsigned int n) const
  {
    const unsigned int    level = body->finest_level() - n;
    const HalvedMesh<dim> whole = body->halved(level);
    const Vertices        first = whole.vertices(level);
    return {first.points,
            first.slabs,
            whole.coarse_levels(level, first, body->n_coarse_levels() - n)};
  }



  template class MeshPiece<2>;
  template class MeshPiece<3>;
} // namespace Debond
