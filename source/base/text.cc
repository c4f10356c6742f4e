// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/text.h>

#include <iomanip>

namespace Debond
{
  std::string
  join(const std::vector<std::string> &words, const std::string &separator)
  {
    std::string text;
    for (const std::string &word : words)
      text += (&word == &words.front() ? "" : separator) + word;
    return text;
  }



  std::string
  scientific(const double value, const int digits)
  {
    return words(std::scientific, std::setprecision(digits), value);
  }



  std::string
  fixed_point(const double value, const int digits)
  {
    return words(std::fixed, std::setprecision(digits), value);
  }
} // namespace Debond
