// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/elasticity/simplex_values.h>

#include <algorithm>

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
    // What depends on the reference cell alone is computed once: values and
    // gradients of the shape functions at the points of the rule, for all
    // cells.
    for (const dealii::Point<dim> &point : rule.get_points())
      for (unsigned int k = 0; k < nodes; ++k)
        {
          shape_values.push_back(element.shape_value(k, point));
          reference_gradients.push_back(element.shape_grad(k, point));
        }
    if (!has_axis())
      return;
    // u_r / r is rational, not polynomial. Its values at the points of
    // strain_rule() define the hoop strain, and strain_functions() extend it to
    // other points of the cell. So the stresses of a cell are as many as in the
    // plane, and the axis, where r = 0, is no point at which it is evaluated.
    strain_points = strain_rule<dim>(element.degree).get_points();
    hoop_strains.resize(gradients.size());
    for (const dealii::Point<dim> &point : strain_points)
      {
        strain_values.emplace_back();
        for (unsigned int k = 0; k < nodes; ++k)
          strain_values.back().push_back(element.shape_value(k, point));
      }
    for (const dealii::Point<dim> &point : rule.get_points())
      functions.push_back(strain_functions<dim>(element.degree, point));
  }



  template <int dim>
  void
  SimplexValues<dim>::reinit(const dealii::TriaAccessor<dim, dim, dim> &cell)
  {
    origin = cell.vertex(0);
    // With the edges from vertex 0 as rows of E the map is x = x_0 + xi E, and
    // the gradient of xi_d is the row d of the transposed inverse. These are
    // the gradients of the barycentric coordinates of the vertices from 1 on;
    // all of them sum to zero. The determinant may be negative for cells in
    // another order, but the measure is not.
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
    std::fill(hoop_strains.begin(), hoop_strains.end(), 0.);
    for (unsigned int p = 0; p < strain_points.size(); ++p)
      {
        // The points are inside of the cell, so that the radius is positive
        // also in cells at the axis.
        const double radius = (origin + strain_points[p] * edges)[0];
        for (unsigned int i = 0; i < hoop_strains.size(); ++i)
          hoop_strains[i] +=
            functions[i / nodes][p] * strain_values[p][i % nodes] / radius;
      }
  }



  DEBOND_INSTANTIATE_CLASS(SimplexValues);
} // namespace Debond
