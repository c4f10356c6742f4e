// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/mesh/owned_cells.h>
#include <debond/solve/minimum/extended_operator.h>

#include <numeric>

namespace Debond
{
  template <int dim>
  ExtendedOperator<dim>::ExtendedOperator(
    const ElasticProblem<dim> &elastic_problem)
    : problem(elastic_problem)
  {
    // What a cell needs is kept in extended precision: the gradients of its
    // barycentric coordinates, its volume and its moduli. The moduli are data,
    // for which double precision is enough: rounding them changes the stresses
    // of a cell by the same part, and leaves rigid motions without stress.
    make_reference_gradients();
    for (const auto &dof_cell : owned_cells(problem.unknowns().dof_handler()))
      {
        Cell cell;
        cell.dofs.resize(dof_cell->get_fe().dofs_per_cell);
        dof_cell->get_dof_indices(cell.dofs);

        // Row v of edges is the edge to vertex v + 1, and the columns of its
        // inverse are the gradients of the barycentric coordinates but the
        // first. Differences of coordinates are taken in extended precision,
        // since rounded gradients would spoil all that follows: a rigid motion
        // has to have no stress.
        dealii::Tensor<2, dim, long double> edges;
        for (unsigned int v = 0; v < dim; ++v)
          for (unsigned int d = 0; d < dim; ++d)
            edges[v][d] = static_cast<long double>(dof_cell->vertex(v + 1)[d]) -
                          dof_cell->vertex(0)[d];
        cell.gradients = dealii::invert(edges);
        cell.volume    = dealii::determinant(edges) / (dim == 2 ? 2 : 6);
        const Material &material = problem.fields().material(dof_cell);
        for (unsigned int v = 0; v <= dim && has_axis(); ++v)
          cell.radii[v] = dof_cell->vertex(v)[0];
        if (material.orthotropy || has_axis())
          cell.stiffness = &problem.fields().solid_tensor(dof_cell);
        else
          {
            cell.lambda = material.lame_lambda<dim>();
            cell.mu     = material.shear_modulus();
          }
        cells.push_back(cell);
      }
  }



  template <int dim>
  void
  ExtendedOperator<dim>::make_reference_gradients()
  {
    // The gradient of a barycentric coordinate by all but the first.
    const auto derivative = [](const unsigned int v) {
      Gradient result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = v == 0 ? -1.L : v == d + 1 ? 1.L : 0.L;
      return result;
    };
    if (problem.unknowns().degree() == 1)
      {
        // With linear displacements the strain is constant, and the rule has
        // the middle of the cell only.
        reference_gradients.emplace_back();
        for (unsigned int v = 1; v <= dim; ++v)
          reference_gradients[0].push_back(derivative(v));
        barycentric.emplace_back(dim + 1, 1.L / (dim + 1));
        reference_values = barycentric;
        return;
      }
    // The points and gradients of strain_rule() and FE_SimplexP, which have the
    // digits of double only.
    const long double small = near_vertex<dim, long double>();
    for (unsigned int q = 0; q <= dim; ++q)
      {
        const auto coordinate = [&](const unsigned int v) {
          return v == q ? 1.L - dim * small : small;
        };
        auto &gradients = reference_gradients.emplace_back();
        auto &values    = reference_values.emplace_back();
        barycentric.emplace_back();
        for (unsigned int v = 0; v <= dim; ++v)
          {
            barycentric.back().push_back(coordinate(v));
            values.push_back(coordinate(v) * (2.L * coordinate(v) - 1.L));
          }
        for (unsigned int v = 1; v <= dim; ++v)
          gradients.push_back((4.L * coordinate(v) - 1.L) * derivative(v));
        // Functions of the vertices are L (2 L - 1), those of the middles of
        // edges 4 L_a L_b, with barycentric coordinates L.
        for (unsigned int l = 0; l < n_simplex_edges(dim + 1); ++l)
          {
            const auto &[a, b] = simplex_edges[l];
            values.push_back(4.L * coordinate(a) * coordinate(b));
            gradients.push_back(4.L * (coordinate(a) * derivative(b) +
                                       coordinate(b) * derivative(a)));
          }
      }
  }



  template <int dim>
  ExtendedVector
  ExtendedOperator<dim>::operator*(const ExtendedVector &u) const
  {
    // Forces are summed up from the stresses of Cartesian displacements, cell
    // by cell, and the sum goes back to the unknowns of the scene: jumps,
    // frames and coefficients.
    const ExtendedVector displacement = problem.unknowns().basis().to_nodal(u);
    ExtendedVector       forces       = ExtendedVector::Zero(u.size());
    for (const Cell &cell : cells)
      add_forces(cell, displacement, forces);

    // Each rank has the forces of its own cells, and gets the sum of all.
    dealii::Utilities::MPI::sum(
      dealii::ArrayView<const long double>(forces.data(), forces.size()),
      problem.unknowns().communicator(),
      dealii::ArrayView<long double>(forces.data(), forces.size()));
    forces = problem.unknowns().basis().forces_to_unknowns(forces);
    for (unsigned int i = 0; i < forces.size(); ++i)
      if (problem.unknowns().is_constrained(i))
        forces(i) = 0.;
    return forces;
  }



