// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_entry_error_h
#define debond_base_entry_error_h

#include <stdexcept>
#include <string>

namespace Debond
{
  /// Data of a scene that cannot be used, with the path of the entry that they
  /// come from.
  class EntryError : public std::invalid_argument
  {
  public:
    EntryError(const std::string &entry, const std::string &message)
      : std::invalid_argument(message)
      , entry(entry)
    {}

    const std::string entry; ///< such as "Loads/Body force"
  };
} // namespace Debond

#endif
