// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_make_body_h
#define debond_mesh_make_body_h

#include <debond/mesh/box.h>

namespace Debond
{
  /// What a scene says of its body.
  struct BodyParameters
  {
    BoxParameters box;
  };

  template <int dim>
  std::unique_ptr<const Body<dim>>
  make_body(const BodyParameters &parameters);
} // namespace Debond

#endif
