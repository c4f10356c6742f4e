// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_distributed_vector_h
#define debond_linear_algebra_distributed_vector_h

#include <deal.II/base/index_set.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <debond/base/dof_vector.h>

namespace Debond
{
  /// A vector of which each rank has its own entries alone, for what iterates
  /// on all unknowns. Needs MPI.
  using DistributedVector = dealii::LinearAlgebra::distributed::Vector<double>;



  /// The entries @p own of a vector that all ranks have.
  inline DistributedVector
  distribute(const DofVector        &v,
             const dealii::IndexSet &own,
             const MPI_Comm          ranks)
  {
    DistributedVector result(own, ranks);
    for (const auto i : own)
      result(i) = v(i);
    return result;
  }



  /// On all ranks. To be called by all of them.
  inline DofVector
  gather(const DistributedVector &v)
  {
    DofVector result(v.size());
    for (const auto i : v.locally_owned_elements())
      result(i) = v(i);
    add_over_ranks(result, v.get_mpi_communicator());
    return result;
  }
} // namespace Debond

#endif
