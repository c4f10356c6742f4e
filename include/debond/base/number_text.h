// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_number_text_h
#define debond_base_number_text_h

#include <string>

namespace Debond
{
  /// The shortest text that reads back as the same number.
  std::string
  shortest_text(const double number);
} // namespace Debond

#endif
