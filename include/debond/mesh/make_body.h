// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_make_body_h
#define debond_mesh_make_body_h

#include <debond/mesh/box.h>

#include <memory>

namespace Debond
{
  /// What a scene says of its body.
  struct BodyParameters
  {
    BoxParameters box;
  };

  /// A Body<dimension>.
  std::shared_ptr<const BodyDescription>
  make_body(const unsigned int dimension, const BodyParameters &parameters);
} // namespace Debond

#endif
