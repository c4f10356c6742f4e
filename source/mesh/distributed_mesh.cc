// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/grid/cell_id.h>
#include <deal.II/grid/grid_tools.h>

#include <debond/base/instantiate.h>
#include <debond/base/ranks.h>
#include <debond/base/text.h>
#include <debond/mesh/box.h>
#include <debond/mesh/distributed_mesh.h>

#include <boost/serialization/map.hpp>
#include <boost/serialization/set.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <cstdint>

namespace Debond
{
  /// For boost::serialization.
  template <typename Archive>
  void
  serialize(Archive &archive, PieceNames &names, const unsigned int)
  {
    archive &names.boundaries &names.regions &names.interfaces &names.notes;
  }



  namespace
  {
    template <int dim>
    using Description = dealii::TriangulationDescription::Description<dim, dim>;

    template <int dim>
    using CellInfo = dealii::TriangulationDescription::CellData<dim>;

    /// The number of simplices of a cell of a box.
    template <int dim>
    constexpr unsigned int n_simplices = dim == 2 ? 4 : 24;



    /// Gives each rank some cells. Of few cells METIS may leave it none, which
    /// deal.II does not allow.
    template <int dim>
    void
    share_out(dealii::Triangulation<dim> &mesh, const unsigned int n_ranks)
    {
      // METIS makes parts of nearly the same size with few faces between them,
      // by the graph of cells that share a face.
      dealii::GridTools::partition_triangulation(
        n_ranks, mesh, dealii::SparsityTools::Partitioner::metis);
      std::set<dealii::types::subdomain_id> with_cells;
      for (const auto &cell : mesh.active_cell_iterators())
        with_cells.insert(cell->subdomain_id());
      if (with_cells.size() == n_ranks)
        return;

      // The fallback gives each rank a row of cells in the order of the mesh.
      // With at least as many cells as ranks none is empty. The product is one
      // of 64 bits, as cells times ranks may exceed 32 bits.
      for (const auto &cell : mesh.active_cell_iterators())
        cell->set_subdomain_id(static_cast<dealii::types::subdomain_id>(
          std::uint64_t{cell->active_cell_index()} * n_ranks /
          mesh.n_active_cells()));
    }



    /// The part that a rank needs of the mesh that the first one has, and gives
    /// away.
    template <int dim>
    Description<dim>
    part_of_mesh(dealii::Triangulation<dim> &whole, const MPI_Comm ranks)
    {
      // All ranks form one group, in which the first rank has the mesh. It
      // moves that mesh into deal.II's own, describes the part of each rank
      // with its ghosts, and sends the descriptions. The memory of the whole
      // mesh is needed on the first rank only.
      const unsigned int n_ranks = number_of_ranks(ranks);
      using dealii::TriangulationDescription::Utilities::
        create_description_from_triangulation_in_groups;
      return create_description_from_triangulation_in_groups<dim, dim>(
        [&](dealii::Triangulation<dim> &mesh) { mesh = std::move(whole); },
        [&](dealii::Triangulation<dim> &mesh,
            const MPI_Comm &,
            const unsigned int) { share_out(mesh, n_ranks); },
        ranks,
        static_cast<int>(n_ranks));
    }



    /// The direction in which a box has the most cells.
    template <int dim>
    unsigned int
    direction_of_layers(const BoxParameters &box)
    {
      return static_cast<unsigned int>(
        std::max_element(box.cells.begin(), box.cells.begin() + dim) -
        box.cells.begin());
    }



