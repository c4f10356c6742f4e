// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_multigrid_shared_trace_h
#define debond_linear_algebra_multigrid_shared_trace_h

#include <debond/linear_algebra/dof_vector.h>
#include <debond/linear_algebra/multigrid/shared_nodes.h>

#include <Eigen/Core>

#include <vector>

namespace Debond
{
  /// The entries of a few unknowns that ranks share, for all ranks.
  class SharedTrace
  {
  public:
    /// Each rank's numbers of the same unknowns,
    /// dealii::numbers::invalid_unsigned_int for those that it does not have.
    /// To be called by all ranks, and so is the function below.
    SharedTrace(const SharedNodes               &nodes,
                const unsigned int               dim,
                const std::vector<unsigned int> &unknowns);

    /// In the order of the unknowns.
    Eigen::VectorXd
    operator()(const DofVector &v) const;

  private:
    const MPI_Comm            ranks;
    std::vector<unsigned int> own; ///< unknowns of the rank
    std::vector<int>          counts, starts;

    /// For what the ranks have, one after the other, its place.
    std::vector<unsigned int> places;
  };
} // namespace Debond

#endif
