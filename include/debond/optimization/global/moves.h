// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_moves_h
#define debond_optimization_global_moves_h

#include <debond/optimization/global/separable_energy.h>

#include <set>

namespace Debond
{
  using NodeSet = std::set<unsigned int>;

  /// Which unknowns are neighbours on the contact boundary.
  using NeighbourGraph = std::vector<NodeSet>;

  /// Nodes that go down to a piece, or up to the one above it.
  struct PieceMove
  {
    unsigned int piece;
    NodeSet      down, up;
  };

  /**
   * Moves from a state, for each kink of laws with up to @p n_pieces
   * pieces. Patches are the connected parts of the nodes below the kink (with
   * the paper's law: the broken ones), and of those above. The edge of a lower
   * patch (an end of an interval in 2D, all around in 3D) goes out or in by up
   * to @p maximum_shift nodes; with @p flips a patch also goes to the other
   * side as a whole, which merges its neighbours, or in its middle, which
   * splits it.
   */
  std::vector<PieceMove>
  moves_from(const PieceState     &state,
             const NeighbourGraph &graph,
             const unsigned int    n_pieces,
             const unsigned int    maximum_shift,
             const bool            flips);



  /// The move of an edge, once it has paid, taken @p n layers of nodes further:
  /// those next to its nodes that are still on the other side in @p state.
  /// Without nodes where there are none.
  PieceMove
  beyond(const PieceMove      &move,
         const PieceState     &state,
         const NeighbourGraph &graph,
         const unsigned int    n);



  /**
   * Moves of nodes that need not be neighbours, for each kink: of the nodes
   * below it the 1, 2, 4, ... with the least displacement @p s go up, of those
   * above it the 1, 2, 4, ... most stretched go down. Bonds that bridge a gap
   * hold only together, which no move of an edge finds.
   *
   * The nodes that are there already are part of the move, so that all of them
   * begin in the middle of their pieces.
   */
  std::vector<PieceMove>
  moves_by_stretch(const PieceState  &state,
                   const VectorView  &s,
                   const unsigned int n_pieces);
} // namespace Debond

#endif
