// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/text.h>

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <iostream>
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
  number_hint(const std::string &text)
  {
    std::size_t end = 0, begin;
    while (end < text.size() && static_cast<unsigned char>(text[end]) < 0x80)
      ++end;
    // In UTF-8 the bytes that begin with the bits 10 go on with a character.
    for (begin = end++; end < text.size() && (text[end] & 0xc0) == 0x80;)
      ++end;
    if (begin < text.size())
      return "; '" + text.substr(begin, end - begin) +
             "' is no character of numbers";
    return std::regex_search(text, std::regex("[0-9],[0-9]")) ?
             "; " + decimal_comma :
             "";
  }



  std::string
  join(const std::vector<std::string> &words, const std::string &separator)
  {
    std::string text;
    for (const std::string &word : words)
      text += (&word == &words.front() ? "" : separator) + word;
    return text;
  }



  std::string
  printable(const std::string &text)
  {
    std::string result;
    for (const char c : text)
      {
        const auto code = static_cast<unsigned char>(c);
        // UTF-8 has more of them behind this letter.
        const bool is_second = !result.empty() && result.back() == '\xc2';
        if ((code < 0x20 && c != '\t') || code == 0x7f ||
            (is_second && code >= 0x80 && code < 0xa0))
          result += words("\\x", std::hex, code / 16, code % 16);
        else
          result += c;
      }
    return result;
  }



  void
  print_error(const std::string &message)
  {
    std::cerr << "debond: " << printable(message) << std::endl;
  }



  std::string
  scientific_below(const double value, const int digits)
  {
    const std::string text = scientific(value, digits);
    if (!(std::strtod(text.c_str(), nullptr) > value))
      return text;
    const double place = std::floor(std::log10(std::abs(value))) - digits;
    return scientific(value - 0.6 * std::pow(10., place), digits);
  }



  std::string
  scientific_above(const double value, const int digits)
  {
    const std::string text = scientific_below(-value, digits);
    return text[0] == '-' ? text.substr(1) : "-" + text;
  }



  std::string
  as_title(const std::string &name)
  {
    std::string title;
    for (const char c : name)
      if (std::isalnum(static_cast<unsigned char>(c)) != 0)
        title += c;
      else if (c == ' ' || c == '_' || c == '-')
        title += '_';
    return title;
  }
} // namespace Debond
