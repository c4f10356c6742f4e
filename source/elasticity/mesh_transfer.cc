// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/mesh_transfer.h>

#include <algorithm>
#include <vector>

namespace Debond
{
  template <int dim>
  std::vector<dealii::Tensor<1, dim>>
  vertex_displacements(const ElasticProblem<dim> &problem, const DofVector &u)
  {
    const dealii::DoFHandler<dim> &dofs = problem.unknowns().dof_handler();
    const DofVector displacement = problem.unknowns().cartesian_displacement(u);
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
  DofVector
  from_vertex_displacements(
    const std::vector<dealii::Tensor<1, dim>> &displacements,
    const ElasticProblem<dim>                 &problem)
  {
    const auto                                  &unknowns = problem.unknowns();
    DofVector                                    result(unknowns.n_dofs());
    std::vector<dealii::types::global_dof_index> cell_dofs(
      unknowns.dof_handler().get_fe().dofs_per_cell);
    for (const auto &cell : unknowns.dof_handler().active_cell_iterators())
      {
        cell->get_dof_indices(cell_dofs);
        for (unsigned int i = 0; i < cell_dofs.size(); ++i)
          {
            const unsigned int node = i / dim, d = i % dim;
            if (node <= dim)
              result(cell_dofs[i]) = displacements[cell->vertex_index(node)][d];
            else
              {
                const auto line = cell->line(node - (dim + 1));
                result(cell_dofs[i]) =
                  0.5 * (displacements[line->vertex_index(0)][d] +
                         displacements[line->vertex_index(1)][d]);
              }
          }
      }
    result = problem.unknowns().from_cartesian(result);
    if (problem.unknowns().has_gap())
      {
        // Between nodes a gap is not what a coarser mesh sees.
        const ContactSpace<dim> &contact = problem.unknowns().contact();
        contact.add_normal(-contact.trace(result).cwiseMax(0.), result);
      }
    return result;
  }



  template <int dim>
  DofVector
  divided_displacement(const ElasticProblem<dim>       &source,
                       const DofVector                 &u,
                       const std::vector<unsigned int> &ancestors,
                       const ElasticProblem<dim>       &target)
  {
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;
    std::vector<Cell> whole_cells;
    for (const auto &cell :
         source.unknowns().dof_handler().active_cell_iterators())
      whole_cells.push_back(cell);
    const DofVector values = source.unknowns().cartesian_displacement(u);
    const std::vector<dealii::Point<dim>> positions =
      target.unknowns().positions();
    const auto &fe = source.unknowns().dof_handler().get_fe();

    // The Jacobian takes to the points of the reference cell.
    dealii::FEValues<dim> fe_values(source.unknowns().mapping(),
                                    fe,
                                    dealii::QGaussSimplex<dim>(1),
                                    dealii::update_inverse_jacobians);
    std::vector<dealii::types::global_dof_index> from(fe.dofs_per_cell),
      to(fe.dofs_per_cell);
    DofVector         result(target.unknowns().n_dofs());
    std::vector<bool> is_done(result.size(), false);
    for (const auto &cell :
         target.unknowns().dof_handler().active_cell_iterators())
      {
        const Cell &whole = whole_cells[ancestors[cell->active_cell_index()]];
        fe_values.reinit(whole);
        whole->get_dof_indices(from);
        cell->get_dof_indices(to);
        for (unsigned int i = 0; i < to.size(); ++i)
          {
            if (is_done[to[i]])
              continue;
            is_done[to[i]] = true;
            const dealii::Point<dim> point(
              dealii::apply_transformation(fe_values.inverse_jacobian(0),
                                           positions[to[i]] -
                                             whole->vertex(0)));
            for (unsigned int j = i % dim; j < from.size(); j += dim)
              result(to[i]) += fe.shape_value(j, point) * values(from[j]);
          }
      }
    return target.unknowns().from_cartesian(result);
  }



  template <int dim>
  DofVector
  interpolate_displacement(const Body<dim>           &body,
                           const ElasticProblem<dim> &source,
                           const DofVector           &u,
                           const ElasticProblem<dim> &target)
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



  template decltype(vertex_displacements<2>)      vertex_displacements<2>;
  template decltype(vertex_displacements<3>)      vertex_displacements<3>;
  template decltype(from_vertex_displacements<2>) from_vertex_displacements<2>;
  template decltype(from_vertex_displacements<3>) from_vertex_displacements<3>;
  template decltype(divided_displacement<2>)      divided_displacement<2>;
  template decltype(divided_displacement<3>)      divided_displacement<3>;
  template decltype(interpolate_displacement<2>)  interpolate_displacement<2>;
  template decltype(interpolate_displacement<3>)  interpolate_displacement<3>;
} // namespace Debond
