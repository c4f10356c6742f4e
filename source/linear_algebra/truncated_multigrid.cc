// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/linear_algebra/galerkin_product.h>
#include <debond/linear_algebra/truncated_multigrid.h>

#include <numeric>
#include <utility>

namespace Debond
{
  namespace
  {
    /// Where the column of the prolongation is empty the diagonal becomes 1.
    void
    make_positive(NumberedRows &M)
    {
      for (unsigned int r = 0; r < M.n_rows(); ++r)
        for (auto k = M.starts[r]; k < M.starts[r + 1]; ++k)
          for (unsigned int c = 0; M.columns[k] == M.rows[r] && c < M.width;
               ++c)
            if (double &entry = M.block(k)[c * (M.width + 1)]; entry <= 0.)
              entry = 1.;
    }
  } // namespace



  TruncatedMultigrid::FinestMatrix::FinestMatrix(const DistributedMatrix &A)
    : A(A)
    , free_values(A.own_rows, A.ranks)
  {}



  void
  TruncatedMultigrid::FinestMatrix::vmult(DistributedVector       &dst,
                                          const DistributedVector &src) const
  {
    free_values.copy_locally_owned_data_from(src);
    for (const unsigned int i : held)
      free_values(i) = 0.;
    const std::vector<double> &values = A.at_columns(free_values);
    A.multiply(dst, values);
    for (const Entry &entry : E)
      dst(entry.row) += entry.value * values[entry.column];
    for (const unsigned int i : held)
      dst(i) = A.A.diag_element(i) * src(i);
  }



  TruncatedMultigrid::TruncatedMultigrid(
    const DistributedMatrix         &A,
    const unsigned int               n_components,
    const std::vector<Prolongation> &prolongations)
    : n_components(n_components)
    , finest(A)
  {
    add_finest();
    // All own rows of the coarsest level so far.
    NumberedRows rows;
    for (const Prolongation &P : prolongations)
      rows = add_level(P, rows);
    if (prolongations.empty())
      rows = finest_rows();
    coarsest =
      std::make_unique<CoarsestFactor>(rows, !prolongations.empty(), A.ranks);
    coarsest->factorise({});
    make_smoothers(/*is_new=*/true);
  }



  void
  TruncatedMultigrid::add_finest()
  {
    const DistributedMatrix  &A = finest.A;
    const unsigned int        n = n_components;
    SharedNodes               nodes(A.own_rows.n_elements() / n, n, A.ranks);
    BlockRows<float>          rows;
    std::vector<unsigned int> columns;
    const auto               &sparsity = A.A.get_sparsity_pattern();
    rows.height = rows.width = n;
    with_sizes(n, n, [&](const auto size, const auto) {
      constexpr unsigned int n_rows = decltype(size)::value;
      for (unsigned int i = 0; i < nodes.n_own(); ++i)
        {
          // Those of the longest row: others are constrained.
          const unsigned int first = nodes.global(i) * n_rows;
          unsigned int       row   = first;
          for (unsigned int c = 1; c < n_rows; ++c)
            if (sparsity.row_length(first + c) > sparsity.row_length(row))
              row = first + c;
          columns.assign(1, nodes.global(i));
          const auto last = A.A.end(row);
          for (auto entry = A.A.begin(row); entry != last; ++entry)
            if (const unsigned int column = entry->column() / n_rows;
                columns.back() != column)
              columns.push_back(column);
          std::sort(columns.begin(), columns.end());
          rows.columns.insert(rows.columns.end(),
                              columns.begin(),
                              std::unique(columns.begin(), columns.end()));
          rows.end_row();
        }
    });
    nodes.set_ghosts(rows.columns);
    for (unsigned int &column : rows.columns)
      column = nodes.local(column);
    levels.push_back(std::make_unique<MultigridLevel>(nodes));
    rows.values.reserve(rows.columns.size() * n * n);
    places.resize(nodes.n_local());
    for (unsigned int i = 0; i < nodes.n_own(); ++i)
      {
        const double *const blocks = finest_blocks(rows, i);
        rows.values.insert(rows.values.end(),
                           blocks,
                           blocks +
                             n * n * (rows.starts[i + 1] - rows.starts[i]));
      }
    levels.back()->set_matrix(std::move(rows));
    free = levels.back()->nodes.vector();
    free = 1.f;
  }



