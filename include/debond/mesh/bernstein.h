// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_bernstein_h
#define debond_mesh_bernstein_h

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace Debond
{
  /**
   * Polynomials of degree 1 or 2 on a line, a triangle or a tetrahedron in the
   * Bernstein basis of its barycentric coordinates l: l_i for each vertex, or
   * l_i^2 for each vertex and 2 l_a l_b for each edge. The functions are not
   * negative, sum to one and have the same integral, so that a polynomial is
   * nowhere larger than its largest coefficient. The coefficient of an edge is
   * 2 p(middle) - (p(a) + p(b)) / 2, for affine p its value in the middle.
   */

  /// The ends of the edges, of a line the first one, of a triangle the first
  /// three; deal.II's order.
  inline constexpr std::array<std::array<unsigned int, 2>, 6> simplex_edges = {
    {{{0, 1}}, {{1, 2}}, {{2, 0}}, {{0, 3}}, {{1, 3}}, {{2, 3}}}};



  constexpr unsigned int
  n_simplex_edges(const unsigned int n_vertices)
  {
    return n_vertices * (n_vertices - 1) / 2;
  }



  /// The number of coefficients: those of vertices come first.
  constexpr unsigned int
  n_coefficients(const unsigned int n_vertices, const unsigned int degree)
  {
    return n_vertices + (degree == 2 ? n_simplex_edges(n_vertices) : 0);
  }



  /// The values of the basis; of degree 1 those of edges are zero.
  template <std::size_t n>
  std::array<double, n_coefficients(n, 2)>
  bernstein(const std::array<double, n> &barycentric, const unsigned int degree)
  {
    std::array<double, n_coefficients(n, 2)> values = {};
    for (unsigned int v = 0; v < n; ++v)
      values[v] =
        degree == 1 ? barycentric[v] : barycentric[v] * barycentric[v];
    if (degree == 2)
      for (unsigned int e = 0; e < n_simplex_edges(n); ++e)
        values[n + e] = 2. * barycentric[simplex_edges[e][0]] *
                        barycentric[simplex_edges[e][1]];
    return values;
  }



  /// The barycentric coordinates of the k-th coefficient: a vertex, or the
  /// middle of an edge.
  template <std::size_t n>
  std::array<double, n>
  coefficient_place(const unsigned int k)
  {
    std::array<double, n> place = {};
    if (k < n)
      place[k] = 1.;
    else
      for (const unsigned int end : simplex_edges[k - n])
        place[end] = 0.5;
    return place;
  }



  /// The least and the largest value on a line or a triangle of the polynomial
  /// with these coefficients: at vertices, and of degree 2 where it is
  /// stationary, on an edge or inside.
  template <std::size_t n>
  std::pair<double, double>
  range_on_simplex(const std::array<double, n_coefficients(n, 2)> &coefficients,
                   const unsigned int                              degree)
  {
    static_assert(n == 2 || n == 3);
    std::pair<double, double> range =
      std::minmax({coefficients[0], coefficients[1], coefficients[n - 1]});
    if (degree == 1)
      return range;

    const auto add = [&](const std::array<double, n> &point) {
      const auto shape = bernstein(point, 2);
      double     value = 0.;
      for (unsigned int k = 0; k < coefficients.size(); ++k)
        value += shape[k] * coefficients[k];
      range.first  = std::min(range.first, value);
      range.second = std::max(range.second, value);
    };
    const auto is_inside = [](const double x) { return x > 0. && x < 1.; };
    for (unsigned int e = 0; e < n_simplex_edges(n); ++e)
      {
        const auto &[a, b]  = simplex_edges[e];
        const double before = coefficients[n + e] - coefficients[a],
                     after  = coefficients[b] - coefficients[n + e],
                     x      = before / (before - after);
        if (before != after && is_inside(x))
          {
            std::array<double, n> point = {};
            point[a]                    = 1. - x;
            point[b]                    = x;
            add(point);
          }
      }
    if constexpr (n == 3)
      {
        // The derivatives towards the vertices 1 and 2 are affine.
        const auto  &c  = coefficients;
        const double x0 = c[3] - c[0], x1 = c[1] - c[3], x2 = c[4] - c[5],
                     y0 = c[5] - c[0], y1 = c[4] - c[3], y2 = c[2] - c[5];
        const double det = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0);
        const double l1  = ((x2 - x0) * y0 - (y2 - y0) * x0) / det,
                     l2  = ((y1 - y0) * x0 - (x1 - x0) * y0) / det;
        if (det != 0. && is_inside(l1) && is_inside(l2) &&
            is_inside(1. - l1 - l2))
          add({{1. - l1 - l2, l1, l2}});
      }
    return range;
  }
} // namespace Debond

#endif
