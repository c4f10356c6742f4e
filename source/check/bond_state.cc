// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/check/bond_state.h>

namespace Debond
{
  std::vector<std::string>
  state_names(const AdhesiveLaw &law)
  {
    // The first names are in the order of BondState, which begins with -1. A
    // piece of the law that has one of these names shares its number, and each
    // other name gets the next number once.
    std::vector<std::string> names = {"broken but closed",
                                      "contact",
                                      "bonded",
                                      "kink",
                                      "broken",
                                      "free",
                                      "held"};
    for (unsigned int k = 0; k < law.pieces().size(); ++k)
      if (std::find(names.begin(), names.end(), law.name(k)) == names.end())
        names.push_back(law.name(k));
    return names;
  }



  BondState
  state_named(const std::string              &name,
              const std::vector<std::string> &state_names)
  {
    return state_at(static_cast<std::size_t>(
      std::find(state_names.begin(), state_names.end(), name) -
      state_names.begin()));
  }
} // namespace Debond
