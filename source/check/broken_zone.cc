// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/check/broken_zone.h>

#include <algorithm>
#include <array>

namespace Debond
{
  namespace
  {
    /// The part of a simplex where a linear function with these values at the
    /// vertices is positive.
    template <std::size_t n>
    double
    positive_part(std::array<double, n> values)
    {
      std::sort(values.begin(), values.end());
      if (values.back() <= 0.)
        return 0.;
      if (values.front() >= 0.)
        return 1.;
      // The corner on the one side of zero that has only one vertex.
      const bool   one_is_positive = values[n - 2] <= 0.;
      const double corner = one_is_positive ? values.back() : values.front();
      double       part   = 1.;
      for (const double value : values)
        if (value != corner)
          part *= corner / (corner - value);
      return one_is_positive ? part : 1. - part;
    }



    /// The part of a face where a quadratic function with these coefficients
    /// (see bernstein()) is positive; where it changes sign, that of the linear
    /// interpolant on pieces.
    template <std::size_t n>
    double
    positive_part_of_quadratic(
      const std::array<double, n_coefficients(n, 2)> &coefficients,
      const unsigned int                              halvings)
    {
      const auto [least, largest] =
        std::minmax_element(coefficients.begin(), coefficients.end());
      if (*largest <= 0.)
        return 0.;
      if (*least >= 0.)
        return 1.;
      if (halvings == 0)
        {
          std::array<double, n> at_vertices;
          std::copy_n(coefficients.begin(), n, at_vertices.begin());
          return positive_part(at_vertices);
        }

      // The polar form at two points that are vertices or middles of edges.
      const auto polar = [&](const std::array<double, n> &x,
                             const std::array<double, n> &y) {
        double sum = 0.;
        for (unsigned int v = 0; v < n; ++v)
          sum += coefficients[v] * x[v] * y[v];
        for (unsigned int e = 0; e < n_simplex_edges(n); ++e)
          {
            const auto &[a, b] = simplex_edges[e];
            sum += coefficients[n + e] * (x[a] * y[b] + x[b] * y[a]);
          }
        return sum;
      };
      const auto part_of = [&](const std::array<std::array<double, n>, n> &x) {
        std::array<double, n_coefficients(n, 2)> piece;
        for (unsigned int v = 0; v < n; ++v)
          piece[v] = polar(x[v], x[v]);
        for (unsigned int e = 0; e < n_simplex_edges(n); ++e)
          piece[n + e] = polar(x[simplex_edges[e][0]], x[simplex_edges[e][1]]);
        return positive_part_of_quadratic<n>(piece, halvings - 1);
      };
      const auto middle = [](const unsigned int a, const unsigned int b) {
        std::array<double, n> point = {};
        point[a] += 0.5;
        point[b] += 0.5;
        return point;
      };
      // A piece at each vertex, of a triangle also that of the middles.
      double       sum      = 0.;
      unsigned int n_pieces = 0;
      for (unsigned int v = 0; v < n; ++v, ++n_pieces)
        {
          std::array<std::array<double, n>, n> corners;
          for (unsigned int w = 0; w < n; ++w)
            corners[w] = middle(v, w);
          sum += part_of(corners);
        }
      if constexpr (n == 3)
        {
          sum += part_of({{middle(0, 1), middle(1, 2), middle(2, 0)}});
          ++n_pieces;
        }
      return sum / n_pieces;
    }
  } // namespace



  template <int dim>
  double
  broken_zone(const ContactBoundary<dim>  &boundary,
              const AdhesiveLaw           &law,
              const AdhesionIntegral<dim> &adhesion,
              const VectorView            &s)
  {
    const unsigned int last = law.branches().size() - 1;
    // Bonds that hold at any distance are never broken.
    if (last == 0 && !law.is_loose(0))
      return 0.;

    if (adhesion.has_broken_points())
      return adhesion.open_measure(s);

    double sum = 0.;
    for (const auto &face : boundary.faces)
      {
        std::array<double, dim> threshold, beyond;
        for (unsigned int k = 0; k < dim; ++k)
          {
            const BondScale bonds = adhesion.bonds_at(face, k);
            const bool      is_loose =
              bonds.energy == 0. || adhesion.least_piece_at(face, k) == last;
            threshold[k] = is_loose ? 0. : law.bond_threshold() * bonds.stretch;
            beyond[k]    = -adhesion.trace_at(face, k, s) - threshold[k];
          }
        if (boundary.degree == 2)
          {
            constexpr unsigned int halvings     = dim == 2 ? 20 : 5;
            auto                   coefficients = adhesion.trace_on(face, s);
            for (double &opening : coefficients)
              opening *= -1.;
            // The threshold is linear between the vertices.
            for (unsigned int k = 0; k < dim; ++k)
              coefficients[k] -= threshold[k];
            for (unsigned int e = 0; e < n_simplex_edges(dim); ++e)
              coefficients[dim + e] -= 0.5 * (threshold[simplex_edges[e][0]] +
                                              threshold[simplex_edges[e][1]]);
            sum += face.measure *
                   positive_part_of_quadratic<dim>(coefficients, halvings);
            continue;
          }
        // Closed cracks are not open.
        sum += face.measure * positive_part(beyond);
      }
    return sum;
  }



  template <int dim>
  std::vector<dealii::Point<dim>>
  fronts(const ContactBoundary<dim>  &boundary,
         const AdhesiveLaw           &law,
         const AdhesionIntegral<dim> &adhesion,
         const VectorView            &s)
  {
    std::vector<dealii::Point<dim>> result;
    const unsigned int              last = law.branches().size() - 1;
    if (dim != 2 || last == 0)
      return result;
    for (const auto &face : boundary.faces)
      {
        // How far bonds are from the last kink; below 0 they hold.
        std::array<double, dim> beyond;
        std::array<bool, dim>   are_gone, hold;
        for (unsigned int k = 0; k < dim; ++k)
          {
            const BondScale bonds = adhesion.bonds_at(face, k);
            are_gone[k] =
              bonds.energy == 0. || adhesion.least_piece_at(face, k) == last;
            beyond[k] = -adhesion.trace_at(face, k, s) -
                        law.bond_threshold() * bonds.stretch;
            hold[k] = !are_gone[k] && beyond[k] < 0.;
          }
        if (hold[0] == hold[1])
          continue;
        const double part = are_gone[0] || are_gone[1] ?
                              0.5 :
                              beyond[0] / (beyond[0] - beyond[1]);
        result.push_back(face.vertices[0] +
                         part * (face.vertices[1] - face.vertices[0]));
      }
    return result;
  }



  template decltype(fronts<2>)      fronts<2>;
  template decltype(fronts<3>)      fronts<3>;
  template decltype(broken_zone<2>) broken_zone<2>;
  template decltype(broken_zone<3>) broken_zone<3>;
} // namespace Debond
