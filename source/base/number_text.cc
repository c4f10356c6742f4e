// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/number_text.h>

#include <array>
#include <charconv>
#include <cmath>
#include <regex>

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



  bool
  read_number(const std::string &text, double &number)
  {
    // std::from_chars() knows no plus sign.
    const char *const first =
      text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-');
    const char *const last   = text.data() + text.size();
    const auto        result = std::from_chars(first, last, number);
    return result.ec == std::errc() && result.ptr == last &&
           std::isfinite(number);
  }



  std::string
  comma_hint(const std::string &text)
  {
    return std::regex_search(text, std::regex("[0-9],[0-9]")) ?
             "; " + decimal_comma :
             "";
  }
} // namespace Debond
