// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_load_parameters_h
#define debond_input_load_parameters_h

#include <debond/base/parameter_table.h>
#include <debond/elasticity/material.h>
#include <debond/input/expression.h>
#include <debond/mesh/body.h>

namespace Debond
{
  /// A load on a boundary, as an expression.
  struct SurfaceLoad
  {
    std::string kind; ///< "Traction", "Pressure" or "Force"
    std::string boundary;
    std::string expression;

    /// The path of its entry.
    std::string
    entry() const
    {
      return "Loads/" + kind + ' ' + boundary;
    }

    /// The number of components of the expression: a pressure has one.
    unsigned int
    n_components(const unsigned int dimension) const
    {
      return kind == "Pressure" ? 1 : dimension;
    }
  };



  /// f_0 and f_2 as expressions in x, y[, z], components separated by ';'.
  struct LoadParameters
  {
    std::string body_force; ///< empty for none

    /// Expressions by the names of boundaries; those without one are left out.
    std::map<std::string, std::string> tractions;
    std::map<std::string, std::string> pressures;
    std::map<std::string, std::string> forces;

    /// Returns all of these.
    std::vector<SurfaceLoad>
    on_boundaries() const;

    std::string temperature_change; ///< one expression, empty for none

    /// Names that the expressions may use.
    Constants constants;
  };

  /// An expression for each component of a vector, or nothing.
  inline Pattern
  vector_expression()
  {
    return Pattern(
      "nothing, or an expression for each component, separated by ';'");
  }

  /// The section Loads.
  void
  bind_loads(LoadParameters &loads, ParameterTable &table);

  /// The section Constants, whose texts by name become @p texts, and
  /// Loads/Constants. constants_of() has their values before other entries are
  /// taken.
  void
  bind_constants(std::map<std::string, std::string> &texts,
                 ParameterTable                     &table);

  /// Returns the values of the constants that the table has read. Throws
  /// BadInput if one has none, is there twice or has a name that none may have.
  Constants
  constants_of(const ParameterTable &table);

  /// Adds the constants of the material, which expressions may use, and checks
  /// these; what is wrong is left in the table as an error.
  void
  complete_loads(const unsigned int dimension,
                 const Material    &material,
                 LoadParameters    &loads,
                 ParameterTable    &table);

  /// Commas in a list separate names: puts @p known ones together again that
  /// have commas themselves and stand in the list as they are.
  void
  join_names(const std::string           &list,
             const std::set<std::string> &known,
             std::set<std::string>       &names);

  /// Rejects the entry @p path if the body has not all boundaries of these
  /// names.
  void
  check_names(const std::string           &path,
              const std::set<std::string> &names,
              const BodyDescription       &body,
              ParameterTable              &table);

  /// Rejects the entry @p path if the @p expression that it has is not one of
  /// so many components. An empty one stands for none.
  void
  check_expression(const std::string &path,
                   const std::string &expression,
                   const unsigned int dimension,
                   const unsigned int n_components,
                   const Constants   &constants,
                   ParameterTable    &table);
} // namespace Debond

#endif
