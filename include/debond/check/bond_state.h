// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_check_bond_state_h
#define debond_check_bond_state_h

#include <debond/contact/law.h>

namespace Debond
{
  /// The state of the bond and the foundation at a contact node, by its number
  /// in files. Pieces of a law that have other names than these have the
  /// numbers that follow.
  enum class BondState : int
  {
    broken_but_closed = -1, ///< s = 0, where bonds broke for good, or by slip
    contact,                ///< s = 0
    bonded,
    kink, ///< between two pieces
    broken,
    free, ///< s < 0, where there is no adhesion
    held  ///< a clamped vertex, which is no contact node
  };

  /// The names of all states that nodes can have with this law: those of
  /// BondState in their order, and of the law's other pieces.
  std::vector<std::string>
  state_names(const AdhesiveLaw &law);

  /// The place of a state in state_names().
  constexpr std::size_t
  index_of(const BondState state)
  {
    return static_cast<std::size_t>(static_cast<int>(state) + 1);
  }

  constexpr BondState
  state_at(const std::size_t index)
  {
    return static_cast<BondState>(static_cast<int>(index) - 1);
  }

  /// The place in state_names() of the first one that is a law's own.
  constexpr std::size_t first_of_law = index_of(BondState::held) + 1;

  /// The state with a name of state_names().
  BondState
  state_named(const std::string              &name,
              const std::vector<std::string> &state_names);
} // namespace Debond

#endif