  const double *
  TruncatedMultigrid::finest_blocks(const BlockPattern &pattern,
                                    const unsigned int  node) const
  {
    const dealii::SparseMatrix<double> &A     = finest.A.A;
    const SharedNodes                  &nodes = levels.front()->nodes;
    const std::size_t                   begin = pattern.starts[node];
    const std::size_t                   end   = pattern.starts[node + 1];
    for (std::size_t k = begin; k < end; ++k)
      places[pattern.columns[k]] = static_cast<unsigned int>(k - begin);
    row_of_A.assign((end - begin) * pattern.n_entries_of_block(), 0.);
    // Quotients by constants take no division.
    with_sizes(n_components, n_components, [&](const auto size, const auto) {
      constexpr unsigned int n     = decltype(size)::value;
      const unsigned int     first = nodes.global(node) * n;
      for (unsigned int c = 0; c < n; ++c)
        {
          const auto last = A.end(first + c);
          for (auto entry = A.begin(first + c); entry != last; ++entry)
            {
              const unsigned int column = entry->column();
              row_of_A[(places[nodes.local(column / n)] * n + c) * n +
                       column % n]      = entry->value();
            }
        }
    });
    return row_of_A.data();
  }



  NumberedRows
  TruncatedMultigrid::finest_rows() const
  {
    NumberedRows result;
    static_cast<BlockPattern &>(result) = levels.front()->matrix;
    for (unsigned int i = 0; i < result.n_rows(); ++i)
      {
        const double *const blocks = finest_blocks(result, i);
        result.rows.push_back(i);
        result.values.insert(result.values.end(),
                             blocks,
                             blocks +
                               result.n_entries_of_block() *
                                 (result.starts[i + 1] - result.starts[i]));
      }
    levels.front()->nodes.to_global(result);
    return result;
  }



  NumberedRows
  TruncatedMultigrid::add_level(const Prolongation &given,
                                const NumberedRows &fine_rows)
  {
    MultigridLevel   &fine = *levels.back();
    BlockRows<float> &P    = fine.prolongation;
    SharedNodes nodes(given.n_own_columns, given.rows.width, fine.nodes.ranks);
    P = given.rows;
    fine.nodes.append_rows_of_ghosts(P);
    std::vector<unsigned int> all(fine.nodes.n_own());
    std::iota(all.begin(), all.end(), 0U);
    NumberedRows coarse_rows =
      nodes.sum_of_ranks(galerkin_product(
                           all,
                           fine.matrix,
                           [&](const unsigned int row) {
                             return levels.size() == 1 ?
                                      finest_blocks(fine.matrix, row) :
                                      fine_rows.block(fine_rows.starts[row]);
                           },
                           P,
                           nodes.n_global()),
                         true);
    make_positive(coarse_rows);

    std::vector<unsigned int> needed = coarse_rows.columns;
    needed.insert(needed.end(), P.columns.begin(), P.columns.end());
    nodes.set_ghosts(needed);
    levels.push_back(std::make_unique<MultigridLevel>(nodes));
    for (unsigned int &column : P.columns)
      column = nodes.local(column);
    NumberedRows local_rows = coarse_rows;
    nodes.to_local(local_rows);
    levels.back()->set_matrix(local_rows);
    return coarse_rows;
  }



  void
  TruncatedMultigrid::truncate(const std::vector<Entry>        &E,
                               const std::vector<unsigned int> &held)
  {
    finest.E    = E;
    finest.held = held;
    free        = 1.f;
    for (const unsigned int i : held)
      free(i) = 0.f;
    NumberedRows change = finest_change();
    for (unsigned int l = 0; l < levels.size(); ++l)
      {
        const MultigridLevel &level = *levels[l];
        levels[l]->set_change(change);
        if (l + 1 == levels.size())
          {
            level.nodes.to_global(change);
            coarsest->factorise(change);
            break;
          }
        const SharedNodes &nodes = levels[l + 1]->nodes;
        NumberedRows       next  = galerkin_product(
          change.rows,
          change,
          [&](const unsigned int r) { return change.block(change.starts[r]); },
          level.prolongation,
          nodes.n_local());
        nodes.to_global(next);
        change = nodes.sum_of_ranks(next, false);
        nodes.to_local(change);
      }
    make_smoothers(/*is_new=*/false);
  }



