// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_benchmark_machine_h
#define debond_benchmark_machine_h

#include <string>

namespace Debond
{
  /// What measured times depend on, in a line: processor, libraries with their
  /// versions, compiler, build type and revision.
  std::string
  describe_machine();
} // namespace Debond

#endif
