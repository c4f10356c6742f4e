// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/contact/bernstein.h>
#include <debond/elasticity/extended_operator.h>

#include <algorithm>
#include <cmath>

namespace Debond
{
  template <int dim>
  ExtendedOperator<dim>::ExtendedOperator(
    const ElasticProblem<dim> &elastic_problem)
    : problem(elastic_problem)
  {
    make_reference_gradients();
    cells.reserve(
      problem.unknowns().dof_handler().get_triangulation().n_active_cells());
    for (const auto &dof_cell :
         problem.unknowns().dof_handler().active_cell_iterators())
      {
        Cell cell;
        cell.dofs.resize(dof_cell->get_fe().dofs_per_cell);
        dof_cell->get_dof_indices(cell.dofs);

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
  void
  ExtendedOperator<dim>::make_reference_gradients()
  {
    if (problem.unknowns().degree() == 1)
      {
        reference_gradients.emplace_back(dim, Gradient{});
        for (unsigned int d = 0; d < dim; ++d)
          reference_gradients[0][d][d] = 1.L;
        return;
      }
    // The points and gradients of strain_rule() and FE_SimplexP, which have the
    // digits of double only: next to each vertex one point, where the others'
    // coordinates are small.
    const long double small =
      dim == 2 ? 1.L / 6.L : (5.L - std::sqrt(5.L)) / 20.L;
    for (unsigned int q = 0; q <= dim; ++q)
      {
        const auto coordinate = [&](const unsigned int v) {
          return v == q ? 1.L - dim * small : small;
        };
        // Of a barycentric coordinate by another one, or by the first one's.
        const auto derivative = [](const unsigned int v, const unsigned int d) {
          return v == 0 ? -1.L : v == d + 1 ? 1.L : 0.L;
        };
        reference_gradients.emplace_back();
        for (unsigned int v = 1; v <= dim; ++v)
          {
            reference_gradients[q].emplace_back();
            for (unsigned int d = 0; d < dim; ++d)
              reference_gradients[q].back()[d] =
                (4.L * coordinate(v) - 1.L) * derivative(v, d);
          }
        for (unsigned int l = 0; l < n_simplex_edges(dim + 1); ++l)
          {
            const auto &[a, b] = simplex_edges[l];
            reference_gradients[q].emplace_back();
            for (unsigned int d = 0; d < dim; ++d)
              reference_gradients[q].back()[d] =
                4.L * (coordinate(a) * derivative(b, d) +
                       coordinate(b) * derivative(a, d));
          }
      }
  }



  template <int dim>
  ExtendedVector
  ExtendedOperator<dim>::operator*(const ExtendedVector &u) const
  {
    const ExtendedVector  displacement = cartesian(u);
    ExtendedVector        forces       = ExtendedVector::Zero(u.size());
    std::vector<Gradient> gradients;
    for (const Cell &cell : cells)
      for (unsigned int q = 0; q < reference_gradients.size(); ++q)
        {
          make_gradients(cell, q, gradients);
          const Stress sigma = stress(cell, gradients, displacement);
          for (unsigned int d = 0; d < dim; ++d)
            for (unsigned int n = 0; n < gradients.size(); ++n)
              {
                long double force = 0.;
                for (unsigned int e = 0; e < dim; ++e)
                  force += sigma[d][e] * gradients[n][e];
                force *= cell.volume / reference_gradients.size();
                forces(cell.dofs[(n + 1) * dim + d]) += force;
                forces(cell.dofs[d]) -= force;
              }
        }

    problem.unknowns().edges().forces_to_conjugates(forces);
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
    for (const Cell &cell : cells)
      for (unsigned int q = 0; q < reference_gradients.size(); ++q)
        {
          make_gradients(cell, q, gradients);
          const Stress exact = stress(cell, gradients, displacement);
          const Stress other = stress(cell, gradients, rounded);
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
    problem.unknowns().edges().to_values(result);
    return result;
  }



  template <int dim>
  void
  ExtendedOperator<dim>::make_gradients(const Cell            &cell,
                                        const unsigned int     point,
                                        std::vector<Gradient> &gradients) const
  {
    gradients.assign(reference_gradients[point].size(), Gradient{});
    for (unsigned int n = 0; n < gradients.size(); ++n)
      for (unsigned int v = 0; v < dim; ++v)
        for (unsigned int d = 0; d < dim; ++d)
          gradients[n][d] +=
            reference_gradients[point][n][v] * cell.gradients[v][d];
  }



  template <int dim>
  typename ExtendedOperator<dim>::Stress
  ExtendedOperator<dim>::stress(const Cell                  &cell,
                                const std::vector<Gradient> &gradients,
                                const ExtendedVector        &cartesian_u) const
  {
    Stress gradient = {};
    for (unsigned int n = 0; n < gradients.size(); ++n)
      for (unsigned int d = 0; d < dim; ++d)
        {
          const long double difference =
            cartesian_u(cell.dofs[(n + 1) * dim + d]) -
            cartesian_u(cell.dofs[d]);
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