    /// One of the simplices of the cell of a box at @p place.
    template <int dim>
    CellInfo<dim>
    describe_simplex(const BoxParameters               &box,
                     const std::array<unsigned int, 3> &place,
                     const unsigned int                 simplex,
                     const dealii::types::subdomain_id  owner)
    {
      // The cells of a box are numbered with the first direction running
      // fastest, and the simplices of a cell follow each other: the number is
      // the place of the simplex in the mesh that make_box() makes as a whole.
      // deal.II identifies cells of different ranks by it.
      dealii::types::coarse_cell_id number = 0;
      for (unsigned int d = dim; d-- > 0;)
        number = number * box.cells[d] + place[d];

      CellInfo<dim> info;
      info.id = dealii::CellId(number * n_simplices<dim> + simplex, {})
                  .template to_binary<dim>();
      info.subdomain_id       = owner;
      info.level_subdomain_id = dealii::numbers::invalid_subdomain_id;
      info.manifold_id        = dealii::numbers::flat_manifold_id;
      info.manifold_line_ids.fill(dealii::numbers::flat_manifold_id);
      info.manifold_quad_ids.fill(dealii::numbers::flat_manifold_id);
      // CellCrossing lists the simplices face by face, so that the quotient is
      // the number of the cell's side, in deal.II's order 0, 1 for x, 2, 3 for
      // y and 4, 5 for z. These are the ids of the box's sides too. The face on
      // that side is the first one of the simplex, as its centre is the last
      // vertex. Faces with ids are listed for ghosts as well.
      const unsigned int side = simplex / (n_simplices<dim> / (2 * dim));
      if (place[side / 2] == (side % 2 == 0 ? 0 : box.cells[side / 2] - 1))
        info.boundary_ids = {{0, side}};
      return info;
    }



    /// The part that a rank needs of a box with a layer of cells for each rank.
    /// The owner of a layer is [layer n_ranks / n_layers].
    template <int dim>
    Description<dim>
    part_of_layers(const BoxParameters &box, const MPI_Comm ranks)
    {
      // No rank has the whole box. Each one makes its own layers and the next
      // one on both sides, removes from the latter the simplices that touch no
      // vertex of its own, and describes the rest to deal.II by hand. Nothing
      // is communicated for this: coordinates, numbers and owners follow from
      // the box alone and are the same on all ranks, to the last bit.
      const std::uint64_t n_ranks   = number_of_ranks(ranks);
      const unsigned int  rank      = rank_of_this(ranks);
      const unsigned int  direction = direction_of_layers<dim>(box);
      const unsigned int  n_layers  = box.cells[direction];
      // The smallest layer l with [l n_ranks / n_layers] = owner is owner
      // n_layers / n_ranks, rounded up. As there are no fewer layers than
      // ranks, each rank has one.
      const auto first_layer = [&](const std::uint64_t owner) {
        return static_cast<unsigned int>((owner * n_layers + n_ranks - 1) /
                                         n_ranks);
      };

      // The own layers and one on each side of them, if there is one. Simplices
      // that share a vertex with own ones are in these.
      std::array<unsigned int, 3> begin = {}, n_cells = box.cells;
      begin[direction] = std::max(first_layer(rank), 1u) - 1;
      n_cells[direction] =
        std::min(first_layer(rank + 1) + 1, n_layers) - begin[direction];
      const MeshData<dim> part     = part_of_box<dim>(box, begin, n_cells);
      const auto          place_of = [&](std::size_t simplex) {
        // part_of_box() numbers its cells as describe_simplex() does, but
        // within the part.
        simplex /= n_simplices<dim>;
        std::array<unsigned int, 3> place = begin;
        for (unsigned int d = 0; d < dim; ++d)
          {
            place[d] += static_cast<unsigned int>(simplex % n_cells[d]);
            simplex /= n_cells[d];
          }
        return place;
      };
      const auto owner_of = [&](const std::size_t simplex) {
        return static_cast<unsigned int>(place_of(simplex)[direction] *
                                         n_ranks / n_layers);
      };

      // The vertices of own simplices. What has one of them is an own simplex
      // or a ghost.
      std::vector<bool> is_own(part.vertices.size(), false);
      for (std::size_t i = 0; i < part.cells.size(); ++i)
        if (owner_of(i) == rank)
          for (const unsigned int v : part.cells[i].vertices)
            is_own[v] = true;

      // Vertices that remain are numbered in the order in which cells use them.
      // The cells keep their order, which is the one of the whole mesh, and all
      // are on one level.
      Description<dim> result;
      result.comm      = ranks;
      result.settings  = dealii::TriangulationDescription::default_setting;
      result.smoothing = dealii::Triangulation<dim>::none;
      result.cell_infos.resize(1);
      std::vector<unsigned int> numbers(part.vertices.size(),
                                        dealii::numbers::invalid_unsigned_int);
      for (std::size_t i = 0; i < part.cells.size(); ++i)
        {
          dealii::CellData<dim> cell = part.cells[i];
          // A simplex without an own vertex is left out although the layer was
          // made: its owner does not have a cell of this rank as its ghost
          // then, and the exchange of unknowns, in which both sides have to
          // list the same cells, would fail.
          if (std::none_of(cell.vertices.begin(),
                           cell.vertices.end(),
                           [&](const unsigned int v) { return is_own[v]; }))
            continue;
          for (unsigned int &v : cell.vertices)
            {
              if (numbers[v] == dealii::numbers::invalid_unsigned_int)
                {
                  numbers[v] = static_cast<unsigned int>(
                    result.coarse_cell_vertices.size());
                  result.coarse_cell_vertices.push_back(part.vertices[v]);
                }
              v = numbers[v];
            }
          result.coarse_cells.push_back(std::move(cell));
          result.cell_infos[0].push_back(describe_simplex<dim>(
            box,
            place_of(i),
            static_cast<unsigned int>(i % n_simplices<dim>),
            owner_of(i)));
          result.coarse_cell_index_to_coarse_cell_id.push_back(
            dealii::CellId(result.cell_infos[0].back().id)
              .get_coarse_cell_id());
        }
      return result;
    }
  } // namespace



