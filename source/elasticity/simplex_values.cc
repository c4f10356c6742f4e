// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/simplex_values.h>

#include <cmath>

namespace Debond
{
  template <int dim>
  SimplexValues<dim>::SimplexValues(const dealii::FiniteElement<dim> &element,
                                    const dealii::Quadrature<dim>    &rule,
                                    const Symmetry                    symmetry)
    : rule(rule)
    , symmetry(symmetry)
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
    origin = cell.vertex(0);
    for (unsigned int d = 0; d < dim; ++d)
      edges[d] = cell.vertex(d + 1) - origin;
    jacobian = std::abs(dealii::determinant(edges));
    const dealii::Tensor<2, dim> inverse =
      dealii::transpose(dealii::invert(edges));
    barycentric[0] = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      {
        barycentric[d + 1] = inverse[d];
        barycentric[0] -= inverse[d];
      }
    for (unsigned int i = 0; i < gradients.size(); ++i)
      gradients[i] = reference_gradients[i] * inverse;
  }



  template class SimplexValues<2>;
  template class SimplexValues<3>;
} // namespace Debond
