// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/mesh_transfer.h>

#include <algorithm>
#include <vector>

namespace Debond
{
  template <int dim>
  std::vector<dealii::Tensor<1, dim>>
  vertex_displacements(const ElasticProblem<dim>    &problem,
                       const dealii::Vector<double> &u)
  {
    const dealii::DoFHandler<dim> &dofs = problem.unknowns().dof_handler();
    const dealii::Vector<double>   displacement =
      problem.unknowns().cartesian_displacement(u);
    std::vector<dealii::Tensor<1, dim>> at_vertices(
      dofs.get_triangulation().n_vertices());
    for (const auto &cell : dofs.active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        for (unsigned int d = 0; d < dim; ++d)
          at_vertices[cell->vertex_index(v)][d] =
            displacement[cell->vertex_dof_index(v, d)];
    return at_vertices;
  }



  template <int dim>
  dealii::Vector<double>
  from_vertex_displacements(
    const std::vector<dealii::Tensor<1, dim>> &displacements,
    const ElasticProblem<dim>                 &problem)
  {
    dealii::Vector<double> result(problem.unknowns().n_dofs());
    for (const auto &cell :
         problem.unknowns().dof_handler().active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        for (unsigned int d = 0; d < dim; ++d)
          result[cell->vertex_dof_index(v, d)] =
            displacements[cell->vertex_index(v)][d];
    result = problem.unknowns().from_cartesian(result);
    if (problem.unknowns().has_gap())
      {
        // Between nodes a gap is not what a coarser mesh sees.
        const ContactSpace<dim> &contact = problem.unknowns().contact();
        dealii::Vector<double>   excess  = contact.trace(result);
        for (double &s : excess)
          s = -std::max(s, 0.);
        contact.add_normal(excess, result);
      }
    return result;
  }



  template <int dim>
  dealii::Vector<double>
  interpolate_displacement(const Body<dim>              &body,
                           const ElasticProblem<dim>    &source,
                           const dealii::Vector<double> &u,
                           const ElasticProblem<dim>    &target)
  {
    const auto mesh_of = [](const ElasticProblem<dim> &problem) -> const auto &
    {
      return problem.unknowns().dof_handler().get_triangulation();
    };
    return from_vertex_displacements(
      body.interpolate(mesh_of(source),
                       vertex_displacements(source, u),
                       mesh_of(target).get_vertices()),
      target);
  }



  template std::vector<dealii::Tensor<1, 2>>
  vertex_displacements(const ElasticProblem<2> &,
                       const dealii::Vector<double> &);
  template std::vector<dealii::Tensor<1, 3>>
  vertex_displacements(const ElasticProblem<3> &,
                       const dealii::Vector<double> &);
  template dealii::Vector<double>
  from_vertex_displacements(const std::vector<dealii::Tensor<1, 2>> &,
                            const ElasticProblem<2> &);
  template dealii::Vector<double>
  from_vertex_displacements(const std::vector<dealii::Tensor<1, 3>> &,
                            const ElasticProblem<3> &);
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
