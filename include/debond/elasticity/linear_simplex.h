// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_linear_simplex_h
#define debond_elasticity_linear_simplex_h

#include <deal.II/base/tensor.h>

#include <array>

namespace Debond
{
  /// Volume of a simplex and the (constant) gradients of its P1 basis.
  template <int dim>
  struct LinearSimplex
  {
    template <typename CellIterator>
    explicit LinearSimplex(const CellIterator &cell)
    {
      dealii::Tensor<2, dim> edges;
      for (unsigned int d = 0; d < dim; ++d)
        edges[d] = cell->vertex(d + 1) - cell->vertex(0);
      volume = dealii::determinant(edges) / (dim == 2 ? 2. : 6.);

      const dealii::Tensor<2, dim> inverse = dealii::invert(edges);
      for (unsigned int v = 1; v <= dim; ++v)
        for (unsigned int d = 0; d < dim; ++d)
          gradients[v][d] = inverse[d][v - 1];
      for (unsigned int v = 1; v <= dim; ++v)
        gradients[0] -= gradients[v];
    }

    double                                      volume;
    std::array<dealii::Tensor<1, dim>, dim + 1> gradients;
  };
} // namespace Debond

#endif
