// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/linear_algebra/multigrid/root_level.h>

#include <algorithm>
#include <utility>

namespace Debond
{
  namespace
  {
    /// The unknowns of the nodes, of those that are not own as nothing.
    template <int dim>
    std::vector<dealii::types::global_dof_index>
    unknowns_of(const std::vector<unsigned int> &ids,
                const std::vector<bool>         &is_own = {})
    {
      std::vector<dealii::types::global_dof_index> result;
      for (std::size_t i = 0; i < ids.size(); ++i)
        for (unsigned int c = 0; c < dim; ++c)
          result.push_back(is_own.empty() || is_own[i] ?
                             ids[i] * dim + c :
                             dealii::numbers::invalid_dof_index);
      return result;
    }



    unsigned int
    place_of(const unsigned int id, const std::vector<unsigned int> &ids)
    {
      const auto place = std::lower_bound(ids.begin(), ids.end(), id);
      return place != ids.end() && *place == id ?
               static_cast<unsigned int>(place - ids.begin()) :
               dealii::numbers::invalid_unsigned_int;
    }
  } // namespace



  template <int dim>
  RootLevel<dim>::RootLevel(const Piece              &own_piece,
                            std::vector<unsigned int> all,
                            const MPI_Comm            communicator)
    : piece(own_piece)
    , all_ids(std::move(all))
    , ranks(communicator)
    , to_root(unknowns_of<dim>(piece.ids, piece.is_own),
              unknowns_of<dim>(all_ids),
              ranks)
    , from_root(unknowns_of<dim>(all_ids), unknowns_of<dim>(piece.ids), ranks)
  {}



  template <int dim>
  bool
  RootLevel<dim>::is_root() const
  {
    return dealii::Utilities::MPI::this_mpi_process(ranks) == 0;
  }



  template <int dim>
  unsigned int
  RootLevel<dim>::n_local_nodes() const
  {
    return static_cast<unsigned int>(piece.ids.size());
  }



  template <int dim>
  template <typename Number>
  void
  RootLevel<dim>::gather(const std::vector<Number> &local,
                         std::vector<Number>       &all) const
  {
    to_root.export_to_ghosted_array(
      dealii::ArrayView<const Number>(local.data(), local.size()),
      dealii::ArrayView<Number>(all.data(), all.size()));
  }



  template <int dim>
  template <typename Number>
  void
  RootLevel<dim>::scatter(const std::vector<Number> &all,
                          std::vector<Number>       &local) const
  {
    from_root.export_to_ghosted_array(
      dealii::ArrayView<const Number>(all.data(), all.size()),
      dealii::ArrayView<Number>(local.data(), local.size()));
  }



  template <int dim>
  BlockMatrix<dim, double>
  RootLevel<dim>::gather_rows(const BlockMatrix<dim, double> &local) const
  {
    // Of each row its id and the number of its blocks, then their columns.
    std::vector<unsigned int> shape;
    std::vector<double>       values;
    for (unsigned int i = 0; i < local.n_rows(); ++i)
      if (piece.is_own[i] && local.starts[i] != local.starts[i + 1])
        {
          shape.push_back(piece.ids[i]);
          shape.push_back(
            static_cast<unsigned int>(local.starts[i + 1] - local.starts[i]));
          for (std::size_t k = local.starts[i]; k < local.starts[i + 1]; ++k)
            shape.push_back(piece.ids[local.columns[k]]);
          values.insert(values.end(),
                        local.values.begin() + local.starts[i] * dim * dim,
                        local.values.begin() + local.starts[i + 1] * dim * dim);
        }
    const auto shapes     = dealii::Utilities::MPI::gather(ranks, shape);
    const auto all_values = dealii::Utilities::MPI::gather(ranks, values);

    // Ranks in turn: rows of each are in ascending order, those of all not.
    struct Row
    {
      const unsigned int *shape;
      const double       *values;
    };
    std::vector<Row> rows(all_ids.size(), {nullptr, nullptr});
    for (std::size_t rank = 0; rank < shapes.size(); ++rank)
      {
        const double *value = all_values[rank].data();
        for (std::size_t k = 0; k < shapes[rank].size();)
          {
            const unsigned int *const row = shapes[rank].data() + k;
            rows[node_of(row[0])]         = {row, value};
            value += std::size_t(row[1]) * dim * dim;
            k += 2 + row[1];
          }
      }
    BlockMatrix<dim, double> result;
    for (const Row &row : rows)
      {
        if (row.shape != nullptr)
          {
            for (unsigned int k = 0; k < row.shape[1]; ++k)
              result.columns.push_back(node_of(row.shape[2 + k]));
            result.values.insert(result.values.end(),
                                 row.values,
                                 row.values +
                                   std::size_t(row.shape[1]) * dim * dim);
          }
        result.end_row();
      }
    result.columns.shrink_to_fit();
    result.values.shrink_to_fit();
    return result;
  }



