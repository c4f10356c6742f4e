// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/linear_algebra/multigrid/root_level.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace Debond
{
  namespace
  {
    /// The unknowns of the nodes, of those that are not own as nothing.
    template <int dim>
    std::vector<dealii::types::global_dof_index>
    unknowns_of(const std::vector<unsigned int> &numbers,
                const std::vector<bool>         &is_own = {})
    {
      std::vector<dealii::types::global_dof_index> result;
      for (std::size_t i = 0; i < numbers.size(); ++i)
        for (unsigned int c = 0; c < dim; ++c)
          result.push_back(is_own.empty() || is_own[i] ?
                             numbers[i] * dim + c :
                             dealii::numbers::invalid_dof_index);
      return result;
    }



    /// All unknowns on the root, none elsewhere.
    template <int dim>
    std::vector<dealii::types::global_dof_index>
    unknowns_of_root(const unsigned int n_nodes, const MPI_Comm ranks)
    {
      std::vector<dealii::types::global_dof_index> result;
      if (dealii::Utilities::MPI::this_mpi_process(ranks) == 0)
        result.resize(std::size_t(n_nodes) * dim);
      std::iota(result.begin(), result.end(), 0);
      return result;
    }
  } // namespace



  template <int dim>
  RootLevel<dim>::RootLevel(const Piece &own_piece, const MPI_Comm communicator)
    : piece(own_piece)
    , ranks(communicator)
    , to_root(unknowns_of<dim>(piece.numbers, piece.is_own),
              unknowns_of_root<dim>(piece.n_whole, ranks),
              ranks)
    , from_root(unknowns_of_root<dim>(piece.n_whole, ranks),
                unknowns_of<dim>(piece.numbers),
                ranks)
  {
    for (unsigned int i = 0; i < piece.numbers.size(); ++i)
      if (piece.is_own[i])
        {
          if (ranges.empty() || ranges.back().second != i)
            ranges.emplace_back(i, i);
          ++ranges.back().second;
        }
  }



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
    return static_cast<unsigned int>(piece.numbers.size());
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
    // Of each row its number and how many blocks it has, then their columns.
    std::map<unsigned int, std::vector<unsigned int>> shapes;
    std::map<unsigned int, std::vector<double>>       all_values;
    std::vector<unsigned int>                        &shape  = shapes[0];
    std::vector<double>                              &values = all_values[0];
    for (const auto &[begin, end] : ranges)
      for (unsigned int i = begin; i < end; ++i)
        if (local.starts[i] != local.starts[i + 1])
          {
            shape.push_back(piece.numbers[i]);
            shape.push_back(
              static_cast<unsigned int>(local.starts[i + 1] - local.starts[i]));
            for (std::size_t k = local.starts[i]; k < local.starts[i + 1]; ++k)
              shape.push_back(piece.numbers[local.columns[k]]);
            values.insert(values.end(),
                          local.values.begin() + local.starts[i] * dim * dim,
                          local.values.begin() +
                            local.starts[i + 1] * dim * dim);
          }
    // deal.II's gather() compresses what it sends.
    shapes     = dealii::Utilities::MPI::some_to_some(ranks, shapes);
    all_values = dealii::Utilities::MPI::some_to_some(ranks, all_values);

    // Ranks in turn: rows of each are in ascending order, those of all not.
    struct Row
    {
      const unsigned int *shape;
      const double       *values;
    };
    std::vector<Row> rows(is_root() ? piece.n_whole : 0, {nullptr, nullptr});
    for (const auto &[rank, of_rank] : shapes)
      {
        const double *value = all_values.at(rank).data();
        for (std::size_t k = 0; k < of_rank.size();)
          {
            const unsigned int *const row = of_rank.data() + k;
            rows[row[0]]                  = {row, value};
            value += std::size_t(row[1]) * dim * dim;
            k += 2 + row[1];
          }
      }
    BlockMatrix<dim, double> result;
    for (const Row &row : rows)
      {
        if (row.shape != nullptr)
          {
            result.columns.insert(result.columns.end(),
                                  row.shape + 2,
                                  row.shape + 2 + row.shape[1]);
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
  unsigned int
  RootLevel<dim>::local_node(const unsigned int number) const
  {
    const auto place =
      std::lower_bound(piece.numbers.begin(), piece.numbers.end(), number);
    return place != piece.numbers.end() && *place == number ?
             static_cast<unsigned int>(place - piece.numbers.begin()) :
             dealii::numbers::invalid_unsigned_int;
  }



  template <int dim>
  unsigned int
  RootLevel<dim>::number(const unsigned int local_node) const
  {
    return piece.numbers[local_node];
  }



  template <int dim>
  bool
  RootLevel<dim>::is_own(const unsigned int local_node) const
  {
    return piece.is_own[local_node];
  }



  template <int dim>
  const std::vector<std::pair<unsigned int, unsigned int>> &
  RootLevel<dim>::own_ranges() const
  {
    return ranges;
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
