// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/config.h>

#include <debond/base/version.h>

#include <debond_revision.h>

namespace Debond
{
  std::string
  program_version()
  {
    return DEBOND_VERSION;
  }



  std::string
  git_revision()
  {
    return DEBOND_REVISION;
  }



  std::string
  deal_ii_version()
  {
    return DEAL_II_PACKAGE_VERSION;
  }



  std::string
  build_type()
  {
    return DEBOND_BUILD_TYPE;
  }
} // namespace Debond
