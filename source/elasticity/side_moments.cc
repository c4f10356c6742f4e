// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <debond/elasticity/load_vector.h>
#include <debond/elasticity/side_moments.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

namespace Debond
{
  namespace
  {
    /// How far a traction may be from a linear one, relative to it.
    constexpr double traction_rounding = 1e-10;



    /// Barycentric coordinates of many points, so that no load can hide that is
    /// not linear.
    std::vector<std::array<double, 2>>
    points_of_side(std::integral_constant<int, 2>)
    {
      constexpr unsigned int             parts = 16;
      const dealii::QGauss<1>            rule(3);
      std::vector<std::array<double, 2>> result;
      for (unsigned int part = 0; part < parts; ++part)
        for (unsigned int q = 0; q < rule.size(); ++q)
          {
            const double t = (part + rule.point(q)[0]) / parts;
            result.push_back({{1. - t, t}});
          }
      return result;
    }



    std::vector<std::array<double, 3>>
    points_of_side(std::integral_constant<int, 3>)
    {
      constexpr unsigned int             parts = 4;
      const dealii::QGaussSimplex<2>     rule(3);
      std::vector<std::array<double, 3>> result;
      const auto add = [&](const double x, const double y, const double size) {
        for (unsigned int q = 0; q < rule.size(); ++q)
          {
            const double a = x + size * rule.point(q)[0];
            const double b = y + size * rule.point(q)[1];
            result.push_back({{1. - a - b, a, b}});
          }
      };
      for (unsigned int i = 0; i < parts; ++i)
        for (unsigned int j = 0; j < parts - i; ++j)
          {
            add(1. * i / parts, 1. * j / parts, 1. / parts);
            if (i + j + 1 < parts)
              add((i + 1.) / parts, (j + 1.) / parts, -1. / parts);
          }
      return result;
    }



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
  side_traction(const dealii::Function<dim>               &traction,
                const std::array<dealii::Point<dim>, dim> &corners,
                const unsigned int                         n_faces)
  {
    static const std::vector<std::array<double, dim>> points =
      points_of_side(std::integral_constant<int, dim>());
    // At the corners the linear function with the same moments.
    std::array<dealii::Tensor<1, dim>, dim> linear =
      traction_moments<dim>(traction, corners, n_faces);
    dealii::Tensor<1, dim> sum;
    for (const dealii::Tensor<1, dim> &moment : linear)
      sum += moment;
    for (dealii::Tensor<1, dim> &value : linear)
      value = dim * ((dim + 1.) * value - sum);
    double largest = 0., square = 0.;
    for (const std::array<double, dim> &barycentric : points)
      {
        dealii::Point<dim>     place;
        dealii::Tensor<1, dim> rest;
        for (unsigned int k = 0; k < dim; ++k)
          {
            place += barycentric[k] * corners[k];
            rest -= barycentric[k] * linear[k];
          }
        const dealii::Tensor<1, dim> value = field_vector(traction, place);
        largest                            = std::max(largest, value.norm());
        square +=
          (value + rest).norm_square() / static_cast<double>(points.size());
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
