// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_multigrid_shared_rows_h
#define debond_linear_algebra_multigrid_shared_rows_h

#include <debond/linear_algebra/multigrid/block_matrix.h>
#include <debond/linear_algebra/multigrid/shared_nodes.h>

#include <map>
#include <vector>

namespace Debond
{
  /// Gives ranks the rows of a matrix that belong to their ghosts.
  class SharedRows
  {
  public:
    /// To be called by all ranks, as complete() is. Keeps a reference.
    explicit SharedRows(const SharedNodes &nodes);

    /// The own rows of @p matrix, and those of the ghosts from the ranks that
    /// own them, without the columns that the rank does not have.
    template <int dim>
    BlockMatrix<dim, double>
    complete(const BlockMatrix<dim, double> &matrix) const;

  private:
    const SharedNodes                                &nodes;
    std::map<unsigned int, std::vector<unsigned int>> wanted; ///< own, by rank
  };
} // namespace Debond

#endif
