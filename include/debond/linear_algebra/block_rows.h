// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_block_rows_h
#define debond_linear_algebra_block_rows_h

#include <deal.II/base/exceptions.h>

#include <boost/serialization/vector.hpp>

#include <cstddef>
#include <type_traits>
#include <vector>

namespace Debond
{
  /// The places of the blocks of height x width entries in a sparse matrix: row
  /// i has them in the columns columns[k], starts[i] <= k < starts[i + 1].
  struct BlockPattern
  {
    unsigned int              height = 0, width = 0;
    std::vector<std::size_t>  starts = {0};
    std::vector<unsigned int> columns;

    unsigned int
    n_rows() const
    {
      return static_cast<unsigned int>(starts.size()) - 1;
    }

    std::size_t
    n_entries_of_block() const
    {
      return std::size_t(height) * width;
    }

    /// Is to be called after the blocks of each row.
    void
    end_row()
    {
      starts.push_back(columns.size());
    }
  };



  /// A BlockPattern with the entries, block by block, and in these row by row.
  template <typename Number>
  struct BlockRows : BlockPattern
  {
    std::vector<Number> values;

    const Number *
    block(const std::size_t k) const
    {
      return values.data() + k * n_entries_of_block();
    }

    Number *
    block(const std::size_t k)
    {
      return values.data() + k * n_entries_of_block();
    }
  };



  /// Some rows of a matrix, by their numbers.
  struct NumberedRows : BlockRows<double>
  {
    std::vector<unsigned int> rows;

    template <typename Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &rows &height &width &starts &columns &values;
    }
  };



  /// Calls @p work with the sizes of a block as constants, those of nodes of
  /// dim unknowns and of aggregates with the rigid motions of a body.
  template <typename Work>
  void
  with_sizes(const unsigned int height, const unsigned int width, Work &&work)
  {
    using std::integral_constant;
    const auto are = [&](const auto h, const auto w) {
      const bool found = height == h && width == w;
      if (found)
        work(h, w);
      return found;
    };
    const integral_constant<unsigned int, 2> two;
    const integral_constant<unsigned int, 3> three;
    const integral_constant<unsigned int, 6> six;
    AssertThrow(are(two, two) || are(three, three) || are(two, three) ||
                  are(three, six) || are(six, six),
                dealii::ExcNotImplemented());
  }
} // namespace Debond

#endif
