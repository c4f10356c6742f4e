// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/simplex_values.h>

#include <cmath>

namespace Debond
{
  template <int dim>
  SimplexValues<dim>::SimplexValues(const dealii::FiniteElement<dim> &element,
                                    const dealii::Quadrature<dim>    &rule)
    : rule(rule)
    , nodes(element.dofs_per_cell)
    , gradients(rule.size() * nodes)
  {
    for (const dealii::Point<dim> &point : rule.get_points())
      for (unsigned int k = 0; k < nodes; ++k)
        {
          shape_values.push_back(element.shape_value(k, point));
          reference_gradients.push_back(element.shape_grad(k, point));
        }
  }



  template <int dim>
  void
  SimplexValues<dim>::reinit(const dealii::TriaAccessor<dim, dim, dim> &cell)
  {
    for (unsigned int v = 0; v <= dim; ++v)
      vertices[v] = cell.vertex(v);
    dealii::Tensor<2, dim> edges;
    for (unsigned int d = 0; d < dim; ++d)
      edges[d] = vertices[d + 1] - vertices[0];
    jacobian                             = std::abs(dealii::determinant(edges));
    const dealii::Tensor<2, dim> inverse = dealii::invert(edges);
    barycentric[0]                       = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      {
        for (unsigned int c = 0; c < dim; ++c)
          barycentric[d + 1][c] = inverse[c][d];
        barycentric[0] -= barycentric[d + 1];
      }
    for (unsigned int i = 0; i < gradients.size(); ++i)
      {
        dealii::Tensor<1, dim> sum;
        for (unsigned int d = 0; d < dim; ++d)
          sum += reference_gradients[i][d] * barycentric[d + 1];
        gradients[i] = sum;
      }
  }



  template <int dim>
  dealii::Point<dim>
  SimplexValues<dim>::quadrature_point(const unsigned int q) const
  {
    const dealii::Point<dim> &unit_point = rule.point(q);
    dealii::Point<dim>        result     = vertices[0];
    for (unsigned int d = 0; d < dim; ++d)
      result += unit_point[d] * (vertices[d + 1] - vertices[0]);
    return result;
  }



  template class SimplexValues<2>;
  template class SimplexValues<3>;
} // namespace Debond
