// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_cell_nodes_h
#define debond_elasticity_cell_nodes_h

#include <deal.II/base/point.h>
#include <deal.II/dofs/dof_handler.h>

#include <debond/contact/bernstein.h>
#include <debond/elasticity/linear_simplex.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace Debond
{
  /**
   * The nodes of a cell, to each of which the displacement has a coefficient:
   * its vertices and, of degree 2, its edges, see bernstein().
   */
  template <int dim>
  struct CellNodes
  {
    static constexpr unsigned int maximum = n_coefficients(dim + 1, 2);

    template <typename CellIterator>
    explicit CellNodes(const CellIterator &cell)
      : size(n_coefficients(dim + 1, cell->get_fe().degree))
    {
      for (unsigned int v = 0; v <= dim; ++v)
        {
          indices[v] = cell->vertex_index(v);
          for (unsigned int d = 0; d < dim; ++d)
            dofs[v][d] = cell->vertex_dof_index(v, d);
        }
      for (unsigned int n = dim + 1; n < size; ++n)
        {
          const unsigned int edge = n - (dim + 1);
          indices[n]              = static_cast<unsigned int>(
            cell->get_triangulation().n_vertices() + cell->line_index(edge));
          for (unsigned int d = 0; d < dim; ++d)
            dofs[n][d] = cell->line(edge)->dof_index(d);
        }
    }

    /// The local number of the node with this index.
    unsigned int
    find(const unsigned int index) const
    {
      return static_cast<unsigned int>(
        std::find(indices.begin(), indices.begin() + size, index) -
        indices.begin());
    }

    unsigned int size;

    /// In the mesh: of a vertex its own, of an edge its own and the number of
    /// vertices.
    std::array<unsigned int, maximum> indices;

    std::array<std::array<dealii::types::global_dof_index, dim>, maximum> dofs;
  };



  /// Where a node is: a vertex, or the middle of an edge.
  template <int dim, typename CellIterator>
  dealii::Point<dim>
  node_position(const CellIterator &cell, const unsigned int node)
  {
    if (node <= dim)
      return cell->vertex(node);
    const auto &[a, b] = simplex_edges[node - (dim + 1)];
    return cell->vertex(a) + 0.5 * (cell->vertex(b) - cell->vertex(a));
  }



  /// Of all nodes of a mesh.
  template <int dim>
  unsigned int
  n_nodes(const dealii::Triangulation<dim> &mesh, const unsigned int degree)
  {
    return mesh.n_vertices() + (degree == 2 ? mesh.n_raw_lines() : 0);
  }



  /**
   * The gradients of the basis on a cell, and a rule that integrates products
   * of two of them: one point of degree 1, dim + 1 points of degree 2.
   */
  template <int dim>
  struct BernsteinSimplex : public LinearSimplex<dim>
  {
    using Barycentric = std::array<double, dim + 1>;

    template <typename CellIterator>
    BernsteinSimplex(const CellIterator &cell, const unsigned int degree)
      : LinearSimplex<dim>(cell)
      , degree(degree)
      , n_nodes(n_coefficients(dim + 1, degree))
      , n_points(degree == 1 ? 1 : dim + 1)
      , weight(this->volume / n_points)
    {}

    /// The coordinates of the points of the rule that are not near its vertex.
    static double
    small_coordinate()
    {
      static const double value =
        dim == 2 ? 1. / 6. : (5. - std::sqrt(5.)) / 20.;
      return value;
    }

    Barycentric
    point(const unsigned int q) const
    {
      Barycentric result;
      if (degree == 1)
        {
          result.fill(1. / (dim + 1));
          return result;
        }
      result.fill(small_coordinate());
      result[q] = 1. - dim * small_coordinate();
      return result;
    }

    dealii::Tensor<1, dim>
    gradient(const unsigned int node, const Barycentric &barycentric) const
    {
      if (degree == 1)
        return this->gradients[node];
      if (node <= dim)
        return 2. * barycentric[node] * this->gradients[node];
      const auto &[a, b] = simplex_edges[node - (dim + 1)];
      return 2. * (barycentric[a] * this->gradients[b] +
                   barycentric[b] * this->gradients[a]);
    }

    const unsigned int degree;
    const unsigned int n_nodes;
    const unsigned int n_points;
    const double       weight; ///< volume that belongs to a point
  };
} // namespace Debond

#endif
