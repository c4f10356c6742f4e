// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_node_pairs_h
#define debond_elasticity_node_pairs_h

#include <deal.II/base/types.h>
#include <deal.II/lac/full_matrix.h>

#include <debond/elasticity/boundary_face.h>

#include <set>
#include <vector>

namespace Debond
{
  /// A number by which points are sorted to be found again: where they are
  /// along a line in no special direction. Points that are d apart have numbers
  /// less than 2 d apart.
  template <int dim>
  double
  place_on_line(const dealii::Point<dim> &point)
  {
    double sum = 0., weight = 1.;
    for (unsigned int d = 0; d < dim; ++d, weight *= 0.6180339887498949)
      sum += weight * point[d];
    return sum;
  }



  /**
   * Nodes of two bodies at one place, where these are glued to each other. The
   * unknowns of the first one are the jump [u] = u_high - u_low of the two
   * bodies, those of the second one its displacement:
   *
   *     u_first = sign [u] + u_second,
   *
   * sign being 1 if the first one is on the high side and -1 if it is on the
   * low one. This is the change of basis and its transpose. So the normal jump
   * is an unknown of its own, and [u]_nu <= g a simple bound, as on a
   * foundation.
   *
   * Vectors have dim entries for each node, those of node n from dim n on.
   */
  template <int dim>
  class NodePairs
  {
  public:
    struct Pair
    {
      unsigned int first, second;
      double       sign;
    };

    /// Of no nodes.
    NodePairs() = default;

    /// @p n_nodes: of the mesh. The first nodes are those of @p high. Throws
    /// std::invalid_argument if the nodes of the sides are not at the same
    /// places.
    NodePairs(const unsigned int                    n_nodes,
              const std::vector<BoundaryFace<dim>> &high,
              const std::vector<BoundaryFace<dim>> &low);

    bool
    empty() const
    {
      return pairs.empty();
    }

    const std::vector<Pair> &
    all() const
    {
      return pairs;
    }

    /// The pair of which the node is one, null if it is of none.
    const Pair *
    find(const unsigned int node) const
    {
      return number_of_node.empty() ||
                 number_of_node[node] == dealii::numbers::invalid_unsigned_int ?
               nullptr :
               &pairs[number_of_node[node]];
    }

    /// The same if it is the first one.
    const Pair *
    find_first(const unsigned int node) const
    {
      const Pair *const pair = find(node);
      return pair != nullptr && pair->first == node ? pair : nullptr;
    }

    /// The nodes that both sides share, where an interface ends: there is no
    /// jump.
    const std::set<unsigned int> &
    ends() const
    {
      return shared;
    }

    /// Makes the other node the first one.
    void
    exchange(const Pair &pair)
    {
      Pair &own = pairs[number_of_node[pair.first]];
      own       = {pair.second, pair.first, -pair.sign};
    }

    /// u from jumps.
    template <typename Vector>
    void
    to_values(Vector &u) const
    {
      for_each_component([&u](const auto i, const auto j, const double sign) {
        u(i) = sign * u(i) + u(j);
      });
    }

    /// Jumps from u.
    template <typename Vector>
    void
    to_jumps(Vector &u) const
    {
      for_each_component([&u](const auto i, const auto j, const double sign) {
        u(i) = sign * (u(i) - u(j));
      });
    }

    /// Forces as the conjugates of the unknowns.
    template <typename Vector>
    void
    forces_to_conjugates(Vector &f) const
    {
      for_each_component([&f](const auto i, const auto j, const double sign) {
        f(j) += f(i);
        f(i) *= sign;
      });
    }

    /// And back.
    template <typename Vector>
    void
    forces_from_conjugates(Vector &f) const
    {
      for_each_component([&f](const auto i, const auto j, const double sign) {
        f(i) *= sign;
        f(j) -= f(i);
      });
    }

    /// Appends the degrees of freedom of the second nodes of all first ones.
    void
    add_seconds(std::vector<dealii::types::global_dof_index> &dofs) const;

    /// Takes the matrix of a cell from u to the unknowns, and makes it as large
    /// as add_seconds() has made its @p dofs.
    void
    to_unknowns(const std::vector<dealii::types::global_dof_index> &dofs,
                dealii::FullMatrix<double> &matrix) const;

  private:
    template <typename Action>
    void
    for_each_component(const Action &action) const
    {
      for (const Pair &pair : pairs)
        for (unsigned int d = 0; d < dim; ++d)
          action(dim * pair.first + d, dim * pair.second + d, pair.sign);
    }

    std::vector<Pair>         pairs;
    std::vector<unsigned int> number_of_node; ///< of its pair; or empty
    std::set<unsigned int>    shared;
  };
} // namespace Debond

#endif
