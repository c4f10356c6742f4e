// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_multigrid_block_matrix_h
#define debond_linear_algebra_multigrid_block_matrix_h

#include <deal.II/lac/sparse_matrix.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace Debond
{
  /// The entries of a block, row by row.
  template <int dim>
  using Block = std::array<double, std::size_t{dim} * dim>;



  /**
   * A sparse matrix of dim x dim blocks, by rows, each with its blocks in
   * ascending order of their columns: the unknown c of the node i is the
   * component dim i + c of vectors.
   */
  template <int dim, typename Number>
  class BlockMatrix
  {
  public:
    std::vector<std::size_t>  starts = {0}; ///< of rows, and the end
    std::vector<unsigned int> columns;
    std::vector<Number>       values;

    unsigned int
    n_rows() const
    {
      return static_cast<unsigned int>(starts.size()) - 1;
    }

    /// Where a row has the block of a column, columns.size() if nowhere.
    std::size_t
    find(const unsigned int row, const unsigned int column) const
    {
      const auto begin = columns.begin() + starts[row];
      const auto end   = columns.begin() + starts[row + 1];
      const auto found = std::lower_bound(begin, end, column);
      return found != end && *found == column ?
               static_cast<std::size_t>(found - columns.begin()) :
               columns.size();
    }

    void
    append(const unsigned int column, const Block<dim> &block)
    {
      columns.push_back(column);
      for (const double entry : block)
        values.push_back(static_cast<Number>(entry));
    }

    void
    end_row()
    {
      starts.push_back(columns.size());
    }

    /// The product of a row with x.
    std::array<Number, dim>
    times(const unsigned int row, const Number *const x) const
    {
      std::array<Number, dim> result = {};
      const Number           *value  = values.data() + starts[row] * dim * dim;
      for (std::size_t k = starts[row]; k < starts[row + 1]; ++k)
        {
          const Number *const xk =
            x + static_cast<std::size_t>(columns[k]) * dim;
          for (int c = 0; c < dim; ++c)
            for (int d = 0; d < dim; ++d)
              result[c] += *value++ * xk[d];
        }
      return result;
    }

    /// Calls @p visit with column and block of each entry of the row.
    template <typename Visitor>
    void
    visit_row(const unsigned int row, const Visitor &visit) const
    {
      Block<dim> block;
      for (std::size_t k = starts[row]; k < starts[row + 1]; ++k)
        {
          std::copy_n(values.begin() + k * dim * dim, dim * dim, block.begin());
          visit(columns[k], block);
        }
    }
  };



  /// Reads a matrix of single entries by blocks; keeps a reference.
  template <int dim>
  class BlockView
  {
  public:
    explicit BlockView(const dealii::SparseMatrix<double> &matrix)
      : matrix(matrix)
    {}

    unsigned int
    n_rows() const
    {
      return matrix.m() / dim;
    }

    /// As that of BlockMatrix.
    template <typename Visitor>
    void
    visit_row(const unsigned int row, const Visitor &visit) const
    {
      columns.clear();
      blocks.clear();
      for (int c = 0; c < dim; ++c)
        for (auto entry = matrix.begin(row * dim + c);
             entry != matrix.end(row * dim + c);
             ++entry)
          {
            const unsigned int column = entry->column() / dim;
            std::size_t        k      = 0;
            while (k < columns.size() && columns[k] != column)
              ++k;
            if (k == columns.size())
              {
                columns.push_back(column);
                blocks.push_back({});
              }
            blocks[k][c * dim + entry->column() % dim] = entry->value();
          }
      for (std::size_t k = 0; k < columns.size(); ++k)
        visit(columns[k], blocks[k]);
    }

  private:
    const dealii::SparseMatrix<double> &matrix;

    // Of one row; members to keep their memory.
    mutable std::vector<unsigned int> columns;
    mutable std::vector<Block<dim>>   blocks;
  };
} // namespace Debond

#endif
