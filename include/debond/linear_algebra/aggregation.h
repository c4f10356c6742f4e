// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_aggregation_h
#define debond_linear_algebra_aggregation_h

#include <debond/linear_algebra/truncated_multigrid.h>

namespace Debond
{
  /// Matrices with so few rows have no coarser levels of aggregates.
  constexpr unsigned int largest_without_aggregates = 2000;

  /// Whether Trilinos has ML, without which there are no aggregates.
  extern const bool has_aggregation;

  /// The smoothed aggregates of Trilinos ML (Vanek, Mandel, Brezina, Computing
  /// 56, 1996), finest first, for @p n_components successive unknowns a node
  /// and a near null space, such as the rigid motions, zero where A is
  /// constrained. An aggregate has an unknown for each of its vectors. To be
  /// called by all ranks.
  std::vector<Prolongation>
  aggregated_prolongations(
    const MatrixOnRanks                  &A,
    const unsigned int                    n_components,
    const std::vector<DistributedVector> &near_null_space);
} // namespace Debond

#endif
