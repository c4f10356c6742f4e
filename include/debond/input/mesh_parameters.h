// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_mesh_parameters_h
#define debond_input_mesh_parameters_h

#include <debond/base/parameter_table.h>
#include <debond/mesh/make_body.h>

#include <memory>
#include <string>

namespace Debond
{
  /// The section Mesh.
  void
  bind_mesh(BodyParameters &body, ParameterTable &table);

  /// The body, a Body<dimension>, of the file @p scene. Adds an error to the
  /// table and returns null if there is none.
  std::shared_ptr<BodyDescription>
  make_body(const std::string &scene,
            const unsigned int dimension,
            BodyParameters     body,
            ParameterTable    &table);
} // namespace Debond

#endif
