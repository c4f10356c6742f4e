// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_cell_displacement_h
#define debond_elasticity_cell_displacement_h

#include <debond/elasticity/cell_nodes.h>
#include <debond/elasticity/elastic_problem.h>
#include <debond/linear_algebra/dof_vector.h>

#include <vector>

namespace Debond
{
  /// A displacement of degree 1 or 2 on a simplex: its Cartesian coefficients,
  /// see bernstein().
  template <int dim>
  struct CellDisplacement
  {
    static constexpr unsigned int maximum = CellNodes<dim>::maximum;

    /// The coefficients of degree 2 on a side.
    using OnSide = std::array<dealii::Tensor<1, dim>, n_coefficients(dim, 2)>;

    unsigned int                                degree;
    std::array<unsigned int, dim + 1>           vertices;
    std::array<dealii::Tensor<1, dim>, maximum> coefficients;

    /// All functions of the basis have the same mean.
    dealii::Tensor<1, dim>
    mean() const
    {
      const unsigned int     n = n_coefficients(dim + 1, degree);
      dealii::Tensor<1, dim> sum;
      for (unsigned int k = 0; k < n; ++k)
        sum += coefficients[k];
      return sum / static_cast<double>(n);
    }

    dealii::SymmetricTensor<2, dim>
    strain(const BernsteinSimplex<dim>       &simplex,
           const std::array<double, dim + 1> &barycentric) const
    {
      dealii::Tensor<2, dim> gradient;
      for (unsigned int k = 0; k < simplex.n_nodes; ++k)
        gradient +=
          outer_product(coefficients[k], simplex.gradient(k, barycentric));
      return symmetrize(gradient);
    }

    /// On the side with these vertices, in their order.
    OnSide
    on_side(const std::array<unsigned int, dim> &corners) const
    {
      std::array<unsigned int, dim> local = {};
      for (unsigned int v = 0; v <= dim; ++v)
        for (unsigned int k = 0; k < dim; ++k)
          if (vertices[v] == corners[k])
            local[k] = v;
      OnSide result;
      for (unsigned int k = 0; k < dim; ++k)
        result[k] = coefficients[local[k]];
      for (unsigned int e = 0; e < n_simplex_edges(dim); ++e)
        {
          const auto &[a, b] = simplex_edges[e];
          result[dim + e] =
            degree == 2 ?
              coefficients[dim + 1 + edge_between(local[a], local[b])] :
              0.5 * (result[a] + result[b]);
        }
      return result;
    }
  };



  /// That of a problem, in the order of the active cells.
  template <int dim>
  std::vector<CellDisplacement<dim>>
  cell_displacements(const ElasticProblem<dim> &problem, const DofVector &u)
  {
    const DofVector cartesian = problem.unknowns().cartesian_displacement(u);
    std::vector<CellDisplacement<dim>> result;
    for (const auto &cell :
         problem.unknowns().dof_handler().active_cell_iterators())
      {
        const CellNodes<dim>  nodes(cell);
        CellDisplacement<dim> own = {problem.unknowns().degree(), {}, {}};
        for (unsigned int v = 0; v <= dim; ++v)
          own.vertices[v] = cell->vertex_index(v);
        for (unsigned int k = 0; k < nodes.size; ++k)
          for (unsigned int d = 0; d < dim; ++d)
            own.coefficients[k][d] = cartesian(nodes.dofs[k][d]);
        for (unsigned int k = dim + 1; k < nodes.size; ++k)
          {
            const auto &[a, b] = simplex_edges[k - (dim + 1)];
            own.coefficients[k] =
              2. * own.coefficients[k] -
              0.5 * (own.coefficients[a] + own.coefficients[b]);
          }
        result.push_back(own);
      }
    return result;
  }
} // namespace Debond

#endif