  template <int dim>
  DistributedMesh<dim>
  make_distributed_mesh(const Body<dim> &body, const MPI_Comm ranks)
  {
    // On one rank the mesh is a plain Triangulation, which needs no MPI.
    // Several ranks need deal.II's fully distributed one, as its other
    // distributed meshes have no simplices or keep the whole mesh on each rank.
    DistributedMesh<dim> result;
    const unsigned int   n_ranks = number_of_ranks(ranks);
    if (n_ranks == 1)
      {
        result.triangulation = std::make_unique<dealii::Triangulation<dim>>();
        result.names         = body.make_mesh(*result.triangulation);
        return result;
      }

    auto mesh =
      std::make_unique<dealii::parallel::fullydistributed::Triangulation<dim>>(
        ranks);
    // Parts and cuts are found on the whole mesh, and then a box is made by the
    // first rank as other bodies are.
    const auto *box = dynamic_cast<const Box<dim> *>(&body);
    if (box != nullptr && box->parts.empty() && !box->has_interfaces() &&
        box->parameters.cells[direction_of_layers<dim>(box->parameters)] >=
          n_ranks)
      {
        mesh->create_triangulation(part_of_layers<dim>(box->parameters, ranks));
        result.names = box->whole_names();
      }
    else
      {
        dealii::Triangulation<dim> whole;
        result.names =
          on_first_rank(ranks, [&]() { return body.make_mesh(whole); });
        // The number of cells is known on the first rank alone. All have to
        // know it before they throw, so that no rank goes into the collective
        // call below without the others.
        const unsigned int n_cells =
          dealii::Utilities::MPI::broadcast(ranks, whole.n_active_cells());
        if (n_cells < n_ranks)
          throw std::invalid_argument(words(n_cells,
                                            " cells cannot be shared by ",
                                            n_ranks,
                                            " ranks; start fewer"));
        mesh->create_triangulation(part_of_mesh(whole, ranks));
      }
    result.triangulation = std::move(mesh);
    return result;
  }



  DEBOND_INSTANTIATE(make_distributed_mesh);
} // namespace Debond
