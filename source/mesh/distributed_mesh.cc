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
      dealii::GridTools::partition_triangulation(
        n_ranks, mesh, dealii::SparsityTools::Partitioner::metis);
      std::set<dealii::types::subdomain_id> with_cells;
      for (const auto &cell : mesh.active_cell_iterators())
        with_cells.insert(cell->subdomain_id());
      if (with_cells.size() == n_ranks)
        return;

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
      // Its first face is on a side of the cell.
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
      const std::uint64_t n_ranks     = number_of_ranks(ranks);
      const unsigned int  rank        = rank_of_this(ranks);
      const unsigned int  direction   = direction_of_layers<dim>(box);
      const unsigned int  n_layers    = box.cells[direction];
      const auto          first_layer = [&](const std::uint64_t owner) {
        return static_cast<unsigned int>((owner * n_layers + n_ranks - 1) /
                                         n_ranks);
      };

      // The own ones and one on each side.
      std::array<unsigned int, 3> begin = {}, n_cells = box.cells;
      begin[direction] = std::max(first_layer(rank), 1u) - 1;
      n_cells[direction] =
        std::min(first_layer(rank + 1) + 1, n_layers) - begin[direction];
      const MeshData<dim> part     = part_of_box<dim>(box, begin, n_cells);
      const auto          place_of = [&](std::size_t simplex) {
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

      std::vector<bool> is_own(part.vertices.size(), false);
      for (std::size_t i = 0; i < part.cells.size(); ++i)
        if (owner_of(i) == rank)
          for (const unsigned int v : part.cells[i].vertices)
            is_own[v] = true;

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
          // Its owner has to know a ghost as well.
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
    const auto *box = dynamic_cast<const Box<dim> *>(&body);
    if (box != nullptr && box->parts.empty() && box->cuts.empty() &&
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
