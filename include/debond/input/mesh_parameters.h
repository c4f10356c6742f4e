// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_mesh_parameters_h
#define debond_input_mesh_parameters_h

#include <debond/base/parameter_table.h>
#include <debond/mesh/body.h>
#include <debond/mesh/make_body.h>

#include <map>
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



  /// Cuts the @p body, a Body<dimension>, as Mesh/Cuts says. Conditions may use
  /// the @p constants. Texts that make no cut are left in the table as errors.
  void
  add_cuts(BodyDescription                     &body,
           const BodyParameters                &parameters,
           const unsigned int                   dimension,
           const std::map<std::string, double> &constants,
           ParameterTable                      &table);

  /// The section Parts: the texts "BOUNDARY: CONDITION" or "CONDITION" by the
  /// names of the parts.
  void
  bind_parts(std::map<std::string, std::string> &parts, ParameterTable &table);

  /// Gives the @p body, a Body<dimension>, these parts. Conditions may use the
  /// @p constants. Texts that make no part are left in the table as errors.
  void
  add_parts(BodyDescription                          &body,
            const std::map<std::string, std::string> &parts,
            const unsigned int                        dimension,
            const std::map<std::string, double>      &constants,
            ParameterTable                           &table);
} // namespace Debond

#endif
