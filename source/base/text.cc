// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/text.h>

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
} // namespace Debond
