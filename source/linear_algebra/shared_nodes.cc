// SPDX-License-Identifier: LGPL-2.1-or-later

#include <debond/base/ranks.h>
#include <debond/linear_algebra/shared_nodes.h>

#include <tuple>

namespace Debond
{
  namespace
  {
    /// Puts a row behind those that @p to has.
    template <typename To, typename From>
    void
    append_row(To &to, const From &from, const unsigned int row)
    {
      const auto begin = from.starts[row], end = from.starts[row + 1];
      to.columns.insert(to.columns.end(),
                        from.columns.begin() + begin,
                        from.columns.begin() + end);
      to.values.insert(to.values.end(), from.block(begin), from.block(end));
      to.end_row();
    }
  } // namespace



  SharedNodes::SharedNodes(const unsigned int n_own,
                           const unsigned int n_unknowns_of_node,
                           const MPI_Comm     ranks)
    : ranks(ranks)
    , n_unknowns_of_node(n_unknowns_of_node)
    , firsts(1, 0)
  {
    // Own nodes of the ranks follow each other, so that one number a rank says
    // which rank owns a node, without further messages.
    for (const unsigned int n :
         dealii::Utilities::MPI::all_gather(ranks, n_own))
      firsts.push_back(firsts.back() + n);
    begin = firsts[rank_of_this(ranks)];
    end   = begin + n_own;
  }



  void
  SharedNodes::set_ghosts(const std::vector<unsigned int> &nodes)
  {
    for (const unsigned int node : nodes)
      if (node < begin || node >= end)
        ghosts.push_back(node);
    std::sort(ghosts.begin(), ghosts.end());
    ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());

    // deal.II's partitioner orders ghosts by their numbers in the whole, as it
    // is done here, so that the local numbers of a node's unknowns in vectors
    // are those of the node times the number of unknowns.
    const unsigned int n = n_unknowns_of_node;
    dealii::IndexSet   own(n_global() * n), others(n_global() * n);
    own.add_range(begin * n, end * n);
    for (const unsigned int node : ghosts)
      others.add_range(node * n, (node + 1) * n);
    partitioner =
      std::make_shared<dealii::Utilities::MPI::Partitioner>(own, others, ranks);
  }



  unsigned int
  SharedNodes::local(const unsigned int global) const
  {
    if (global >= begin && global < end)
      return global - begin;
    const auto ghost = std::lower_bound(ghosts.begin(), ghosts.end(), global);
    Assert(ghost != ghosts.end() && *ghost == global,
           dealii::ExcInternalError());
    return n_own() + static_cast<unsigned int>(ghost - ghosts.begin());
  }



  void
  SharedNodes::to_local(NumberedRows &M) const
  {
    for (auto *const numbers : {&M.rows, &M.columns})
      for (unsigned int &number : *numbers)
        number = local(number);
  }



  void
  SharedNodes::to_global(NumberedRows &M) const
  {
    for (auto *const numbers : {&M.rows, &M.columns})
      for (unsigned int &number : *numbers)
        number = global(number);
  }



  SinglePrecisionVector
  SharedNodes::vector() const
  {
    return SinglePrecisionVector(partitioner);
  }



  void
  SharedNodes::append_rows_of_ghosts(BlockRows<float> &rows) const
  {
    // Two exchanges: each rank tells the owners which rows it needs, and gets
    // them. A rank knows whom it asks, but not who asks it, which
    // some_to_some() finds out. Rows are asked for in ascending order, and
    // answers keep it.
    using dealii::Utilities::MPI::some_to_some;
    std::map<unsigned int, std::vector<unsigned int>> wanted;
    for (const unsigned int node : ghosts)
      wanted[owner(node)].push_back(node);
    std::map<unsigned int, NumberedRows> given;
    for (const auto &[rank, nodes] : some_to_some(ranks, wanted))
      for (const unsigned int node : nodes)
        {
          NumberedRows &of_rank = given[rank];
          of_rank.height        = rows.height;
          of_rank.width         = rows.width;
          append_row(of_rank, rows, node - begin);
        }
    // Ghosts are in the order of their owners.
    for (const auto &[rank, of_rank] : some_to_some(ranks, given))
      for (unsigned int row = 0; row < of_rank.n_rows(); ++row)
        append_row(rows, of_rank, row);
  }



  NumberedRows
  SharedNodes::sum_of_ranks(const NumberedRows &rows, const bool with_all) const
  {
    // First what others have to sum up.
    std::map<unsigned int, NumberedRows> parts;
    for (unsigned int r = 0; r < rows.n_rows(); ++r)
      if (const unsigned int node = rows.rows[r]; node < begin || node >= end)
        {
          NumberedRows &part = parts[owner(node)];
          part.height = part.width = rows.width;
          part.rows.push_back(node);
          append_row(part, rows, r);
        }
    parts = dealii::Utilities::MPI::some_to_some(ranks, parts);

    // Then all summands of own blocks, by pointers, are sorted by row and
    // column, and neighbours with the same place are added up. A row that is to
    // exist although no rank has anything for it gets a zero on its diagonal.
    struct Summand
    {
      unsigned int  row, column;
      const double *block;
    };
    const std::size_t         n = rows.n_entries_of_block();
    const std::vector<double> zero(n, 0.);
    std::vector<bool>         is_found(n_own(), !with_all);
    std::vector<Summand>      summands;
    const auto                add = [&](const NumberedRows &part) {
      for (unsigned int r = 0; r < part.n_rows(); ++r)
        if (const unsigned int node = part.rows[r]; node >= begin && node < end)
          {
            is_found[node - begin] = true;
            for (auto k = part.starts[r]; k < part.starts[r + 1]; ++k)
              summands.push_back({node, part.columns[k], part.block(k)});
          }
    };
    add(rows);
    for (const auto &[rank, part] : parts)
      add(part);
    for (unsigned int i = 0; i < n_own(); ++i)
      if (!is_found[i])
        summands.push_back({begin + i, begin + i, zero.data()});
    // The sort is stable, and summands of one place stay in the order in which
    // they have been added: this rank's own first, then those of others by
    // rank. So sums do not depend on which message comes first. What comes from
    // one rank alone is sorted already.
    const auto is_before = [](const Summand &a, const Summand &b) {
      return std::tie(a.row, a.column) < std::tie(b.row, b.column);
    };
    if (!std::is_sorted(summands.begin(), summands.end(), is_before))
      std::stable_sort(summands.begin(), summands.end(), is_before);

    // One pass over the sorted summands: another row ends the one before, and a
    // summand with the place of the last one is added to it.
    NumberedRows result;
    result.height = result.width = rows.width;
    result.columns.reserve(summands.size());
    result.values.reserve(summands.size() * n);
    for (const Summand &summand : summands)
      {
        if (result.rows.empty() || result.rows.back() != summand.row)
          {
            if (!result.rows.empty())
              result.end_row();
            result.rows.push_back(summand.row);
          }
        else if (result.columns.back() == summand.column)
          {
            std::transform(summand.block,
                           summand.block + n,
                           result.values.end() - n,
                           result.values.end() - n,
                           std::plus<>());
            continue;
          }
        result.columns.push_back(summand.column);
        result.values.insert(result.values.end(),
                             summand.block,
                             summand.block + n);
      }
    if (!result.rows.empty())
      result.end_row();
    return result;
  }



  unsigned int
  SharedNodes::owner(const unsigned int global) const
  {
    return static_cast<unsigned int>(
      std::upper_bound(firsts.begin(), firsts.end(), global) - firsts.begin() -
      1);
  }
} // namespace Debond
