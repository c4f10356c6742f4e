// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_edge_coefficients_h
#define debond_elasticity_edge_coefficients_h

#include <deal.II/base/types.h>

#include <debond/elasticity/boundary_face.h>

#include <array>
#include <vector>

namespace Debond
{
  /**
   * Quadratic displacements on contact faces: the unknowns of an edge from a to
   * b are not the displacement in its middle but the coefficient
   *
   *     c = 2 u(middle) - (u(a) + u(b)) / 2
   *
   * of the Bernstein basis, see bernstein(): the displacement along a normal is
   * nowhere on a face larger than its largest coefficient, so that u_nu <= 0
   * are bounds on unknowns. All other unknowns are values at nodes. This is the
   * change of basis between the two, T in u = T c, and its transpose.
   *
   * Vectors have dim entries for each node, those of node n from dim n on.
   */
  template <int dim>
  class EdgeCoefficients
  {
  public:
    /// An edge by the numbers of its nodes: that in its middle, and its ends.
    struct Edge
    {
      unsigned int                middle;
      std::array<unsigned int, 2> ends;
    };

    /// Of no edges.
    EdgeCoefficients() = default;

    /// Of the edges of all these faces, those of the contact boundary; of
    /// degree 1 none. @p n_nodes: of the mesh.
    EdgeCoefficients(const unsigned int                    n_nodes,
                     const std::vector<BoundaryFace<dim>> &contact);

    /// The edge with this node in its middle; null if it has no coefficient.
    const Edge *
    find(const unsigned int node) const
    {
      return number_of_node.empty() ||
                 number_of_node[node] == dealii::numbers::invalid_unsigned_int ?
               nullptr :
               &edges[number_of_node[node]];
    }

    /// u = T c, in Cartesian components.
    template <typename Vector>
    void
    to_values(Vector &u) const
    {
      for_each_component([&u](const auto m, const auto a, const auto b) {
        u(m) = 0.5 * u(m) + 0.25 * (u(a) + u(b));
      });
    }

    /// c = T^{-1} u.
    template <typename Vector>
    void
    to_coefficients(Vector &u) const
    {
      for_each_component([&u](const auto m, const auto a, const auto b) {
        u(m) = 2. * u(m) - 0.5 * (u(a) + u(b));
      });
    }

    /// T' f: what forces at nodes are as the conjugates of c.
    template <typename Vector>
    void
    forces_to_conjugates(Vector &f) const
    {
      for_each_component([&f](const auto m, const auto a, const auto b) {
        f(m) *= 0.5;
        f(a) += 0.5 * f(m);
        f(b) += 0.5 * f(m);
      });
    }

  private:
    template <typename Action>
    void
    for_each_component(const Action &action) const
    {
      for (const Edge &edge : edges)
        for (unsigned int d = 0; d < dim; ++d)
          action(dim * edge.middle + d,
                 dim * edge.ends[0] + d,
                 dim * edge.ends[1] + d);
    }

    std::vector<Edge>         edges;
    std::vector<unsigned int> number_of_node; ///< or empty
  };
} // namespace Debond

#endif
