// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_version_h
#define debond_base_version_h

#include <string>

namespace Debond
{
  /// Debond's version, "0.1.0".
  std::string
  program_version();

  /// The git revision that the program was built from, with "-dirty" if the
  /// working copy had changes; "unknown" without git.
  std::string
  git_revision();

  std::string
  deal_ii_version();

  /// "Release" or "Debug".
  std::string
  build_type();
} // namespace Debond

#endif
