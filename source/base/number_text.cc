// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/number_text.h>

#include <array>
#include <charconv>

namespace Debond
{
  std::string
  shortest_text(const double number)
  {
    std::array<char, 32> text;
    const auto           end =
      std::to_chars(text.data(), text.data() + text.size(), number).ptr;
    return {text.data(), end};
  }
} // namespace Debond
