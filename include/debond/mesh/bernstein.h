// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_bernstein_h
#define debond_mesh_bernstein_h

#include <array>
#include <cstddef>

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



  /// The number of the edge between two vertices.
  constexpr unsigned int
  edge_between(const unsigned int a, const unsigned int b)
  {
    unsigned int e = 0;
    while (!((simplex_edges[e][0] == a && simplex_edges[e][1] == b) ||
             (simplex_edges[e][0] == b && simplex_edges[e][1] == a)))
      ++e;
    return e;
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
} // namespace Debond

#endif
