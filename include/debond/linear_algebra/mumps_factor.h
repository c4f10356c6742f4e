// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_mumps_factor_h
#define debond_linear_algebra_mumps_factor_h

#include <debond/linear_algebra/elimination_factor.h>
#include <debond/linear_algebra/matrix_on_ranks.h>

#include <memory>

namespace Debond
{
  /**
   * On any number of ranks, by MUMPS, which factorises A_ii and returns S. The
   * rest comes from solutions with A_ii: x_i = A_ii^{-1} f_i has g = f_s - A_si
   * x_i and c_0 = -1/2 f_i'x_i, and u_i = A_ii^{-1} (f_i - A_is s).
   *
   * To be called by all ranks; f, s and the @p elimination have to be the same
   * on all of them. What it throws, it throws on all: std::runtime_error if A
   * is not positive definite, std::bad_alloc if the factor does not fit into
   * memory.
   */
  std::unique_ptr<EliminationFactor>
  make_mumps_factor(const MatrixOnRanks &matrix,
                    const Elimination   &elimination);
} // namespace Debond

#endif
