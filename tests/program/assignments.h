// SPDX-License-Identifier: LGPL-2.1-or-later
// Entries of scenes as a test writes them, ENTRY=VALUE.
#ifndef debond_tests_program_assignments_h
#define debond_tests_program_assignments_h

#include <sstream>
#include <string>
#include <vector>

using Values = std::vector<std::string>;



inline Values
operator+(Values values, const Values &others)
{
  values.insert(values.end(), others.begin(), others.end());
  return values;
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

#endif
