// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_text_h
#define debond_base_text_h

#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

namespace Debond
{
  /// Returns the shortest text that reads back as the same number.
  std::string
  shortest_text(const double number);

  /// Reads a finite number. Returns false if the text is anything else.
  bool
  read_number(const std::string &text, double &number);

  /// The question for one who may have written one.
  inline const std::string decimal_comma =
    "decimal comma? Numbers have a point, and nothing between thousands";

  /// Returns behind "; " why the text is no number, if it has a comma between
  /// two digits or a character that is no ASCII; otherwise nothing.
  std::string
  number_hint(const std::string &text);



  /// Returns the words one after the other with the separator between them.
  std::string
  join(const std::vector<std::string> &words, const std::string &separator);

  /// Prints all parts one after the other; manipulators of streams,
  /// such as std::setprecision(), hold for the parts behind them.
  template <typename... Parts>
  std::string
  words(const Parts &...parts)
  {
    std::ostringstream text;
    (text << ... << parts);
    return text.str();
  }

  /// Returns the text with its control characters, which can make a terminal
  /// show what is not so, as in "\x1b".
  std::string
  printable(const std::string &text);

  /// Prints a line on the standard error, printable.
  void
  print_error(const std::string &message);

  /// Prints the number with this many digits behind the point, such as
  /// "1.23e-04".
  inline std::string
  scientific(const double value, const int digits)
  {
    return words(std::scientific, std::setprecision(digits), value);
  }

  /// Prints bounds likewise, but not above the number, and not below it.
  std::string
  scientific_below(const double value, const int digits);
  std::string
  scientific_above(const double value, const int digits);

  /// Returns a name as a part of the title of a column: letters, digits and
  /// underscores.
  std::string
  as_title(const std::string &name);

  /// Prints as scientific() does, without an exponent.
  inline std::string
  fixed_point(const double value, const int digits)
  {
    return words(std::fixed, std::setprecision(digits), value);
  }
} // namespace Debond

#endif
