// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/linear_algebra/multigrid/shared_nodes.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace Debond
{
  SharedNodes::SharedNodes(const unsigned int        dimension,
                           std::vector<unsigned int> slabs_of_nodes)
    : dim(dimension)
    , slabs(std::move(slabs_of_nodes))
    , sums(slabs.empty() ? 0 :
                           *std::max_element(slabs.begin(), slabs.end()) + 1)
    , ranges({{0u, static_cast<unsigned int>(slabs.size())}})
  {}



  SharedNodes::SharedNodes(const unsigned int        dimension,
                           std::vector<unsigned int> slabs_of_nodes,
                           const unsigned int        n_slabs,
                           const Piece              &piece)
    : dim(dimension)
    , slabs(std::move(slabs_of_nodes))
    , sums(n_slabs)
    , numbers(piece.numbers)
    , ranks(piece.communicator)
  {
    using dealii::numbers::invalid_dof_index;
    std::vector<dealii::types::global_dof_index> own, ghosts;
    for (unsigned int i = 0; i < numbers.size(); ++i)
      {
        if (piece.is_own[i] && (ranges.empty() || ranges.back().second != i))
          ranges.emplace_back(i, i);
        if (piece.is_own[i])
          ++ranges.back().second;
        for (unsigned int c = 0; c < dim; ++c)
          {
            const dealii::types::global_dof_index unknown =
              numbers[i] * dim + c;
            own.push_back(piece.is_own[i] ? unknown : invalid_dof_index);
            ghosts.push_back(piece.is_own[i] ? invalid_dof_index : unknown);
          }
      }
    exchange =
      std::make_unique<dealii::Utilities::MPI::NoncontiguousPartitioner>(own,
                                                                         ghosts,
                                                                         ranks);
  }



  unsigned int
  SharedNodes::size() const
  {
    return static_cast<unsigned int>(slabs.size());
  }



  bool
  SharedNodes::is_whole() const
  {
    return !exchange;
  }



  unsigned int
  SharedNodes::number(const unsigned int node) const
  {
    return is_whole() ? node : numbers[node];
  }



  unsigned int
  SharedNodes::node_of(const unsigned int number) const
  {
    if (is_whole())
      return number;
    const auto place = std::lower_bound(numbers.begin(), numbers.end(), number);
    return place != numbers.end() && *place == number ?
             static_cast<unsigned int>(place - numbers.begin()) :
             dealii::numbers::invalid_unsigned_int;
  }



  bool
  SharedNodes::is_own(const unsigned int node) const
  {
    const auto next =
      std::upper_bound(ranges.begin(),
                       ranges.end(),
                       node,
                       [](const unsigned int i, const auto &range) {
                         return i < range.second;
                       });
    return next != ranges.end() && next->first <= node;
  }



  const std::vector<std::pair<unsigned int, unsigned int>> &
  SharedNodes::own_ranges() const
  {
    return ranges;
  }



  MPI_Comm
  SharedNodes::communicator() const
  {
    return ranks;
  }



  template <typename Number>
  void
  SharedNodes::update_ghosts(Number *const values) const
  {
    if (is_whole())
      return;
    const std::size_t n = slabs.size() * dim;
    exchange->export_to_ghosted_array(dealii::ArrayView<const Number>(values,
                                                                      n),
                                      dealii::ArrayView<Number>(values, n));
  }



  double
  SharedNodes::largest(const double *const a) const
  {
    double result = 0.;
    for (const auto &[begin, end] : ranges)
      for (std::size_t k = std::size_t(begin) * dim; k < std::size_t(end) * dim;
           ++k)
        result = std::max(std::abs(a[k]), result);
    return is_whole() ? result : dealii::Utilities::MPI::max(result, ranks);
  }



  double
  SharedNodes::sum() const
  {
    // Each entry is zero on all ranks but one.
    if (!is_whole())
      dealii::Utilities::MPI::sum(
        dealii::ArrayView<const double>(sums.data(), sums.size()),
        ranks,
        dealii::ArrayView<double>(sums.data(), sums.size()));
    return std::accumulate(sums.begin(), sums.end(), 0.);
  }



  template void
  SharedNodes::update_ghosts(float *const) const;
  template void
  SharedNodes::update_ghosts(double *const) const;
} // namespace Debond
