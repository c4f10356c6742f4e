// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_append_h
#define debond_base_append_h

#include <vector>

namespace Debond
{
  template <typename T>
  void
  append(const std::vector<T> &more, std::vector<T> &list)
  {
    list.insert(list.end(), more.begin(), more.end());
  }
} // namespace Debond

#endif
