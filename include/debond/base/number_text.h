// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_number_text_h
#define debond_base_number_text_h

#include <string>

namespace Debond
{
  /// The shortest text that reads back as the same number.
  std::string
  shortest_text(const double number);

  /// Reads a finite number. Returns false if the text is anything else.
  bool
  read_number(const std::string &text, double &number);

  /// The question for one who may have written one.
  inline const std::string decimal_comma =
    "decimal comma? Numbers have a point, and nothing between thousands";

  /// That behind "; " if the text has a comma between two digits, or nothing.
  std::string
  comma_hint(const std::string &text);
} // namespace Debond

#endif