  template <int dim>
  void
  ExtendedOperator<dim>::add_forces(const Cell           &cell,
                                    const ExtendedVector &displacement,
                                    ExtendedVector       &forces) const
  {
    // The forces of a cell in four steps: differences of the nodes'
    // displacements, the displacement gradient at each point of the rule, the
    // stress there, and its product with the gradients of the basis functions.
    // Displacements of all nodes but the first are counted from the first, so
    // that what neighbours have in common is gone before it is multiplied by a
    // modulus. The forces of these nodes are `of_nodes`.
    std::array<Gradient, most_nodes> differences, of_nodes = {};
    const auto n = static_cast<unsigned int>(reference_gradients[0].size());
    for (unsigned int k = 0; k < n; ++k)
      for (unsigned int d = 0; d < dim; ++d)
        differences[k][d] = displacement(cell.dofs[(k + 1) * dim + d]) -
                            displacement(cell.dofs[d]);
    for (unsigned int q = 0; q < reference_gradients.size(); ++q)
      {
        // Derivatives are taken by barycentric coordinates, whose gradients
        // take them to space; the stress goes back the same way.
        dealii::Tensor<2, dim, long double> by_coordinates, to_coordinates;
        for (unsigned int k = 0; k < n; ++k)
          by_coordinates +=
            outer_product(differences[k], reference_gradients[q][k]);
        const auto in_space = by_coordinates * transpose(cell.gradients);
        Stress     gradient;
        for (unsigned int d = 0; d < dim; ++d)
          for (unsigned int e = 0; e < dim; ++e)
            gradient[d][e] = in_space[d][e];
        // The points of the rule have equal weights. Around an axis these are
        // multiplied by 2 pi r, and the strain u_r / r is that of all nodes.
        long double weight = cell.volume / reference_gradients.size();
        if (has_axis())
          {
            const long double r = radius(cell, q);
            weight *= 2.L * dealii::numbers::PI * r;
            for (unsigned int k = 0; k <= n; ++k)
              gradient[2][2] +=
                displacement(cell.dofs[k * dim]) * reference_values[q][k] / r;
          }
        const Stress sigma = weight * stress(cell, gradient);
        // What pulls around the axis acts on all nodes, for displacements that
        // neighbours have in common strain it as well.
        if (has_axis())
          for (unsigned int k = 0; k <= n; ++k)
            forces(cell.dofs[k * dim]) +=
              sigma[2][2] * reference_values[q][k] / radius(cell, q);
        for (unsigned int d = 0; d < dim; ++d)
          for (unsigned int e = 0; e < dim; ++e)
            for (unsigned int f = 0; f < dim; ++f)
              to_coordinates[d][e] += sigma[d][f] * cell.gradients[f][e];
        for (unsigned int k = 0; k < n; ++k)
          of_nodes[k] += to_coordinates * reference_gradients[q][k];
      }
    // The first node has minus the sum of the others' forces, so that each cell
    // is in equilibrium. Rows of an assembled matrix have that only to the
    // rounding of their entries.
    for (unsigned int k = 0; k < n; ++k)
      for (unsigned int d = 0; d < dim; ++d)
        {
          forces(cell.dofs[(k + 1) * dim + d]) += of_nodes[k][d];
          forces(cell.dofs[d]) -= of_nodes[k][d];
        }
  }



  template <int dim>
  long double
  ExtendedOperator<dim>::radius(const Cell        &cell,
                                const unsigned int point) const
  {
    // The radius is linear in a cell.
    return std::inner_product(cell.radii.begin(),
                              cell.radii.end(),
                              barycentric[point].begin(),
                              0.L);
  }



  template <int dim>
  dealii::Tensor<2, 3, long double>
  ExtendedOperator<dim>::stress(const Cell &cell, const Stress &gradient) const
  {
    if (cell.stiffness != nullptr)
      {
        // With the symmetries of C the product with the displacement gradient
        // is that with the strain. The component 2, 2 is the one around the
        // axis; in the plane no force is made of it.
        Stress      sigma;
        const auto &C = *cell.stiffness;
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            {
              for (unsigned int k = 0; k < dim; ++k)
                for (unsigned int l = 0; l < dim; ++l)
                  sigma[i][j] +=
                    static_cast<long double>(C[i][j][k][l]) * gradient[k][l];
              if (has_axis())
                {
                  sigma[i][j] += C[i][j][2][2] * gradient[2][2];
                  sigma[2][2] += C[2][2][i][j] * gradient[i][j];
                }
            }
        if (has_axis())
          sigma[2][2] += C[2][2][2][2] * gradient[2][2];
        return sigma;
      }
    // Isotropic: lambda div u I + 2 mu epsilon.
    Stress            sigma;
    const long double trace = dealii::trace(gradient);
    for (unsigned int d = 0; d < dim; ++d)
      {
        for (unsigned int e = 0; e < dim; ++e)
          sigma[d][e] = cell.mu * (gradient[d][e] + gradient[e][d]);
        sigma[d][d] += cell.lambda * trace;
      }
    return sigma;
  }



  DEBOND_INSTANTIATE_CLASS(ExtendedOperator);
} // namespace Debond
