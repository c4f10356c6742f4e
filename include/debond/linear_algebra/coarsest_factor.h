// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_coarsest_factor_h
#define debond_linear_algebra_coarsest_factor_h

#include <debond/linear_algebra/shared_nodes.h>

#include <Eigen/SparseCholesky>

namespace Debond
{
  /// The factor of the matrix of the coarsest level and a change by truncation,
  /// on each rank the same. All ranks call the functions together.
  class CoarsestFactor
  {
  public:
    /// Takes all own rows, by numbers of the whole. If the matrix
    /// @p may_be_singular its diagonal is made larger where it is factorised:
    /// modes of an aggregate with few free unknowns depend on each other.
    CoarsestFactor(const NumberedRows &rows,
                   const bool          may_be_singular,
                   const MPI_Comm      ranks);

    /// The matrix and a change, by numbers of the whole, in its pattern. Throws
    /// std::runtime_error on all ranks if that is singular.
    void
    factorise(const NumberedRows &change);

    void
    solve(SinglePrecisionVector &x, const SinglePrecisionVector &b) const;

  private:
    /// The rows of all ranks.
    Eigen::SparseMatrix<double>
    gather(const NumberedRows &own, const Eigen::Index n) const;

    const double                                       larger_diagonal;
    const MPI_Comm                                     ranks;
    Eigen::SparseMatrix<double>                        matrix; ///< unchanged
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
  };
} // namespace Debond

#endif
