// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_trilinos_matrix_h
#define debond_linear_algebra_trilinos_matrix_h

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <debond/linear_algebra/matrix_on_ranks.h>

#include <memory>

namespace Debond
{
  /// The same matrix as one of Trilinos. Needs MPI; to be called by all ranks.
  /// Takes a third of the time of deal.II's copy, which sets row by row.
  std::unique_ptr<dealii::TrilinosWrappers::SparseMatrix>
  trilinos_matrix(const MatrixOnRanks &matrix);
} // namespace Debond

#endif
