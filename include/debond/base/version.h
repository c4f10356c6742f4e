// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_version_h
#define debond_base_version_h

#include <string>

namespace Debond
{
  /// The sources that the program was built from, and how.
  struct Version
  {
    std::string program; ///< "0.1.0"

    /// It ends in "-dirty" if the working copy had changes, and is "unknown"
    /// without git.
    std::string revision;

    std::string deal_ii;
    std::string build_type; ///< "Release" or "Debug"
  };

  extern const Version version;
} // namespace Debond

#endif
