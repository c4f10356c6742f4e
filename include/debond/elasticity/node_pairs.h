// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_node_pairs_h
#define debond_elasticity_node_pairs_h

#include <debond/elasticity/boundary_face.h>
#include <debond/elasticity/change_of_basis.h>

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
   * low one. So the normal jump is an unknown of its own, and [u]_nu <= g a
   * simple bound, as on a foundation.
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

    /// Adds the pairs of an interface, whose first nodes are those of @p high.
    /// Returns false, with nothing added, if the nodes of the sides are not at
    /// the same places.
    bool
    add(const std::vector<BoundaryFace<dim>> &high,
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

    /// The nodes that both sides share, where an interface ends: there is no
    /// jump.
    const std::set<unsigned int> &
    ends() const
    {
      return shared;
    }

    /// Makes the other node the first one of a pair.
    void
    exchange(const unsigned int k)
    {
      pairs[k] = {pairs[k].second, pairs[k].first, -pairs[k].sign};
    }

    /// The step of a ChangeOfBasis from displacements to jumps.
    std::vector<BasisRow<dim>>
    jumps() const
    {
      std::vector<BasisRow<dim>> rows;
      for (const Pair &pair : pairs)
        rows.push_back(
          BasisRow<dim>::scaled(pair.first, pair.sign, {{pair.second, 1.}}));
      return rows;
    }

  private:
    std::vector<Pair>      pairs;
    std::set<unsigned int> shared;
  };
} // namespace Debond

#endif
