// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_mesh_transfer_h
#define debond_elasticity_mesh_transfer_h

#include <debond/elasticity/elastic_problem.h>

namespace Debond
{
  /// The displacement u of a problem on a mesh whose cells are divided in that
  /// of @p target, in its unknowns: the same polynomials of the same degree,
  /// but for what the target's supports prescribe and, if there are gaps, for
  /// what would enter the foundation. @p ancestors: of each cell of the
  /// target's whole mesh the one that it is a part of. To be called by all
  /// ranks, and so is the other one.
  template <int dim>
  DofVector
  divided_displacement(const ElasticProblem<dim>       &source,
                       const DofVector                 &u,
                       const std::vector<unsigned int> &ancestors,
                       const ElasticProblem<dim>       &target);

  /// The P1 displacement u of a problem on another mesh of the same body, whole
  /// on each rank, at the nodes of @p target: a vector of its unknowns, whose
  /// supports and frames may be others. On a mesh whose cells divide those of
  /// the source the displacement is reproduced exactly (their P1 spaces are
  /// nested) but for the same. Points beside the source's mesh, as on the
  /// curved side of a finer one, belong to a cell next to them.
  template <int dim>
  DofVector
  interpolate_displacement(const ElasticProblem<dim> &source,
                           const DofVector           &u,
                           const ElasticProblem<dim> &target);
} // namespace Debond

#endif
