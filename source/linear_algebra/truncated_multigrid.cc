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
      // An empty column of P leaves a row and a column of P'AP that are zero,
      // and a zero in each restricted force. With 1 on its diagonal the unknown
      // stands alone and stays zero. Smoothers see D^{-1} M only, so that the
      // size of this entry does not count beside those in units of stiffness.
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
    // Q from the right, then A + E on all unknowns, and Q + D (I - Q) from the
    // left. The entries of E are in the pattern of A, so that at_columns() has
    // fetched from other ranks all values that they need. The diagonal entry of
    // A keeps the held rows in the unit of the others.
    free_values.copy_locally_owned_data_from(src);
    for (const unsigned int i : held)
      free_values(i) = 0.;
    const std::vector<double> &values = A.at_columns(free_values);
    A.multiply(dst, values);
    for (const Entry &entry : E)
      dst(entry.row) += entry.value * values[entry.column];
    // Ranks give the held unknowns in their own rows. The ghosts of the mask
    // are fetched where it is needed.
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
    // From the finest level down, each coarser matrix is the Galerkin product
    // P'MP of the one before. Products and the coarsest factor are in double
    // precision; what the levels keep is in single precision. So only the rows
    // of one level at a time take memory in double precision, and none of the
    // finest, whose rows come from A itself.
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
    // The pattern of the blocks comes from that of A. The ghosts of the level
    // are the nodes of other ranks in the columns of own rows; with them known,
    // columns can be numbered locally and the values be copied, block by block.
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
          // The columns are those of the longest of the node's rows, since a
          // constrained row has only its diagonal entry. deal.II stores the
          // diagonal entry of a row first, and unknowns of a node follow each
          // other, so that nodes are met in runs and nearly sorted.
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
    // In single precision already: `rows` has floats, and only one row at a
    // time is in double precision.
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
    // The places of the row's blocks by local numbers of their nodes are looked
    // up in an array as long as there are local nodes. What earlier rows have
    // written there does no harm, as A has no entry outside of the row's own
    // pattern.
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
    // Without prolongations the finest level is also the coarsest one, and A is
    // factorised as it is.
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
    // The rows of P'AP that own rows of A contribute to are computed here, with
    // the rows of P at own nodes and ghosts; those of coarse nodes of other
    // ranks are sent to their owners, which add up what they get. Numbers of
    // coarse nodes are those of the whole until all of them are known that this
    // rank needs: the columns of its coarse rows, for products with the coarse
    // matrix, and the columns of P, for prolongations and for changes by
    // truncation.
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

    // Now that the rows of coarse nodes are known, so are all coarse nodes that
    // this rank has to do with, and the level can be numbered.
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
    // Let M = Q (A + E) Q + D (I - Q). The truncated hierarchy is that of the
    // Galerkin products of M with Q P in place of the finest P: a basis
    // function of a coarse level is zero at the held unknowns, so that coarse
    // corrections leave these where they are. As P'Q M Q P = P'AP + P'[Q (A +
    // E) Q - A]P, a coarser matrix remains the Galerkin product of the finer
    // one if the bracket is multiplied level by level. It has entries only at
    // the nodes of E and next to held ones, on the contact boundary; its rows
    // become fewer on each level, and the patterns of the levels hold it. Since
    // the product is formed from A anew each time, repeated changes of the
    // contact set accumulate no rounding.
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
        // Columns of P are local numbers of the coarser level; rows that other
        // ranks own are added up there. Rows that no change reaches are left
        // out.
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
    // E is sorted by rows, so that one pass over the own nodes meets its
    // entries in their order. A node has a change if E has an entry in one of
    // its rows, or if one of the nodes in its columns, itself among them, is
    // held. Held nodes of other ranks count, too, which takes the ghosts of the
    // mask.
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
        // The blocks are those of A + E, then masked by Q from both sides, less
        // those of A. On the diagonal of a held unknown -a_ii remains, and
        // changed() makes the entry of the level a_ii again, which is D (I -
        // Q).
        const double *const A = finest_blocks(pattern, i);
        std::vector<double> blocks(A, A + n * n * (end - begin));
        for (auto e = first; e != entry; ++e)
          {
            // An entry of E outside of the pattern of A would need values that
            // are not fetched, and a place that the coarser levels do not have.
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
    // Forces of any unit are brought near 1, where single precision has its
    // range, by a power of two, which costs no rounding; the cycle is linear in
    // r. Forces at held unknowns are set to zero, so that the result is zero
    // there and does not depend on them.
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
    // One V-cycle from x = 0: a Chebyshev polynomial in D^{-1}M, the correction
    // from the coarser level, and the same polynomial once more. Its error
    // operator is self-adjoint in the energy of M, so that smoothing before and
    // after with the same polynomial makes the cycle symmetric.
    const MultigridLevel &fine = *levels[l];
    if (l + 1 == levels.size())
      {
        coarsest->solve(fine.x, fine.b);
        return;
      }
    fine.smoother.vmult(fine.x, fine.b);
    fine.matrix.vmult(fine.r, fine.x);
    fine.r.sadd(-1.f, 1.f, fine.b);
    // The prolongation of level 0 is Q P, but P is stored without Q. b, x and r
    // are zero at held unknowns, as the rows of these have nothing but their
    // diagonal, so that P'r is (Q P)'r; only the correction P x has to be
    // masked.
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
