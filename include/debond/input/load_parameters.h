// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_load_parameters_h
#define debond_input_load_parameters_h

#include <debond/base/parameter_table.h>
#include <debond/elasticity/material.h>

#include <map>
#include <string>
#include <vector>

namespace Debond
{
  /// f_0 and f_2 as expressions in x, y[, z], components separated by ';'.
  struct LoadParameters
  {
    std::string body_force; ///< empty for none

    /// By the name of the boundary; those without traction are left out.
    std::map<std::string, std::string> tractions;

    /// Names that the expressions may use.
    std::map<std::string, double> constants;
  };

  /// An expression for each component of a vector, or nothing.
  Pattern
  vector_expression();

  /// Declares the section Loads.
  void
  declare_loads(ParameterTable &table);

  /// Takes the section out of the table; what is wrong is left there as an
  /// error. Expressions may use the constants of the material.
  LoadParameters
  read_loads(const unsigned int dimension,
             const Material    &material,
             ParameterTable    &table);

  /// The text of an expression for a vector, empty for none.
  std::string
  read_expression(ParameterTable                      &table,
                  const std::string                   &path,
                  const unsigned int                   dimension,
                  const std::map<std::string, double> &constants);
} // namespace Debond

#endif
