// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_dof_vector_h
#define debond_base_dof_vector_h

#include <deal.II/lac/vector.h>

#include <debond/base/ranks.h>

#include <Eigen/Core>

namespace Debond
{
  /// An entry for each degree of freedom: displacements u, loads f, residuals;
  /// and what bundle methods minimise over. All ranks have all entries, and the
  /// same ones.
  /// Vectors with an entry for each contact node are Eigen vectors.
  using DofVector = dealii::Vector<double>;



  /// Adds up what ranks have found, each in its own cells, for all of them.
  inline void
  add_over_ranks(DofVector &v, const MPI_Comm ranks)
  {
    if (number_of_ranks(ranks) > 1)
      dealii::Utilities::MPI::sum(v, ranks, v);
  }



  /// A view of the vector of a bundle method, valid as long as it.
  inline Eigen::Map<const Eigen::VectorXd>
  eigen_view(const dealii::Vector<double> &vector)
  {
    return {vector.begin(), static_cast<Eigen::Index>(vector.size())};
  }
} // namespace Debond

#endif
