// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_distributed_matrix_h
#define debond_linear_algebra_distributed_matrix_h

#include <debond/linear_algebra/distributed_vector.h>
#include <debond/linear_algebra/matrix_on_ranks.h>

namespace Debond
{
  /// A MatrixOnRanks as an operator on vectors of which each rank has its own
  /// unknowns, one contiguous range. To be called by all ranks. Valid as long
  /// as the matrix.
  class DistributedMatrix : public MatrixOnRanks
  {
  public:
    explicit DistributedMatrix(const MatrixOnRanks &A);

    /// v at own unknowns and at all others to which own rows couple, by their
    /// numbers in the whole. Valid until the next call.
    const std::vector<double> &
    at_columns(const DistributedVector &v) const;

    /// dst = A src.
    void
    vmult(DistributedVector &dst, const DistributedVector &src) const;

    /// Multiplies as above, with the values of src that at_columns() returns.
    void
    multiply(DistributedVector &dst, const std::vector<double> &values) const;

    /// The own rows that couple to one of these unknowns of the whole.
    std::vector<unsigned int>
    rows_of(const std::vector<unsigned int> &columns) const;

    /// dst -= A v at these own rows alone, where @p values is that of v by
    /// at_columns().
    void
    subtract(const std::vector<unsigned int> &rows,
             const std::vector<double>       &values,
             DistributedVector               &dst) const;

  private:
    /// The product of a row with the values.
    double
    product(const unsigned int row, const std::vector<double> &values) const;

    mutable DistributedVector   with_ghosts;
    mutable std::vector<double> values; ///< of the size of the whole
  };
} // namespace Debond

#endif
