// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <debond/elasticity/side_moments.h>

#include <algorithm>
#include <type_traits>
#include <vector>

namespace Debond
{
  namespace
  {
    /// How far a traction may be from a linear one, relative to it.
    constexpr double traction_rounding = 1e-10;



    /// A point of a side with the part of it that belongs to it.
    template <int dim>
    struct SidePoint
    {
      std::array<double, dim> barycentric;
      double                  weight;
    };



    /// Many of them, in which no load can hide that is not linear.
    std::vector<SidePoint<2>>
    points_of_side(std::integral_constant<int, 2>)
    {
      constexpr unsigned int    parts = 16;
      const dealii::QGauss<1>   rule(3);
      std::vector<SidePoint<2>> result;
      for (unsigned int part = 0; part < parts; ++part)
        for (unsigned int q = 0; q < rule.size(); ++q)
          {
            const double t = (part + rule.point(q)[0]) / parts;
            result.push_back({{{1. - t, t}}, rule.weight(q) / parts});
          }
      return result;
    }



    std::vector<SidePoint<3>>
    points_of_side(std::integral_constant<int, 3>)
    {
      constexpr unsigned int         parts = 4;
      const dealii::QGaussSimplex<2> rule(3);
      std::vector<SidePoint<3>>      result;
      const auto add = [&](const double x, const double y, const double size) {
        for (unsigned int q = 0; q < rule.size(); ++q)
          {
            const double a = x + size * rule.point(q)[0];
            const double b = y + size * rule.point(q)[1];
            result.push_back(
              {{{1. - a - b, a, b}}, 2. * size * size * rule.weight(q)});
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



    /// The values at the corners of the linear function that has the same
    /// moments.
    template <int dim>
    std::array<dealii::Tensor<1, dim>, dim>
    linear_part(const std::vector<SidePoint<dim>>         &points,
                const std::vector<dealii::Tensor<1, dim>> &values)
    {
      std::array<dealii::Tensor<1, dim>, dim> result;
      for (unsigned int q = 0; q < points.size(); ++q)
        for (unsigned int k = 0; k < dim; ++k)
          // The function that is orthogonal to the other coordinates.
          result[k] += points[q].weight * dim *
                       ((dim + 1) * points[q].barycentric[k] - 1.) * values[q];
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
                const std::array<dealii::Point<dim>, dim> &corners)
  {
    static const std::vector<SidePoint<dim>> points =
      points_of_side(std::integral_constant<int, dim>());
    std::vector<dealii::Tensor<1, dim>> tractions;
    double                              largest = 0.;
    for (const SidePoint<dim> &point : points)
      {
        dealii::Point<dim> place;
        for (unsigned int k = 0; k < dim; ++k)
          place += point.barycentric[k] * corners[k];
        tractions.push_back(field_vector(traction, place));
        largest = std::max(largest, tractions.back().norm());
      }
    const auto        linear = linear_part<dim>(points, tractions);
    SideTraction<dim> result = {conjugates(linear), true};
    for (unsigned int q = 0; q < points.size(); ++q)
      {
        dealii::Tensor<1, dim> rest = tractions[q];
        for (unsigned int k = 0; k < dim; ++k)
          rest -= points[q].barycentric[k] * linear[k];
        result.is_linear =
          result.is_linear && rest.norm() <= traction_rounding * largest;
      }
    return result;
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
