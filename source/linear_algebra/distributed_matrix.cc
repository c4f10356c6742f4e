// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/linear_algebra/distributed_matrix.h>

namespace Debond
{
  DistributedMatrix::DistributedMatrix(const MatrixOnRanks &A)
    : MatrixOnRanks(A)
    , values(A.A.m())
  {
    // The columns of own rows that belong to other ranks are the ghosts of each
    // product. They are found once; a matrix of one rank has none.
    std::vector<dealii::types::global_dof_index> others;
    if (is_shared())
      for (const auto row : own_rows)
        for (auto entry = A.A.begin(row); entry != A.A.end(row); ++entry)
          if (!own_rows.is_element(entry->column()))
            others.push_back(entry->column());
    std::sort(others.begin(), others.end());
    dealii::IndexSet ghosts(A.A.m());
    ghosts.add_indices(others.begin(),
                       std::unique(others.begin(), others.end()));
    with_ghosts.reinit(own_rows, ghosts, ranks);
  }



  const std::vector<double> &
  DistributedMatrix::at_columns(const DistributedVector &v) const
  {
    // One exchange brings the ghosts. They are copied with the own values to an
    // array as long as the whole vector, since deal.II's matrix has columns by
    // their numbers in the whole: 8 bytes an unknown spare a translation for
    // each entry. Places that no own row looks at keep what they had.
    with_ghosts.copy_locally_owned_data_from(v);
    with_ghosts.update_ghost_values();
    const auto  &partitioner = *with_ghosts.get_partitioner();
    unsigned int i           = 0;
    for (const auto row : own_rows)
      values[row] = with_ghosts.local_element(i++);
    for (const auto column : partitioner.ghost_indices())
      values[column] = with_ghosts.local_element(i++);
    with_ghosts.zero_out_ghost_values();
    return values;
  }



  void
  DistributedMatrix::vmult(DistributedVector       &dst,
                           const DistributedVector &src) const
  {
    multiply(dst, at_columns(src));
  }



  double
  DistributedMatrix::product(const unsigned int         row,
                             const std::vector<double> &v) const
  {
    // With four sums an addition need not wait for the one before it. A row is
    // on one rank with all its columns, so that no sum goes over ranks.
    auto       entry = A.begin(row);
    const auto term  = [&entry, &v]() {
      const double value = entry->value() * v[entry->column()];
      ++entry;
      return value;
    };
    double       a = 0., b = 0., c = 0., d = 0.;
    unsigned int n = A.get_sparsity_pattern().row_length(row);
    for (; n >= 4; n -= 4)
      {
        a += term();
        b += term();
        c += term();
        d += term();
      }
    for (; n > 0; --n)
      a += term();
    return (a + b) + (c + d);
  }



  void
  DistributedMatrix::multiply(DistributedVector         &dst,
                              const std::vector<double> &v) const
  {
    unsigned int i = 0;
    for (const auto row : own_rows)
      dst.local_element(i++) = product(row, v);
  }



  std::vector<unsigned int>
  DistributedMatrix::rows_of(const std::vector<unsigned int> &columns) const
  {
    // A rank has the columns of its own rows only, and a column that is meant
    // may belong to another rank; so all own rows are searched for it.
    std::vector<bool> is_meant(A.n(), false);
    for (const unsigned int column : columns)
      is_meant[column] = true;
    std::vector<unsigned int> result;
    for (const auto row : own_rows)
      {
        const auto last = A.end(row);
        for (auto entry = A.begin(row); entry != last; ++entry)
          if (is_meant[entry->column()])
            {
              result.push_back(row);
              break;
            }
      }
    return result;
  }



  void
  DistributedMatrix::subtract(const std::vector<unsigned int> &rows,
                              const std::vector<double>       &v,
                              DistributedVector               &dst) const
  {
    for (const unsigned int row : rows)
      dst(row) -= product(row, v);
  }
} // namespace Debond
