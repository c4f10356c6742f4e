// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature.h>

#include <debond/elasticity/load_vector.h>
#include <debond/elasticity/side_moments.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace Debond
{
  namespace
  {
    /// How far a traction may be from a linear one, relative to it.
    constexpr double traction_rounding = 1e-10;



    /// The work-conjugates of a side's unknowns, relative to its length or
    /// area, of a linear traction with these values at the corners: vector by
    /// vector, see EquilibriumElement.
    std::array<dealii::Tensor<1, 2>, 2>
    conjugates(const std::array<dealii::Tensor<1, 2>, 2> &at_corners)
    {
      return {{0.5 * (at_corners[0] + at_corners[1]),
               (at_corners[1] - at_corners[0]) / 6.}};
    }



    std::array<dealii::Tensor<1, 3>, 3>
    conjugates(const std::array<dealii::Tensor<1, 3>, 3> &at_corners)
    {
      return {{at_corners[0] / 3., at_corners[1] / 3., at_corners[2] / 3.}};
    }
  } // namespace



  template <int dim>
  SideTraction<dim>
  side_traction(
    const std::function<dealii::Tensor<1, dim>(const dealii::Point<dim> &)>
                                              &traction,
    const std::array<dealii::Point<dim>, dim> &corners)
  {
    static const dealii::Quadrature<dim - 1> rule =
      face_rule<dim>(parts_of_a_face<dim>);
    std::vector<std::array<double, dim>> barycentric(rule.size());
    std::vector<dealii::Tensor<1, dim>>  values(rule.size());

    // At the corners the linear function with the same moments.
    std::array<dealii::Tensor<1, dim>, dim> linear;
    for (unsigned int q = 0; q < rule.size(); ++q)
      {
        dealii::Point<dim> place = corners[0];
        barycentric[q][0]        = 1.;
        for (unsigned int k = 1; k < dim; ++k)
          {
            barycentric[q][k] = rule.point(q)[k - 1];
            barycentric[q][0] -= barycentric[q][k];
            place += barycentric[q][k] * (corners[k] - corners[0]);
          }
        values[q] = traction(place);
        for (unsigned int k = 0; k < dim; ++k)
          for (unsigned int l = 0; l < dim; ++l)
            linear[l] += (dim - 1.) * rule.weight(q) * dim * barycentric[q][k] *
                         ((k == l ? dim + 1. : 0.) - 1.) * values[q];
      }

    double largest = 0., square = 0.;
    for (unsigned int q = 0; q < rule.size(); ++q)
      {
        dealii::Tensor<1, dim> rest = values[q];
        for (unsigned int k = 0; k < dim; ++k)
          rest -= barycentric[q][k] * linear[k];
        largest = std::max(largest, values[q].norm());
        square += (dim - 1.) * rule.weight(q) * rest.norm_square();
      }
    if (std::sqrt(square) <= traction_rounding * largest)
      square = 0.;
    return {conjugates(linear), square};
  }



  std::array<dealii::Tensor<1, 2>, 2>
  side_unknowns(const CellDisplacement<2>::OnSide &u)
  {
    return {{1. / 3. * (u[0] + u[1] + u[2]), 0.5 * (u[1] - u[0])}};
  }



  std::array<dealii::Tensor<1, 3>, 3>
  side_unknowns(const CellDisplacement<3>::OnSide &u)
  {
    dealii::Tensor<1, 3> sum;
    for (const dealii::Tensor<1, 3> &coefficient : u)
      sum += coefficient;
    std::array<dealii::Tensor<1, 3>, 3> result;
    // 3 int lambda_k of the basis is 3/10 of the corner, 1/5 of the edges
    // that meet there, and 1/10 of the others.
    for (unsigned int k = 0; k < 3; ++k)
      {
        result[k] = sum + 2. * u[k];
        for (unsigned int e = 0; e < 3; ++e)
          if (simplex_edges[e][0] == k || simplex_edges[e][1] == k)
            result[k] += u[3 + e];
        result[k] *= 0.1;
      }
    return result;
  }


  template decltype(side_traction<2>) side_traction<2>;
  template decltype(side_traction<3>) side_traction<3>;
} // namespace Debond
