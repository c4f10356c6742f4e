// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_bad_input_h
#define debond_input_bad_input_h

#include <stdexcept>
#include <string>
#include <vector>

namespace Debond
{
  /// A command line or a scene that cannot be used: one line an error.
  class BadInput : public std::invalid_argument
  {
  public:
    explicit BadInput(const std::vector<std::string> &errors);

    const std::vector<std::string> lines;
  };
} // namespace Debond

#endif
