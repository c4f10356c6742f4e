// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_prolongations_h
#define debond_elasticity_prolongations_h

#include <debond/elasticity/unknowns.h>
#include <debond/linear_algebra/truncated_multigrid.h>

namespace Debond
{
  /// The P1 fields of the coarser meshes of @p body at the nodes of the next
  /// finer ones, the finest first, as maps between unknowns: coarse nodes have
  /// the frames and supports of the fine nodes at which they lie. Empty if the
  /// body has no coarser levels. To be called by all ranks, of degree 1.
  template <int dim>
  std::vector<Prolongation>
  prolongations(const Body<dim> &body, const ElasticUnknowns<dim> &unknowns);
} // namespace Debond

#endif
