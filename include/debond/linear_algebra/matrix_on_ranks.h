// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_matrix_on_ranks_h
#define debond_linear_algebra_matrix_on_ranks_h

#include <deal.II/base/index_set.h>
#include <deal.II/lac/sparse_matrix.h>

#include <debond/base/ranks.h>

namespace Debond
{
  /// A square matrix of which each rank has only its own rows, with all their
  /// columns: it has its full size everywhere, and what stands in other rows is
  /// not looked at. Valid as long as the matrix.
  struct MatrixOnRanks
  {
    /// All rows, for this rank alone. Meant to be converted to where no other
    /// ranks are.
    MatrixOnRanks(const dealii::SparseMatrix<double> &A)
      : A(A)
      , own_rows(dealii::complete_index_set(A.m()))
      , ranks(MPI_COMM_SELF)
    {}

    /// Each row belongs to one of the @p ranks.
    MatrixOnRanks(const dealii::SparseMatrix<double> &A,
                  const dealii::IndexSet             &own_rows,
                  const MPI_Comm                      ranks)
      : A(A)
      , own_rows(own_rows)
      , ranks(ranks)
    {}

    /// Returns whether there is another rank.
    bool
    is_shared() const
    {
      return number_of_ranks(ranks) > 1;
    }

    const dealii::SparseMatrix<double> &A;
    const dealii::IndexSet              own_rows;
    const MPI_Comm                      ranks;
  };
} // namespace Debond

#endif
