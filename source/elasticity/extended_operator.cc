// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/extended_operator.h>

#include <algorithm>
#include <cmath>

namespace Debond
{
  template <int dim>
  ExtendedOperator<dim>::ExtendedOperator(
    const ElasticProblem<dim> &elastic_problem)
    : problem(elastic_problem)
    , degree(problem.unknowns().degree())
    , n_points(degree == 1 ? 1 : dim + 1)
  {
    cells.reserve(
      problem.unknowns().dof_handler().get_triangulation().n_active_cells());
    for (const auto &dof_cell :
         problem.unknowns().dof_handler().active_cell_iterators())
      {
        Cell                 cell;
        const CellNodes<dim> nodes(dof_cell);
        std::copy_n(nodes.dofs.begin(), dim + 1, cell.dofs.begin());
        if (degree == 2)
          {
            edge_dofs.emplace_back();
            std::copy(nodes.dofs.begin() + dim + 1,
                      nodes.dofs.end(),
                      edge_dofs.back().begin());
          }

        // Row v of edges is the edge to vertex v + 1, and the columns of its
        // inverse are the gradients.
        std::array<std::array<long double, dim>, dim> edges;
        for (unsigned int v = 0; v < dim; ++v)
          for (unsigned int d = 0; d < dim; ++d)
            edges[v][d] = static_cast<long double>(dof_cell->vertex(v + 1)[d]) -
                          dof_cell->vertex(0)[d];
        long double determinant = 0.;
        for (unsigned int v = 0; v < dim; ++v)
          for (unsigned int d = 0; d < dim; ++d)
            {
              long double cofactor;
              if constexpr (dim == 2)
                cofactor = (v == d ? 1 : -1) * edges[1 - v][1 - d];
              else
                cofactor = edges[(v + 1) % 3][(d + 1) % 3] *
                             edges[(v + 2) % 3][(d + 2) % 3] -
                           edges[(v + 1) % 3][(d + 2) % 3] *
                             edges[(v + 2) % 3][(d + 1) % 3];
              cell.gradients[v][d] = cofactor;
              if (v == 0)
                determinant += edges[0][d] * cofactor;
            }
        for (auto &gradient : cell.gradients)
          for (long double &component : gradient)
            component /= determinant;
        cell.volume              = determinant / (dim == 2 ? 2 : 6);
        const Material &material = problem.fields().material(dof_cell);
        cell.lambda              = material.lame_lambda<dim>();
        cell.mu                  = material.shear_modulus();
        cells.push_back(cell);
      }
  }



  template <int dim>
  ExtendedVector
  ExtendedOperator<dim>::operator*(const ExtendedVector &u) const
  {
    const ExtendedVector  displacement = cartesian(u);
    ExtendedVector        forces       = ExtendedVector::Zero(u.size());
    std::vector<Gradient> gradients;
    for (unsigned int c = 0; c < cells.size(); ++c)
      for (unsigned int q = 0; q < n_points; ++q)
        {
          make_gradients(cells[c], q, gradients);
          const Stress sigma = stress(c, gradients, displacement);
          for (unsigned int d = 0; d < dim; ++d)
            for (unsigned int n = 0; n < gradients.size(); ++n)
              {
                long double force = 0.;
                for (unsigned int e = 0; e < dim; ++e)
                  force += sigma[d][e] * gradients[n][e];
                force *= cells[c].volume / n_points;
                forces(dofs(c, n + 1)[d]) += force;
                forces(dofs(c, 0)[d]) -= force;
              }
        }

    ExtendedVector result = forces;
    for (const auto &frame : problem.unknowns().frames())
      for (unsigned int k = 0; k < dim; ++k)
        {
          result(frame.dofs[k]) = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            result(frame.dofs[k]) +=
              frame.to_cartesian[d][k] * forces(frame.dofs[d]);
        }
    for (unsigned int i = 0; i < result.size(); ++i)
      if (problem.unknowns().is_constrained(i))
        result(i) = 0.;
    return result;
  }



