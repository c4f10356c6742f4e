// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/mesh_transfer.h>

#include <algorithm>
#include <vector>

namespace Debond
{
  template <int dim>
  dealii::Vector<double>
  interpolate_displacement(const Body<dim>              &body,
                           const ElasticProblem<dim>    &source,
                           const dealii::Vector<double> &u,
                           const ElasticProblem<dim>    &target)
  {
    const auto &source_mesh =
      source.unknowns().dof_handler().get_triangulation();
    const auto &target_mesh =
      target.unknowns().dof_handler().get_triangulation();

    const dealii::Vector<double> displacement =
      source.unknowns().cartesian_displacement(u);
    std::vector<dealii::Tensor<1, dim>> at_vertices(source_mesh.n_vertices());
    for (const auto &cell :
         source.unknowns().dof_handler().active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        for (unsigned int d = 0; d < dim; ++d)
          at_vertices[cell->vertex_index(v)][d] =
            displacement[cell->vertex_dof_index(v, d)];

    const std::vector<dealii::Tensor<1, dim>> interpolated =
      body.interpolate(source_mesh, at_vertices, target_mesh.get_vertices());
    dealii::Vector<double> result(target.unknowns().n_dofs());
    for (const auto &cell :
         target.unknowns().dof_handler().active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        for (unsigned int d = 0; d < dim; ++d)
          result[cell->vertex_dof_index(v, d)] =
            interpolated[cell->vertex_index(v)][d];
    result = target.unknowns().from_cartesian(result);
    if (target.unknowns().has_gap())
      {
        // Between nodes a gap is not what the coarser mesh sees.
        const ContactSpace<dim> &contact = target.unknowns().contact();
        dealii::Vector<double>   excess  = contact.trace(result);
        for (double &s : excess)
          s = -std::max(s, 0.);
        contact.add_normal(excess, result);
      }
    return result;
  }



  template dealii::Vector<double>
  interpolate_displacement(const Body<2> &,
                           const ElasticProblem<2> &,
                           const dealii::Vector<double> &,
                           const ElasticProblem<2> &);
  template dealii::Vector<double>
  interpolate_displacement(const Body<3> &,
                           const ElasticProblem<3> &,
                           const dealii::Vector<double> &,
                           const ElasticProblem<3> &);
} // namespace Debond
