// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/linear_algebra/galerkin_product.h>

#include <Eigen/Core>

#include <algorithm>
#include <limits>
#include <numeric>

namespace Debond
{
  namespace
  {
    constexpr unsigned int none = std::numeric_limits<unsigned int>::max();



    /// Numbers that are met, each once, in O(1) each.
    class NumberSet
    {
    public:
      explicit NumberSet(const unsigned int n)
        : places(n, none)
      {}

      void
      clear()
      {
        for (const unsigned int number : numbers)
          places[number] = none;
        numbers.clear();
      }

      /// Its place in the order in which they are met.
      unsigned int
      insert(const unsigned int number)
      {
        if (places[number] == none)
          {
            places[number] = static_cast<unsigned int>(numbers.size());
            numbers.push_back(number);
          }
        return places[number];
      }

      std::vector<unsigned int> numbers;

    private:
      std::vector<unsigned int> places;
    };



    /// The rows and columns of P'MP, counted first.
    NumberedRows
    product_pattern(const std::vector<unsigned int> &rows,
                    const BlockPattern              &M,
                    const BlockPattern              &P,
                    const unsigned int               n_columns)
    {
      // Row c of P'MP has a column wherever a row r of M with P(r, c) != 0 has
      // one and P a column there. So P is transposed first, restricted to the
      // given rows: "adding" has the rows r of each c, sorted by counting. The
      // columns of c are then the union over these rows. With the whole pattern
      // known before any value, the values get one allocation of their final
      // size.
      std::vector<std::size_t> starts(n_columns + 1, 0);
      const auto               for_all = [&](const auto &work) {
        for (unsigned int r = 0; r < rows.size(); ++r)
          for (auto k = P.starts[rows[r]]; k < P.starts[rows[r] + 1]; ++k)
            work(P.columns[k], r);
      };
      for_all(
        [&](const unsigned int c, const unsigned int) { ++starts[c + 1]; });
      std::partial_sum(starts.begin(), starts.end(), starts.begin());
      std::vector<unsigned int> adding(starts.back());
      std::vector<std::size_t>  next(starts.begin(), starts.end() - 1);
      for_all([&](const unsigned int c, const unsigned int r) {
        adding[next[c]++] = r;
      });

      NumberedRows result;
      result.height = result.width = P.width;
      NumberSet found(n_columns);
      for (unsigned int c = 0; c < n_columns; ++c)
        {
          if (starts[c] == starts[c + 1])
            continue;
          found.clear();
          for (std::size_t a = starts[c]; a < starts[c + 1]; ++a)
            for (auto k = M.starts[adding[a]]; k < M.starts[adding[a] + 1]; ++k)
              for (auto l = P.starts[M.columns[k]];
                   l < P.starts[M.columns[k] + 1];
                   ++l)
                found.insert(P.columns[l]);
          std::vector<unsigned int> sorted = found.numbers;
          std::sort(sorted.begin(), sorted.end());
          result.columns.insert(result.columns.end(),
                                sorted.begin(),
                                sorted.end());
          result.rows.push_back(c);
          result.end_row();
        }
      return result;
    }



    /// A block of constant size, for which Eigen makes products without loops.
    template <typename Number, int n, int m>
    using Block = Eigen::Matrix<Number, n, m, Eigen::RowMajor>;
  } // namespace



  NumberedRows
  galerkin_product(const std::vector<unsigned int>                   &rows,
                   const BlockPattern                                &pattern,
                   const std::function<const double *(unsigned int)> &blocks,
                   const BlockRows<float>                            &P,
                   const unsigned int                                 n_columns)
  {
    // Row by row of M: first the row of MP, then P(r, c)'(MP)(r, :) is added to
    // row c of the product for each column c that P has in row r. M is read
    // once, one row at a time, so that its rows need not exist all at once, and
    // no transpose of P with values is needed. Sums are in double precision;
    // only P is in single precision.
    NumberedRows C = product_pattern(rows, pattern, P, n_columns);
    C.values.assign(C.columns.size() * C.n_entries_of_block(), 0.);
    std::vector<unsigned int> row_of(n_columns);
    for (unsigned int i = 0; i < C.rows.size(); ++i)
      row_of[C.rows[i]] = i;

    using Eigen::Map;
    with_sizes(P.height, P.width, [&](const auto fine, const auto coarse) {
      constexpr int n = decltype(fine)::value, m = decltype(coarse)::value;
      NumberSet     found(n_columns);
      std::vector<double> MP; // of a row
      for (unsigned int r = 0; r < rows.size(); ++r)
        {
          const std::size_t begin = P.starts[rows[r]],
                            end   = P.starts[rows[r] + 1];
          if (begin == end)
            continue;
          // The blocks of the row of MP stand in the order in which their
          // columns are met.
          found.clear();
          MP.clear();
          const double *block = blocks(r);
          for (auto k = pattern.starts[r]; k < pattern.starts[r + 1];
               ++k, block += n * n)
            for (auto l = P.starts[pattern.columns[k]];
                 l < P.starts[pattern.columns[k] + 1];
                 ++l)
              {
                // A place that is new is the next one behind the blocks so far.
                const std::size_t place = found.insert(P.columns[l]);
                if (place * n * m == MP.size())
                  MP.resize(MP.size() + n * m, 0.);
                Map<Block<double, n, m>>(MP.data() + place * n * m).noalias() +=
                  Map<const Block<double, n, n>>(block) *
                  Map<const Block<float, n, m>>(P.block(l))
                    .template cast<double>();
              }
          for (std::size_t l = begin; l < end; ++l)
            {
              // Columns of a row of C ascend, so that a place is found by
              // bisection.
              const unsigned int i     = row_of[P.columns[l]];
              const auto         first = C.columns.begin() + C.starts[i];
              const auto         last  = C.columns.begin() + C.starts[i + 1];
              for (std::size_t place = 0; place < found.numbers.size(); ++place)
                {
                  const auto k =
                    std::lower_bound(first, last, found.numbers[place]);
                  Map<Block<double, m, m>>(C.block(k - C.columns.begin()))
                    .noalias() +=
                    Map<const Block<float, n, m>>(P.block(l))
                      .transpose()
                      .template cast<double>() *
                    Map<const Block<double, n, m>>(MP.data() + place * n * m);
                }
            }
        }
    });
    return C;
  }
} // namespace Debond
