// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_memory_h
#define debond_base_memory_h

#include <string>

namespace Debond
{
  /// The memory that this process has, in bytes: now, and at most so far.
  double
  used_memory();

  double
  peak_memory();

  /// The memory that each process may still take, in bytes: of @p limit, which
  /// is for all of it, or of what the system can give, if that is 0. To be
  /// called by all ranks.
  double
  memory_left(const double limit);

  /// Lets this process take so many bytes beside what it has.
  void
  limit_memory(const double bytes);

  /// "1.5 GiB"
  std::string
  in_gib(const double bytes);
} // namespace Debond

#endif
