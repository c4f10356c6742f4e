// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/mesh/body.h>

namespace Debond
{
  std::string
  boundary_name(const BoundaryNames &names, const dealii::types::boundary_id id)
  {
    for (const auto &[name, named_id] : names)
      if (named_id == id)
        return name;
    return "boundary " + std::to_string(id);
  }
} // namespace Debond
