// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/status.h>

namespace Debond
{
  std::string
  to_string(const SolverStatus status)
  {
    // In the order of the enumeration.
    static const char *const words[] = {"success",
                                        "iteration limit",
                                        "line search failed",
                                        "quadratic program failed",
                                        "no descent",
                                        "stagnated",
                                        "not finite",
                                        "comes off",
                                        "interrupted"};
    return words[static_cast<unsigned int>(status)];
  }
} // namespace Debond