  template <int dim>
  void
  RootLevel<dim>::share(const std::vector<OriginatingFrame> &own,
                        std::vector<OriginatingFrame>       &local,
                        std::vector<OriginatingFrame>       &all) const
  {
    std::vector<unsigned int> nodes;
    std::vector<double>       entries;
    for (const auto &[frame, origin] : own)
      {
        nodes.push_back(piece.ids[frame.node]);
        nodes.push_back(origin);
        for (const auto *block : {&frame.to_unknowns, &frame.to_cartesian})
          entries.insert(entries.end(), block->begin(), block->end());
      }
    const auto all_nodes   = dealii::Utilities::MPI::all_gather(ranks, nodes);
    const auto all_entries = dealii::Utilities::MPI::all_gather(ranks, entries);
    local.clear();
    all.clear();
    for (std::size_t rank = 0; rank < all_nodes.size(); ++rank)
      for (std::size_t k = 0; k < all_nodes[rank].size() / 2; ++k)
        {
          OriginatingFrame frame;
          frame.origin = all_nodes[rank][2 * k + 1];
          const double *const entry =
            all_entries[rank].data() + 2 * dim * dim * k;
          std::copy_n(entry, dim * dim, frame.frame.to_unknowns.begin());
          std::copy_n(entry + dim * dim,
                      dim * dim,
                      frame.frame.to_cartesian.begin());
          const unsigned int id = all_nodes[rank][2 * k];
          frame.frame.node      = place_of(id, piece.ids);
          if (frame.frame.node != dealii::numbers::invalid_unsigned_int)
            local.push_back(frame);
          frame.frame.node = place_of(id, all_ids);
          if (frame.frame.node != dealii::numbers::invalid_unsigned_int)
            all.push_back(frame);
        }
    for (auto *frames : {&local, &all})
      std::sort(frames->begin(),
                frames->end(),
                [](const auto &a, const auto &b) {
                  return a.frame.node < b.frame.node;
                });
  }



  template <int dim>
  unsigned int
  RootLevel<dim>::id(const unsigned int local_node) const
  {
    return piece.ids[local_node];
  }



  template <int dim>
  unsigned int
  RootLevel<dim>::node_of(const unsigned int id) const
  {
    return place_of(id, all_ids);
  }



  template <int dim>
  bool
  RootLevel<dim>::is_own(const unsigned int local_node) const
  {
    return piece.is_own[local_node];
  }



  template <int dim>
  MPI_Comm
  RootLevel<dim>::communicator() const
  {
    return ranks;
  }



  template class RootLevel<2>;
  template class RootLevel<3>;
  template void
  RootLevel<2>::gather(const std::vector<float> &, std::vector<float> &) const;
  template void
  RootLevel<3>::gather(const std::vector<float> &, std::vector<float> &) const;
  template void
  RootLevel<2>::gather(const std::vector<double> &,
                       std::vector<double> &) const;
  template void
  RootLevel<3>::gather(const std::vector<double> &,
                       std::vector<double> &) const;
  template void
  RootLevel<2>::scatter(const std::vector<float> &, std::vector<float> &) const;
  template void
  RootLevel<3>::scatter(const std::vector<float> &, std::vector<float> &) const;
  template void
  RootLevel<2>::scatter(const std::vector<double> &,
                        std::vector<double> &) const;
  template void
  RootLevel<3>::scatter(const std::vector<double> &,
                        std::vector<double> &) const;
} // namespace Debond
