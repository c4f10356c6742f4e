// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_block_factor_h
#define debond_linear_algebra_block_factor_h

#include <debond/linear_algebra/elimination_factor.h>
#include <debond/linear_algebra/matrix_on_ranks.h>

#include <Eigen/SparseCore>

namespace Debond
{
  /// An EliminationFactor by solutions with A_ii: x_i = A_ii^{-1} f_i has g =
  /// f_s - A_si x_i and c_0 = -1/2 f_i'x_i, and u_i = A_ii^{-1} (f_i - A_is s).
  class BlockFactor : public EliminationFactor
  {
  public:
    ReducedLoad
    reduce(const DofVector &f) const override;

    DofVector
    expand(const ReducedLoad &load, const VectorView &s) const override;

  protected:
    /// S is to be set, and finish() to be called.
    BlockFactor(const MatrixOnRanks &matrix, const Elimination &elimination);

    /// Makes all of S on all ranks from its lower triangle on the first one,
    /// and L_ss.
    void
    finish(const MatrixOnRanks &matrix);

    /// A_ii^{-1} b, on all ranks.
    virtual Eigen::VectorXd
    solve(const Eigen::VectorXd &b) const = 0;

    /// The sum over the ranks, in place.
    void
    sum(Eigen::VectorXd &values) const;

    const Elimination           elimination;
    const MPI_Comm              ranks;
    const bool                  is_first;
    const unsigned int          n_rows; ///< of A
    const unsigned int          n_eliminated;
    const unsigned int          n_kept;
    Eigen::SparseMatrix<double> A_is; ///< own rows only
  };
} // namespace Debond

#endif
