// SPDX-License-Identifier: LGPL-2.1-or-later
// The parameters of a scene of which only assignments are written.
#ifndef debond_tests_program_parameters_of_h
#define debond_tests_program_parameters_of_h

#include <debond/input/parameters.h>

#include "assignments.h"

/// As "values + {...}" is no expression.
inline Values
with(const Values &values, const Values &more)
{
  return values + more;
}



/// Of a scene, or of none if that is empty, and what is set beside it. Throws
/// what the table of a scene throws.
inline Debond::Parameters
parameters_of_file(const std::string &scene, const Values &values = {})
{
  Debond::SceneTable table;
  if (!scene.empty())
    Debond::read_scene(scene, table);
  for (const std::string &value : values)
    table.assign(value);
  return table.parameters(scene.empty() ? "scene.prm" : scene);
}



inline Debond::Parameters
parameters_of(const Values &values)
{
  return parameters_of_file("", values);
}

#endif
