// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_multigrid_factor_h
#define debond_linear_algebra_multigrid_factor_h

#include <debond/linear_algebra/elimination_factor.h>
#include <debond/linear_algebra/truncated_multigrid.h>

namespace Debond
{
  /**
   * Solutions with A_ii by conjugate gradients with a multigrid cycle that
   * holds the kept unknowns, and S by one for each of these: for what needs S
   * of a body whose factorisation does not fit into memory. @p cycle is one of
   * @p matrix.
   *
   * To be called by all ranks, with the same @p elimination. Throws
   * std::runtime_error on all of them if a solution is not found.
   */
  std::unique_ptr<EliminationFactor>
  make_multigrid_factor(const MatrixOnRanks                &matrix,
                        const Elimination                  &elimination,
                        std::unique_ptr<TruncatedMultigrid> cycle);
} // namespace Debond

#endif
