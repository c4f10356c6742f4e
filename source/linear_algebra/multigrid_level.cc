// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/linear_algebra/multigrid_level.h>

#include <algorithm>

namespace Debond
{
  namespace
  {
    /// y += M x, or M'x, for own rows and local columns.
    template <bool transposed>
    void
    add_product(const BlockRows<float> &M,
                const unsigned int      n_rows,
                const float            *x,
                float                  *y)
    {
      // The sizes of the blocks are constants of the loops, which are unrolled.
      // M'x goes by rows of M, too, and adds to y wherever the row has a
      // column, in ghosts as well: these parts belong to other ranks.
      with_sizes(M.height, M.width, [&](const auto height, const auto width) {
        constexpr unsigned int h = decltype(height)::value,
                               w = decltype(width)::value;
        const float *block       = M.values.data();
        for (unsigned int i = 0; i < n_rows; ++i)
          {
            float row[h] = {};
            if (transposed)
              std::copy_n(x + std::size_t(i) * h, h, row);
            for (auto k = M.starts[i]; k < M.starts[i + 1]; ++k, block += h * w)
              {
                const std::size_t j = std::size_t(M.columns[k]) * w;
                if (transposed)
                  {
                    for (unsigned int c = 0; c < h; ++c)
                      for (unsigned int d = 0; d < w; ++d)
                        y[j + d] += block[c * w + d] * row[c];
                    continue;
                  }
                // The sum of a block need not wait for those before it.
                for (unsigned int c = 0; c < h; ++c)
                  {
                    float sum = block[c * w] * x[j];
                    for (unsigned int d = 1; d < w; ++d)
                      sum += block[c * w + d] * x[j + d];
                    row[c] += sum;
                  }
              }
            if (!transposed)
              for (unsigned int c = 0; c < h; ++c)
                y[std::size_t(i) * h + c] += row[c];
          }
      });
    }
  } // namespace



  void
  LevelMatrix::vmult(SinglePrecisionVector       &dst,
                     const SinglePrecisionVector &src) const
  {
    // The ghosts of src are set for the product alone: a deal.II vector that
    // holds ghost values cannot be compressed.
    src.update_ghost_values();
    dst = 0.f;
    add_product<false>(*this, n_rows(), src.begin(), dst.begin());
    src.zero_out_ghost_values();
  }



  void
  MultigridLevel::reinit()
  {
    // The vectors have the ghosts of the level. The polynomial is one in
    // D^{-1}M, with the inverse diagonal kept as floats.
    for (auto *v : {&x, &b, &r})
      *v = nodes.vector();
    matrix.n_unknowns = x.size();
    inverse_diagonal =
      std::make_shared<dealii::DiagonalMatrix<SinglePrecisionVector>>(x);
    for (unsigned int row = 0; row < matrix.n_rows(); ++row)
      invert_diagonal(row);
  }



  void
  MultigridLevel::set_change(const NumberedRows &change)
  {
    // First the rows of the last change get back what was stored of them, bit
    // by bit, so that a sequence of changes leaves no rounding behind; then the
    // rows of the new one are stored and changed. This costs as much as there
    // are changed rows, and memory for these alone.
    auto saved = unchanged.begin();
    for (const unsigned int row : changed_rows)
      {
        const std::size_t n = matrix.n_entries_of_block() *
                              (matrix.starts[row + 1] - matrix.starts[row]);
        std::copy_n(saved, n, matrix.block(matrix.starts[row]));
        saved += n;
        invert_diagonal(row);
      }
    changed_rows = change.rows;
    unchanged.clear();
    const unsigned int n = matrix.width;
    for (unsigned int r = 0; r < change.n_rows(); ++r)
      {
        const unsigned int row   = change.rows[r];
        const std::size_t  begin = matrix.starts[row],
                          end    = matrix.starts[row + 1];
        unchanged.insert(unchanged.end(),
                         matrix.block(begin),
                         matrix.block(end));
        for (auto k = change.starts[r]; k < change.starts[r + 1]; ++k)
          {
            // Entries that cancel but for rounding become zero, and a diagonal
            // of which nothing remains keeps its value. The sum is formed in
            // double precision from an entry in single precision, which is why
            // what counts as rounding is that of floats.
            const unsigned int column = change.columns[k];
            float *const       block =
              matrix.block(std::find(matrix.columns.begin() + begin,
                                     matrix.columns.begin() + end,
                                     column) -
                           matrix.columns.begin());
            for (unsigned int e = 0; e < n * n; ++e)
              block[e] = changed(block[e],
                                 change.block(k)[e],
                                 column == row && e % (n + 1) == 0);
          }
        invert_diagonal(row);
      }
  }



  void
  MultigridLevel::invert_diagonal(const unsigned int row)
  {
    const unsigned int n = matrix.width;
    for (auto k = matrix.starts[row]; k < matrix.starts[row + 1]; ++k)
      for (unsigned int c = 0; matrix.columns[k] == row && c < n; ++c)
        inverse_diagonal->get_vector().local_element(row * n + c) =
          1.f / matrix.block(k)[c * (n + 1)];
  }



  void
  MultigridLevel::make_smoother(const bool estimate)
  {
    // The polynomial is small on [lambda/20, lambda], where lambda is the
    // largest eigenvalue of D^{-1}M; coarser levels reduce what lies below. Ten
    // steps of conjugate gradients estimate it, and deal.II adds a fifth, as
    // they find it from below: the polynomial grows fast beyond lambda. With
    // zero steps deal.II takes the number given, here the last estimate with
    // its fifth.
    typename decltype(smoother)::AdditionalData parameters;
    parameters.preconditioner      = inverse_diagonal;
    parameters.degree              = 2;
    parameters.smoothing_range     = 20.;
    parameters.eig_cg_n_iterations = estimate ? 10 : 0;
    parameters.max_eigenvalue      = largest_eigenvalue;
    smoother.initialize(matrix, parameters);
    largest_eigenvalue =
      smoother.estimate_eigenvalues(b).max_eigenvalue_estimate;
  }



  void
  MultigridLevel::prolongate(SinglePrecisionVector       &fine,
                             const SinglePrecisionVector &coarse) const
  {
    // Own rows of P have columns at coarse nodes of other ranks, whose values
    // the ghosts bring.
    coarse.update_ghost_values();
    fine = 0.f;
    add_product<false>(prolongation,
                       nodes.n_own(),
                       coarse.begin(),
                       fine.begin());
    coarse.zero_out_ghost_values();
  }



  void
  MultigridLevel::restrict_to_coarser(SinglePrecisionVector       &coarse,
                                      const SinglePrecisionVector &fine) const
  {
    // Products with own rows of P give parts of coarse rows on other ranks.
    // They are in the ghosts, and compress() sends them to their owners and
    // adds them up there.
    coarse = 0.f;
    add_product<true>(prolongation,
                      nodes.n_own(),
                      fine.begin(),
                      coarse.begin());
    coarse.compress(dealii::VectorOperation::add);
  }
} // namespace Debond
