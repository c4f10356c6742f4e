// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_text_h
#define debond_base_text_h

#include <string>
#include <vector>

namespace Debond
{
  /// The words one after the other with the separator between them.
  std::string
  join(const std::vector<std::string> &words, const std::string &separator);
} // namespace Debond

#endif
