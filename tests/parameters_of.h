// SPDX-License-Identifier: LGPL-2.1-or-later
// The parameters of a scene of which only assignments are written.
#ifndef debond_tests_parameters_of_h
#define debond_tests_parameters_of_h

#include <debond/input/parameters.h>

#include <sstream>
#include <string>
#include <vector>

// Entries of a scene as a test writes them, ENTRY=VALUE.
using Values = std::vector<std::string>;



inline Values
operator+(Values values, const Values &others)
{
  values.insert(values.end(), others.begin(), others.end());
  return values;
}



inline void
operator+=(Values &values, const Values &others)
{
  values.insert(values.end(), others.begin(), others.end());
}



/// With all its digits.
inline std::string
text(const double value)
{
  std::ostringstream out;
  out.precision(17);
  out << value;
  return out.str();
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
  table.evaluate();
  return table.parameters(scene.empty() ? "scene.prm" : scene);
}



inline Debond::Parameters
parameters_of(const Values &values)
{
  return parameters_of_file("", values);
}

#endif