  template <int dim>
  double
  ExtendedOperator<dim>::stress_rounding(const ExtendedVector &u,
                                         const ExtendedVector &rounded_u) const
  {
    const ExtendedVector  displacement = cartesian(u);
    const ExtendedVector  rounded      = cartesian(rounded_u);
    long double           largest = 0., largest_change = 0.;
    std::vector<Gradient> gradients;
    for (unsigned int c = 0; c < cells.size(); ++c)
      for (unsigned int q = 0; q < n_points; ++q)
        {
          make_gradients(cells[c], q, gradients);
          const Stress exact = stress(c, gradients, displacement);
          const Stress other = stress(c, gradients, rounded);
          for (unsigned int d = 0; d < dim; ++d)
            for (unsigned int e = 0; e < dim; ++e)
              {
                largest = std::max(largest, std::abs(exact[d][e]));
                largest_change =
                  std::max(largest_change, std::abs(exact[d][e] - other[d][e]));
              }
        }
    return largest > 0. ? static_cast<double>(largest_change / largest) : 0.;
  }



  template <int dim>
  ExtendedVector
  ExtendedOperator<dim>::cartesian(const ExtendedVector &u) const
  {
    ExtendedVector result = u;
    for (const auto &frame : problem.unknowns().frames())
      for (unsigned int d = 0; d < dim; ++d)
        {
          result(frame.dofs[d]) = 0.;
          for (unsigned int k = 0; k < dim; ++k)
            result(frame.dofs[d]) +=
              frame.to_cartesian[d][k] * u(frame.dofs[k]);
        }
    return result;
  }



  template <int dim>
  void
  ExtendedOperator<dim>::make_gradients(const Cell            &cell,
                                        const unsigned int     point,
                                        std::vector<Gradient> &gradients) const
  {
    if (degree == 1)
      {
        gradients.assign(cell.gradients.begin(), cell.gradients.end());
        return;
      }
    const long double small =
      dim == 2 ? 1.L / 6.L : (5.L - std::sqrt(5.L)) / 20.L;
    std::array<long double, dim + 1> barycentric;
    barycentric.fill(small);
    barycentric[point] = 1.L - dim * small;
    std::array<Gradient, dim + 1> of_vertices;
    of_vertices[0] = {};
    for (unsigned int v = 1; v <= dim; ++v)
      {
        of_vertices[v] = cell.gradients[v - 1];
        for (unsigned int d = 0; d < dim; ++d)
          of_vertices[0][d] -= of_vertices[v][d];
      }
    gradients.resize(CellNodes<dim>::maximum - 1);
    for (unsigned int n = 1; n < CellNodes<dim>::maximum; ++n)
      for (unsigned int d = 0; d < dim; ++d)
        {
          const unsigned int a = n <= dim ? n : simplex_edges[n - (dim + 1)][0];
          const unsigned int b = n <= dim ? n : simplex_edges[n - (dim + 1)][1];
          // Of l_a^2 and of 2 l_a l_b.
          gradients[n - 1][d] =
            (a == b ? 1.L : 2.L) * (barycentric[a] * of_vertices[b][d] +
                                    barycentric[b] * of_vertices[a][d]);
        }
  }



  template <int dim>
  typename ExtendedOperator<dim>::Stress
  ExtendedOperator<dim>::stress(const unsigned int           c,
                                const std::vector<Gradient> &gradients,
                                const ExtendedVector        &cartesian_u) const
  {
    const Cell &cell     = cells[c];
    Stress      gradient = {};
    for (unsigned int n = 0; n < gradients.size(); ++n)
      for (unsigned int d = 0; d < dim; ++d)
        {
          const long double difference =
            cartesian_u(dofs(c, n + 1)[d]) - cartesian_u(dofs(c, 0)[d]);
          for (unsigned int e = 0; e < dim; ++e)
            gradient[d][e] += difference * gradients[n][e];
        }

    long double trace = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      trace += gradient[d][d];
    Stress sigma;
    for (unsigned int d = 0; d < dim; ++d)
      for (unsigned int e = 0; e < dim; ++e)
        sigma[d][e] = cell.mu * (gradient[d][e] + gradient[e][d]) +
                      (d == e ? cell.lambda * trace : 0.L);
    return sigma;
  }



  template class ExtendedOperator<2>;
  template class ExtendedOperator<3>;
} // namespace Debond
