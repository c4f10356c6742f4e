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
    for (const dealii::Point<dim> &point : rule.get_points())
      for (unsigned int k = 0; k < nodes; ++k)
        {
          shape_values.push_back(element.shape_value(k, point));
          reference_gradients.push_back(element.shape_grad(k, point));
        }
    if (!has_axis())
      return;
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
        const double radius = (origin + strain_points[p] * edges)[0];
        for (unsigned int i = 0; i < hoop_strains.size(); ++i)
          hoop_strains[i] +=
            functions[i / nodes][p] * strain_values[p][i % nodes] / radius;
      }
  }



  DEBOND_INSTANTIATE_CLASS(SimplexValues);
} // namespace Debond
