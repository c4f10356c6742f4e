// SPDX-License-Identifier: LGPL-2.1-or-later

#include <debond/base/instantiate.h>
#include <debond/base/tolerances.h>
#include <debond/certify/side_moments.h>
#include <debond/elasticity/load_vector.h>

#include <cmath>

namespace Debond
{
  namespace
  {
    /// face_rule() with so many parts.
    template <int dim>
    SideRule<dim>
    make_rule(const unsigned int n_parts)
    {
      // Weights of the reference face add up to 1, or to 1/2 for a triangle,
      // whose measure is taken out here. The first barycentric coordinate is
      // what the others leave of 1.
      const dealii::Quadrature<dim - 1> rule = face_rule<dim>(n_parts);
      SideRule<dim>                     points;
      for (unsigned int q = 0; q < rule.size(); ++q)
        {
          points.push_back({{}, (dim - 1.) * rule.weight(q)});
          points.back().first[0] = 1.;
          for (unsigned int k = 1; k < dim; ++k)
            {
              points.back().first[k] = rule.point(q)[k - 1];
              points.back().first[0] -= rule.point(q)[k - 1];
            }
        }
      return points;
    }
  } // namespace



  template <int dim>
  SideTraction<dim>
  side_traction(
    const std::function<dealii::Tensor<1, dim>(const dealii::Point<dim> &)>
                                              &traction,
    const std::array<dealii::Point<dim>, dim> &corners)
  {
    // The rule is that of load_vector(), so that a traction that jumps on a
    // side has the same moments here and in f. The moments with dim lambda_k of
    // the linear function with the values t_l at the corners are sum_l (1 +
    // delta_kl) t_l / (dim + 1), and the inverse of that matrix is (dim + 1)
    // delta_kl - 1.
    static const SideRule<dim> rule = make_rule<dim>(parts_of_a_face<dim>);

    // The values at the corners of the linear function with the same moments.
    std::array<dealii::Tensor<1, dim>, dim> linear;
    std::vector<dealii::Tensor<1, dim>>     values;
    double                                  largest = 0., square = 0.;
    for (const auto &[barycentric, weight] : rule)
      {
        dealii::Point<dim> place = corners[0];
        for (unsigned int k = 1; k < dim; ++k)
          place += barycentric[k] * (corners[k] - corners[0]);
        values.push_back(traction(place));
        largest = std::max(largest, values.back().norm());
        for (unsigned int k = 0; k < dim; ++k)
          for (unsigned int l = 0; l < dim; ++l)
            linear[l] += weight * dim * barycentric[k] *
                         ((k == l ? dim + 1. : 0.) - 1.) * values.back();
      }
    auto value = values.begin();
    for (const auto &[barycentric, weight] : rule)
      {
        // The mean square of what the linear function leaves, by the same rule.
        dealii::Tensor<1, dim> rest = *value++;
        for (unsigned int k = 0; k < dim; ++k)
          rest -= barycentric[k] * linear[k];
        square += weight * rest.norm_square();
      }
    // What rounding leaves of a linear traction is no rest.
    if (std::sqrt(square) <= Tolerance::linear_data * largest)
      square = 0.;
    return {linear, square};
  }



  template <int dim>
  SideDisplacement<dim>::SideDisplacement(
    const ElasticUnknowns<dim>                               &unknowns,
    const DofVector                                          &displacement,
    const typename dealii::Triangulation<dim>::cell_iterator &cell,
    const std::array<unsigned int, dim>                      &vertices)
    : fe(unknowns.dof_handler().get_fe())
    , values(fe.dofs_per_cell)
  {
    // The values at all nodes of the cell, whose shape functions are evaluated
    // at places on the reference cell: the trace for degree 1 and 2 alike.
    const auto &dofs = unknowns.dof_handler();
    const typename dealii::DoFHandler<dim>::active_cell_iterator dof_cell(
      &dofs.get_triangulation(), cell->level(), cell->index(), &dofs);
    dof_cell->get_dof_values(displacement, values);
    const auto reference_cell = dof_cell->reference_cell();
    for (unsigned int k = 0; k < dim; ++k)
      for (const unsigned int v : dof_cell->vertex_indices())
        if (dof_cell->vertex_index(v) == vertices[k])
          corners[k] = reference_cell.template vertex<dim>(v);
  }



  template <int dim>
  dealii::Tensor<1, dim>
  SideDisplacement<dim>::operator()(
    const std::array<double, dim> &barycentric) const
  {
    dealii::Point<dim> point;
    for (unsigned int k = 0; k < dim; ++k)
      point += barycentric[k] * corners[k];
    dealii::Tensor<1, dim> result;
    for (unsigned int i = 0; i < values.size(); ++i)
      result[fe.system_to_component_index(i).first] +=
        fe.shape_value(i, point) * values(i);
    return result;
  }



  template <int dim>
  const SideRule<dim> &
  side_rule()
  {
    // One part will do, since displacements are polynomials on a side.
    static const SideRule<dim> rule = make_rule<dim>(1);
    return rule;
  }



  template <int dim>
  std::array<dealii::Tensor<1, dim>, dim>
  side_unknowns(const SideDisplacement<dim> &u)
  {
    std::array<dealii::Tensor<1, dim>, dim> result;
    for (const auto &[barycentric, weight] : side_rule<dim>())
      {
        // Weights add up to 1, so that these are means over the side.
        const dealii::Tensor<1, dim> here = weight * u(barycentric);
        for (unsigned int k = 0; k < dim; ++k)
          result[k] += dim * barycentric[k] * here;
      }
    return result;
  }



  DEBOND_INSTANTIATE_CLASS(SideDisplacement);
  DEBOND_INSTANTIATE(side_rule);
  DEBOND_INSTANTIATE(side_unknowns);
  DEBOND_INSTANTIATE(side_traction);
} // namespace Debond
