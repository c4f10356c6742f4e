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



/// Throws what the table of a scene throws.
inline Debond::Parameters
parameters_of(const Values &values)
{
  Debond::SceneTable table;
  std::stringstream  none;
  table.read(none, "test");
  for (const std::string &value : values)
    table.assign(value);
  return table.parameters("test");
}

#endif
