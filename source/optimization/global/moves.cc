// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/global/moves.h>

#include <iterator>
#include <numeric>

namespace Debond
{
  namespace
  {
    /// The nodes that are neighbours of @p nodes, but not among them.
    NodeSet
    neighbours_of(const NodeSet &nodes, const NeighbourGraph &graph)
    {
      NodeSet result;
      for (const unsigned int i : nodes)
        for (const unsigned int j : graph[i])
          if (nodes.count(j) == 0)
            result.insert(j);
      return result;
    }



    NodeSet
    common(const NodeSet &a, const NodeSet &b)
    {
      NodeSet result;
      for (const unsigned int i : a)
        if (b.count(i) > 0)
          result.insert(result.end(), i);
      return result;
    }



    std::vector<NodeSet>
    connected_parts(NodeSet nodes, const NeighbourGraph &graph)
    {
      std::vector<NodeSet> parts;
      while (!nodes.empty())
        {
          // A front of neighbours spreads over the part until there are none
          // left.
          NodeSet part, front = {*nodes.begin()};
          while (!front.empty())
            {
              for (const unsigned int i : front)
                nodes.erase(i);
              part.insert(front.begin(), front.end());
              front = common(neighbours_of(front, graph), nodes);
            }
          parts.push_back(part);
        }
      return parts;
    }



    /// The last that is left of @p nodes if those beside others are taken off
    /// again and again; the middle one by number if that leaves none.
    NodeSet
    middle(NodeSet nodes, const NeighbourGraph &graph)
    {
      while (true)
        {
          NodeSet inner;
          for (const unsigned int i : nodes)
            if (std::includes(
                  nodes.begin(), nodes.end(), graph[i].begin(), graph[i].end()))
              inner.insert(i);
          // The last layer, or a set without a rim, such as a closed ring.
          if (inner.empty() || inner.size() == nodes.size())
            return {*std::next(nodes.begin(), nodes.size() / 2)};
          nodes = inner;
        }
    }



    /// @p layer, then with its neighbours among @p others, with theirs, and so
    /// on: up to @p n sets.
    std::vector<NodeSet>
    layers(NodeSet               layer,
           const NodeSet        &others,
           const unsigned int    n,
           const NeighbourGraph &graph)
    {
      std::vector<NodeSet> result;
      NodeSet              all;
      while (!layer.empty() && result.size() < n)
        {
          // Each set contains the ones before, so that an edge moves as a whole
          // by 1, 2, ... nodes.
          all.insert(layer.begin(), layer.end());
          result.push_back(all);
          layer = common(neighbours_of(all, graph), others);
        }
      return result;
    }



    /// @p others and the first 1, 2, 4, ... of the nodes.
    std::vector<NodeSet>
    growing(const std::vector<unsigned int> &nodes, const NodeSet &others)
    {
      std::vector<NodeSet> result;
      // Each set moves twice as many nodes as the last one, as every number of
      // nodes that is tried costs a minimisation.
      for (std::size_t n = 1; n < nodes.size(); n *= 2)
        {
          result.push_back(others);
          result.back().insert(nodes.begin(), nodes.begin() + n);
        }
      return result;
    }
  } // namespace



  std::vector<PieceMove>
  moves_from(const PieceState     &state,
             const NeighbourGraph &graph,
             const unsigned int    n_pieces,
             const unsigned int    maximum_shift,
             const bool            flips)
  {
    std::vector<PieceMove> moves;
    for (unsigned int piece = 1; piece < n_pieces; ++piece)
      {
        // For this kink: on its far side, where bonds are on the piece or
        // beyond, and on the side of 0.
        NodeSet below, above;
        for (unsigned int i = 0; i < state.size(); ++i)
          (state[i] >= piece ? below : above).insert(i);
        // With the paper's law the lower patches are broken, the upper ones
        // hold.
        const std::vector<NodeSet> lower = connected_parts(below, graph);
        const std::vector<NodeSet> upper = connected_parts(above, graph);

        for (const NodeSet &patch : lower)
          for (const NodeSet &edge :
               connected_parts(neighbours_of(patch, graph), graph))
            {
              // The edge of the patch from outside, and from inside: layers of
              // nodes that join it, and that leave it.
              const NodeSet inner = common(neighbours_of(edge, graph), patch);
              for (const NodeSet &nodes :
                   layers(edge, above, maximum_shift, graph))
                moves.push_back({piece, nodes, {}});
              for (const NodeSet &nodes :
                   layers(inner, patch, maximum_shift, graph))
                moves.push_back({piece, {}, nodes});
            }
        // Moves of edges change the size of patches. Flips change their number:
        // a whole patch breaks or heals, or a new one begins in the middle of
        // another.
        if (!flips)
          continue;
        for (const NodeSet &patch : upper)
          moves.push_back({piece, patch, {}});
        for (const NodeSet &patch : lower)
          moves.push_back({piece, {}, patch});
        for (const NodeSet &patch : upper)
          moves.push_back({piece, middle(patch, graph), {}});
        for (const NodeSet &patch : lower)
          moves.push_back({piece, {}, middle(patch, graph)});
      }
    return moves;
  }



  PieceMove
  beyond(const PieceMove      &move,
         const PieceState     &state,
         const NeighbourGraph &graph,
         const unsigned int    n)
  {
    // A move of an edge takes nodes one way only.
    const bool     is_down = !move.down.empty();
    const NodeSet &nodes   = is_down ? move.down : move.up;
    NodeSet        others;
    for (unsigned int i = 0; i < state.size(); ++i)
      if ((state[i] < move.piece) == is_down)
        others.insert(others.end(), i);
    // Layers that begin beside the last ones that moved, as the edge has come
    // to them.
    const std::vector<NodeSet> next =
      layers(common(neighbours_of(nodes, graph), others), others, n, graph);
    PieceMove result = {move.piece, {}, {}};
    if (!next.empty())
      (is_down ? result.down : result.up) = next.back();
    return result;
  }



  std::vector<PieceMove>
  moves_by_stretch(const PieceState  &state,
                   const VectorView  &s,
                   const unsigned int n_pieces)
  {
    // Most stretched first, with ties in the order of the nodes, so that the
    // moves are the same everywhere.
    std::vector<unsigned int> by_stretch(state.size());
    std::iota(by_stretch.begin(), by_stretch.end(), 0);
    std::stable_sort(by_stretch.begin(),
                     by_stretch.end(),
                     [&](const unsigned int i, const unsigned int j) {
                       return s(i) < s(j);
                     });
    std::vector<PieceMove> moves;
    for (unsigned int piece = 1; piece < n_pieces; ++piece)
      {
        std::vector<unsigned int> below, above;
        for (const unsigned int i : by_stretch)
          (state[i] >= piece ? below : above).push_back(i);
        const NodeSet lower(below.begin(), below.end());
        const NodeSet upper(above.begin(), above.end());
        // Of those below the least stretched first.
        std::reverse(below.begin(), below.end());
        for (const NodeSet &nodes : growing(below, upper))
          moves.push_back({piece, {}, nodes});
        for (const NodeSet &nodes : growing(above, lower))
          moves.push_back({piece, nodes, {}});
      }
    return moves;
  }
} // namespace Debond
