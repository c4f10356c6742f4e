// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_cell_displacement_h
#define debond_elasticity_cell_displacement_h

#include <debond/elasticity/cell_nodes.h>
#include <debond/elasticity/elastic_problem.h>
#include <debond/linear_algebra/dof_vector.h>

#include <vector>

namespace Debond
{
  /// A displacement of degree 1 or 2 on a triangle: its Cartesian coefficients,
  /// see bernstein().
  struct CellDisplacement
  {
    static constexpr unsigned int maximum = CellNodes<2>::maximum;

    unsigned int                              degree;
    std::array<unsigned int, 3>               vertices;
    std::array<dealii::Tensor<1, 2>, maximum> coefficients;

    /// All functions of the basis have the same mean.
    dealii::Tensor<1, 2>
    mean() const
    {
      const unsigned int   n = n_coefficients(3, degree);
      dealii::Tensor<1, 2> sum;
      for (unsigned int k = 0; k < n; ++k)
        sum += coefficients[k];
      return sum / static_cast<double>(n);
    }

    dealii::SymmetricTensor<2, 2>
    strain(const BernsteinSimplex<2>   &simplex,
           const std::array<double, 3> &barycentric) const
    {
      dealii::Tensor<2, 2> gradient;
      for (unsigned int k = 0; k < simplex.n_nodes; ++k)
        gradient +=
          outer_product(coefficients[k], simplex.gradient(k, barycentric));
      return symmetrize(gradient);
    }

    /// Values at the first, the middle and the last point of the side between
    /// two vertices.
    std::array<dealii::Tensor<1, 2>, 3>
    on_side(const std::array<unsigned int, 2> &ends) const
    {
      std::array<unsigned int, 2> local = {};
      for (unsigned int v = 0; v < 3; ++v)
        for (unsigned int k = 0; k < 2; ++k)
          if (vertices[v] == ends[k])
            local[k] = v;
      const dealii::Tensor<1, 2> &first  = coefficients[local[0]];
      const dealii::Tensor<1, 2> &last   = coefficients[local[1]];
      dealii::Tensor<1, 2>        middle = 0.5 * (first + last);
      if (degree == 2)
        middle = 0.5 * middle +
                 0.5 * coefficients[3 + edge_between(local[0], local[1])];
      return {{first, middle, last}};
    }
  };



  /// That of a problem, in the order of the active cells.
  inline std::vector<CellDisplacement>
  cell_displacements(const ElasticProblem<2> &problem, const DofVector &u)
  {
    const DofVector cartesian = problem.unknowns().cartesian_displacement(u);
    std::vector<CellDisplacement> result;
    for (const auto &cell :
         problem.unknowns().dof_handler().active_cell_iterators())
      {
        const CellNodes<2> nodes(cell);
        CellDisplacement   own = {problem.unknowns().degree(),
                                  {{cell->vertex_index(0),
                                    cell->vertex_index(1),
                                    cell->vertex_index(2)}},
                                  {}};
        for (unsigned int k = 0; k < nodes.size; ++k)
          for (unsigned int d = 0; d < 2; ++d)
            own.coefficients[k][d] = cartesian(nodes.dofs[k][d]);
        result.push_back(own);
      }
    return result;
  }
} // namespace Debond

#endif
