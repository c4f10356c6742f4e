// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_cholmod_factor_h
#define debond_linear_algebra_cholmod_factor_h

#include <debond/linear_algebra/elimination_factor.h>
#include <debond/linear_algebra/matrix_on_ranks.h>

#include <memory>

namespace Debond
{
  /**
   * On one rank, which has all rows of A. One supernodal Cholesky factorisation
   * P A P' = L L' with the kept unknowns last gives everything: the trailing
   * block L_ss of the factor has S = L_ss L_ss', the reduced load L y = P f
   * gives g = L_ss y_s and c_0 = -1/2 |y_i|^2, and L'x = (y_i, L_ss's) all
   * unknowns for given s. If A is semidefinite the factor is that of A with its
   * diagonal entries of s twice as large.
   *
   * Throws std::runtime_error if A is not positive definite, std::bad_alloc if
   * the factor does not fit into memory.
   */
  std::unique_ptr<EliminationFactor>
  make_cholmod_factor(const dealii::SparseMatrix<double> &A,
                      const Elimination                  &elimination);



  /// The work and the memory of the factorisation of a Condensation.
  struct FactorisationCost
  {
    double operations; ///< floating point
    double entries;    ///< of the factor, 8 bytes each
  };

  /// The cost by the symbolic factorisation of the graph of nodes, each of
  /// which has @p n_components successive rows of A, on the same rank. All
  /// ranks call it; the first one does it, with the whole graph, and all get
  /// its result. Throws std::bad_alloc, on all ranks.
  FactorisationCost
  factorisation_cost(const MatrixOnRanks             &matrix,
                     const std::vector<unsigned int> &kept,
                     const unsigned int               n_components);
} // namespace Debond

#endif
