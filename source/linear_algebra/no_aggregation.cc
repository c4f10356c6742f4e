// SPDX-License-Identifier: LGPL-2.1-or-later
// In place of aggregation.cc where Trilinos has no ML.
#include <debond/linear_algebra/aggregation.h>

namespace Debond
{
  const bool has_aggregation = false;



  std::vector<Prolongation>
  aggregated_prolongations(const MatrixOnRanks &A,
                           const unsigned int,
                           const std::vector<DistributedVector> &)
  {
    // Matrices so small have no levels with ML either.
    AssertThrow(A.own_rows.size() <= largest_without_aggregates,
                dealii::ExcNotImplemented());
    return {};
  }
} // namespace Debond
