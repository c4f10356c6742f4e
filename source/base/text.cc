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
    // std::to_chars() without a precision writes the fewest digits that read
    // back as the same double. It does not depend on the locale, and the
    // longest such text has 24 characters.
    std::array<char, 32> text;
    const auto           end =
      std::to_chars(text.data(), text.data() + text.size(), number).ptr;
    return {text.data(), end};
  }



  bool
  read_number(const std::string &text, double &number)
  {
    // std::from_chars() does not depend on the locale, in which a comma could
    // be the decimal point, but accepts no plus sign, which is skipped here
    // unless a minus follows. It stops at the first character that is no part
    // of a number, so that the whole text has to be used up. It also reads
    // "inf" and "nan", which are no values of entries.
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
    // In UTF-8 each byte of a character but its first one begins with the bits
    // 10. All of them belong into the message, since a part of a character
    // cannot be printed.
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
        // Beside those of ASCII there are the control characters U+0080 to
        // U+009F, which UTF-8 writes as the byte c2 and a second one from 80 to
        // 9f. Only the second byte is replaced, which makes the sequence
        // harmless.
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
    // The text is rounded to nearest and can be above the value by up to half a
    // unit of its last digit. Then six tenths of that unit are subtracted,
    // after which it rounds to the next number below, with some room for the
    // rounding of the subtraction itself.
    const std::string text = scientific(value, digits);
    if (!(std::strtod(text.c_str(), nullptr) > value))
      return text;
    const double place = std::floor(std::log10(std::abs(value))) - digits;
    return scientific(value - 0.6 * std::pow(10., place), digits);
  }



  std::string
  scientific_above(const double value, const int digits)
  {
    // The smallest text above a value is minus the largest text below minus the
    // value, whose sign is exchanged in the text.
    const std::string text = scientific_below(-value, digits);
    return text[0] == '-' ? text.substr(1) : "-" + text;
  }



  std::string
  as_title(const std::string &name)
  {
    std::string title;
    // The titles are those of columns of CSV files, which other programs use as
    // names of variables. Characters that they do not allow there are left out.
    for (const char c : name)
      if (std::isalnum(static_cast<unsigned char>(c)) != 0)
        title += c;
      else if (c == ' ' || c == '_' || c == '-')
        title += '_';
    return title;
  }
} // namespace Debond