  NumberedRows
  TruncatedMultigrid::finest_change() const
  {
    const SharedNodes  &nodes   = levels.front()->nodes;
    const BlockPattern &pattern = levels.front()->matrix;
    const unsigned int  n       = n_components;
    std::vector<Entry>  E       = finest.E;
    std::sort(E.begin(), E.end(), [](const Entry &a, const Entry &b) {
      return a.row < b.row;
    });
    auto entry = E.begin();
    free.update_ghost_values();
    std::vector<bool> is_held(nodes.n_local()); // any of its unknowns
    for (unsigned int i = 0; i < nodes.n_local() * n; ++i)
      if (free.begin()[i] == 0.f)
        is_held[i / n] = true;

    NumberedRows change;
    change.height = change.width = n;
    for (unsigned int i = 0; i < nodes.n_own(); ++i)
      {
        const auto begin = pattern.columns.begin() + pattern.starts[i];
        const auto end   = pattern.columns.begin() + pattern.starts[i + 1];
        const unsigned int next_row = (nodes.global(i) + 1) * n;
        const auto         first    = entry;
        while (entry != E.end() && entry->row < next_row)
          ++entry;
        if (first == entry &&
            std::none_of(begin, end, [&](const unsigned int j) {
              return is_held[j];
            }))
          continue;
        const double *const A = finest_blocks(pattern, i);
        std::vector<double> blocks(A, A + n * n * (end - begin));
        for (auto e = first; e != entry; ++e)
          {
            const auto column =
              std::find_if(begin, end, [&](const unsigned int j) {
                return nodes.global(j) == e->column / n;
              });
            AssertThrow(column != end,
                        dealii::ExcMessage("an entry of E is not in A"));
            blocks[((column - begin) * n + e->row % n) * n + e->column % n] +=
              e->value;
          }
        for (auto column = begin; column != end; ++column)
          for (unsigned int k = 0; k < n * n; ++k)
            {
              double &value = blocks[(column - begin) * n * n + k];
              value *=
                free.begin()[i * n + k / n] * free.begin()[*column * n + k % n];
              value -= A[(column - begin) * n * n + k];
            }
        change.rows.push_back(i);
        change.columns.insert(change.columns.end(), begin, end);
        change.values.insert(change.values.end(), blocks.begin(), blocks.end());
        change.end_row();
      }
    free.zero_out_ghost_values();
    return change;
  }



  void
  TruncatedMultigrid::make_smoothers(const bool is_new)
  {
    for (unsigned int l = 0; l + 1 < levels.size(); ++l)
      {
        // Truncation leaves the modes of an aggregate dependent where it has
        // few free unknowns, which makes the largest eigenvalue larger, but
        // not where nodes have displacements.
        MultigridLevel &level = *levels[l];
        level.make_smoother(is_new || level.matrix.width > n_components);
      }
  }



  void
  TruncatedMultigrid::vmult(DistributedVector       &z,
                            const DistributedVector &r) const
  {
    // Single precision has its range in any unit.
    const MultigridLevel &level = *levels.front();
    const double          size  = r.linfty_norm();
    const double scale = size > 0. ? std::ldexp(1., -std::ilogb(size)) : 1.;
    for (unsigned int i = 0; i < level.b.locally_owned_size(); ++i)
      level.b.local_element(i) =
        static_cast<float>(scale * r.local_element(i)) * free.local_element(i);
    cycle(0);
    for (unsigned int i = 0; i < level.x.locally_owned_size(); ++i)
      z.local_element(i) = level.x.local_element(i) / scale;
  }



  void
  TruncatedMultigrid::cycle(const unsigned int l) const
  {
    const MultigridLevel &fine = *levels[l];
    if (l + 1 == levels.size())
      {
        coarsest->solve(fine.x, fine.b);
        return;
      }
    fine.smoother.vmult(fine.x, fine.b);
    fine.matrix.vmult(fine.r, fine.x);
    fine.r.sadd(-1.f, 1.f, fine.b);
    // b, x and r are zero at held unknowns, so only corrections may not be.
    const MultigridLevel &coarse = *levels[l + 1];
    fine.restrict_to_coarser(coarse.b, fine.r);
    cycle(l + 1);
    fine.prolongate(fine.r, coarse.x);
    if (l == 0)
      fine.r.scale(free);
    fine.x += fine.r;
    fine.smoother.step(fine.x, fine.b);
  }
} // namespace Debond
