// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_mesh_parameters_h
#define debond_input_mesh_parameters_h

#include <debond/base/parameter_table.h>
#include <debond/mesh/body.h>

#include <memory>
#include <string>

namespace Debond
{
  void
  declare_mesh(ParameterTable &table);

  /// The body, a Body<dimension>, of the file @p scene. Adds an error to the
  /// table and returns null if there is none.
  std::shared_ptr<const BodyDescription>
  read_body(const std::string &scene,
            const unsigned int dimension,
            ParameterTable    &table);
} // namespace Debond

#endif
