// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_infinity_h
#define debond_base_infinity_h

#include <limits>

namespace Debond
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
} // namespace Debond

#endif
