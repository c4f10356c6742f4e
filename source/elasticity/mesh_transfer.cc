// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/cell_nodes.h>
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
    DofVector result(problem.unknowns().n_dofs());
    for (const auto &cell :
         problem.unknowns().dof_handler().active_cell_iterators())
      {
        const CellNodes<dim> nodes(cell);
        for (unsigned int n = 0; n < nodes.size; ++n)
          for (unsigned int d = 0; d < dim; ++d)
            if (n <= dim)
              result[nodes.dofs[n][d]] = displacements[nodes.indices[n]][d];
            else
              {
                const auto &[a, b] = simplex_edges[n - (dim + 1)];
                result[nodes.dofs[n][d]] =
                  0.5 * (displacements[nodes.indices[a]][d] +
                         displacements[nodes.indices[b]][d]);
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
    using Cell        = typename dealii::DoFHandler<dim>::active_cell_iterator;
    using Barycentric = std::array<double, dim + 1>;
    std::vector<Cell> whole_cells;
    for (const auto &cell :
         source.unknowns().dof_handler().active_cell_iterators())
      whole_cells.push_back(cell);
    const unsigned int degree    = source.unknowns().degree();
    const DofVector coefficients = source.unknowns().cartesian_displacement(u);

    DofVector result(target.unknowns().n_dofs());
    for (const auto &cell :
         target.unknowns().dof_handler().active_cell_iterators())
      {
        const Cell &whole = whole_cells[ancestors[cell->active_cell_index()]];
        const LinearSimplex<dim>         simplex(whole);
        const CellNodes<dim>             from(whole), to(cell);
        std::array<Barycentric, dim + 1> vertices;
        for (unsigned int v = 0; v <= dim; ++v)
          for (unsigned int w = 0; w <= dim; ++w)
            vertices[v][w] =
              (w == 0 ? 1. : 0.) +
              simplex.gradients[w] * (cell->vertex(v) - whole->vertex(0));

        // A coefficient is the polynomial's polar form at the ends of an edge,
        // or twice at a vertex.
        for (unsigned int n = 0; n < to.size; ++n)
          {
            const unsigned int a = n <= dim ? n : simplex_edges[n - dim - 1][0];
            const unsigned int b = n <= dim ? n : simplex_edges[n - dim - 1][1];
            const Barycentric &x = vertices[a], &y = vertices[b];
            std::array<double, CellNodes<dim>::maximum> weights = {};
            for (unsigned int v = 0; v <= dim; ++v)
              weights[v] = degree == 1 ? x[v] : x[v] * y[v];
            for (unsigned int e = dim + 1; e < from.size; ++e)
              {
                const auto &[i, j] = simplex_edges[e - dim - 1];
                weights[e]         = x[i] * y[j] + x[j] * y[i];
              }
            for (unsigned int d = 0; d < dim; ++d)
              {
                double sum = 0.;
                for (unsigned int m = 0; m < from.size; ++m)
                  sum += weights[m] * coefficients(from.dofs[m][d]);
                result(to.dofs[n][d]) = sum;
              }
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
