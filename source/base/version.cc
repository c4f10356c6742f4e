// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/config.h>

#include <debond/base/version.h>

#include <debond_revision.h>

namespace Debond
{
  // DEBOND_REVISION is written to a header at each build. Including it here
  // alone means that a new revision compiles one small file.
  const Version version = {DEBOND_VERSION,
                           DEBOND_REVISION,
                           DEAL_II_PACKAGE_VERSION,
                           DEBOND_BUILD_TYPE};
} // namespace Debond
