// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_mesh_parameters_h
#define debond_input_mesh_parameters_h

#include <debond/base/parameter_table.h>
#include <debond/input/expression.h>
#include <debond/mesh/make_body.h>

namespace Debond
{
  /// The section Mesh.
  void
  bind_mesh(BodyParameters &body, ParameterTable &table);

  /// The section Parts: the texts "BOUNDARY: CONDITION" or "CONDITION" by the
  /// names of the parts.
  void
  bind_parts(std::map<std::string, std::string> &parts, ParameterTable &table);

  /// The body, a Body<dimension>, of the file @p scene with its cuts and these
  /// @p parts, whose conditions may use the @p constants. Null with an error in
  /// the table if there is none; texts that make no cut or part are left there
  /// as errors.
  std::shared_ptr<BodyDescription>
  make_body(const std::string                        &scene,
            const unsigned int                        dimension,
            BodyParameters                            parameters,
            const std::map<std::string, std::string> &parts,
            const Constants                          &constants,
            ParameterTable                           &table);
} // namespace Debond

#endif
