// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_simplex_values_h
#define debond_elasticity_simplex_values_h

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/std_cxx20/iota_view.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/fe/fe.h>
#include <deal.II/grid/tria_accessor.h>

#include <debond/mesh/symmetry.h>

#include <array>
#include <cmath>
#include <vector>

namespace Debond
{
  /// All barycentric coordinates but one of a point of strain_rule() of degree
  /// 2: each of the points is next to a vertex, which has the other one.
  template <int dim, typename Number>
  Number
  near_vertex()
  {
    return dim == 2 ? Number(1) / 6 : (5 - std::sqrt(Number(5))) / 20;
  }



  /// The rule that integrates products of two strains: one point of degree 1,
  /// dim + 1 points of degree 2, in the order of the vertices; QGaussSimplex
  /// would have more.
  template <int dim>
  dealii::Quadrature<dim>
  strain_rule(const unsigned int degree)
  {
    if (degree == 1)
      return dealii::QGaussSimplex<dim>(1);
    const double                    small = near_vertex<dim, double>();
    std::vector<dealii::Point<dim>> points(dim + 1);
    for (unsigned int q = 0; q <= dim; ++q)
      for (unsigned int d = 0; d < dim; ++d)
        points[q][d] = q == d + 1 ? 1. - dim * small : small;
    return {points,
            std::vector<double>(dim + 1, 1. / (dim == 2 ? 2 * 3 : 6 * 4))};
  }



  /// The values at a point of the reference cell of the functions through which
  /// values at the points of strain_rule() make a function on the cell: one
  /// that is constant, of degree 2 linear.
  template <int dim>
  std::vector<double>
  strain_functions(const unsigned int        degree,
                   const dealii::Point<dim> &unit_point)
  {
    if (degree == 1)
      return {1.};
    const double        small = near_vertex<dim, double>();
    std::vector<double> barycentric(1, 1.);
    for (unsigned int d = 0; d < dim; ++d)
      {
        barycentric.push_back(unit_point[d]);
        barycentric[0] -= unit_point[d];
      }
    for (double &coordinate : barycentric)
      coordinate = (coordinate - small) / (1. - (dim + 1) * small);
    return barycentric;
  }



  /// This is dealii::FEValues for a scalar element on simplices with straight
  /// sides: all follows from the gradients of the barycentric coordinates,
  /// which takes much less time than a mapping that may be curved. Of a body of
  /// revolution it knows the way around the axis.
  template <int dim>
  class SimplexValues
  {
  public:
    SimplexValues(const dealii::FiniteElement<dim> &element,
                  const dealii::Quadrature<dim>    &rule,
                  const Symmetry                    symmetry);

    void
    reinit(const dealii::TriaAccessor<dim, dim, dim> &cell);

    const dealii::Quadrature<dim> &
    get_quadrature() const
    {
      return rule;
    }

    auto
    quadrature_point_indices() const
    {
      return dealii::std_cxx20::ranges::iota_view<unsigned int, unsigned int>(
        0U, rule.size());
    }

    /// The number of nodes of the element.
    unsigned int
    n_nodes() const
    {
      return nodes;
    }

    double
    shape_value(const unsigned int node, const unsigned int q) const
    {
      return shape_values[q * nodes + node];
    }

    const dealii::Tensor<1, dim> &
    shape_grad(const unsigned int node, const unsigned int q) const
    {
      return gradients[q * nodes + node];
    }

    /// The forces of a stress on the components of a node, per volume: its work
    /// on the strains that they make.
    dealii::Tensor<1, dim>
    force(const dealii::SymmetricTensor<2, 3> &stress,
          const unsigned int                   node,
          const unsigned int                   q) const
    {
      const dealii::Tensor<1, dim> &gradient = shape_grad(node, q);
      dealii::Tensor<1, dim>        result;
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int d = 0; d < dim; ++d)
          result[c] += stress[c][d] * gradient[d];
      if (has_axis())
        result[0] += stress[2][2] * hoop_strain(node, q);
      return result;
    }

    /// The strain of the solid that a component of a node makes.
    dealii::SymmetricTensor<2, 3>
    strain(const unsigned int node,
           const unsigned int component,
           const unsigned int q) const
    {
      const dealii::Tensor<1, dim> &gradient = shape_grad(node, q);
      dealii::SymmetricTensor<2, 3> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[component][d] = (d == component ? 1. : 0.5) * gradient[d];
      if (component == 0 && has_axis())
        result[2][2] = hoop_strain(node, q);
      return result;
    }

    bool
    has_axis() const
    {
      return symmetry == Symmetry::axis;
    }

    /// The strain u_r / r around the axis that the radial component of a node
    /// makes, by strain_functions() through its values at the points where the
    /// energy is; zero without an axis.
    double
    hoop_strain(const unsigned int node, const unsigned int q) const
    {
      return has_axis() ? hoop_strains[q * nodes + node] : 0.;
    }

    double
    JxW(const unsigned int q) const
    {
      return jacobian * rule.weight(q) *
             (has_axis() ? circumference(symmetry, quadrature_point(q)) : 1.);
    }

    dealii::Point<dim>
    quadrature_point(const unsigned int q) const
    {
      return origin + rule.point(q) * edges;
    }

    /// The area of the cell, also of a body of revolution, or its volume.
    double
    measure() const
    {
      return jacobian / (dim == 2 ? 2. : 6.);
    }

    /// The gradient of the barycentric coordinate that is one at a vertex of
    /// the cell.
    const dealii::Tensor<1, dim> &
    barycentric_gradient(const unsigned int vertex) const
    {
      return barycentric[vertex];
    }

  private:
    const dealii::Quadrature<dim>       rule;
    const Symmetry                      symmetry;
    const unsigned int                  nodes;
    std::vector<double>                 shape_values;
    std::vector<dealii::Tensor<1, dim>> reference_gradients;

    /// With an axis: the points of strain_rule(), and for each of them the
    /// values of the element there and of strain_functions() at the points of
    /// the rule.
    std::vector<dealii::Point<dim>>  strain_points;
    std::vector<std::vector<double>> strain_values, functions;

    // Of the cell.
    dealii::Point<dim>                          origin;
    dealii::Tensor<2, dim>                      edges; ///< from the origin
    double                                      jacobian = 0.;
    std::array<dealii::Tensor<1, dim>, dim + 1> barycentric;
    std::vector<dealii::Tensor<1, dim>>         gradients;
    std::vector<double>                         hoop_strains;
  };
} // namespace Debond

#endif
