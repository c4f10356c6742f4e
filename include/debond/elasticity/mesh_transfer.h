// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_mesh_transfer_h
#define debond_elasticity_mesh_transfer_h

#include <debond/elasticity/elastic_problem.h>
#include <debond/linear_algebra/dof_vector.h>
#include <debond/mesh/body.h>

#include <vector>

namespace Debond
{
  /// The displacement that belongs to u, by vertex index.
  template <int dim>
  std::vector<dealii::Tensor<1, dim>>
  vertex_displacements(const ElasticProblem<dim> &problem, const DofVector &u);

  /// The vector of unknowns of the displacement with these values, but for what
  /// the supports prescribe and, if there are gaps, for what would enter the
  /// foundation.
  template <int dim>
  DofVector
  from_vertex_displacements(
    const std::vector<dealii::Tensor<1, dim>> &displacements,
    const ElasticProblem<dim>                 &problem);

  /// The displacement u of a problem on a mesh whose cells are divided in that
  /// of @p target, in its unknowns: the same polynomials of the same degree,
  /// but for what the target's supports prescribe. @p ancestors: of each cell
  /// of the target's the one that it is a part of.
  template <int dim>
  DofVector
  divided_displacement(const ElasticProblem<dim>       &source,
                       const DofVector                 &u,
                       const std::vector<unsigned int> &ancestors,
                       const ElasticProblem<dim>       &target);

  /**
   * The P1 displacement u of a problem on the mesh of @p body, at the
   * vertices of another mesh of the same body: a vector of unknowns of
   * @p target, whose supports and frames may be others. On a mesh whose cells
   * divide those of @p body the displacement is reproduced exactly (their P1
   * spaces are nested) but for what the target's supports prescribe.
   *
   * @p body must be the one that made the source's triangulation.
   */
  template <int dim>
  DofVector
  interpolate_displacement(const Body<dim>           &body,
                           const ElasticProblem<dim> &source,
                           const DofVector           &u,
                           const ElasticProblem<dim> &target);
} // namespace Debond

#endif
