// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_expression_h
#define debond_input_expression_h

#include <deal.II/base/function.h>

#include <map>
#include <memory>
#include <string>

namespace Debond
{
  /// Values by names.
  using Constants = std::map<std::string, double>;

  /**
   * The function with @p n_components given by muParser expressions in x, y[,
   * z], or in other @p variables, separated by ';', and the given constants and
   * pi. Throws std::invalid_argument, with muParser's words if one does not
   * parse, if there are not as many of them, or if one is no single value that
   * is fixed.
   */
  template <int dim>
  std::shared_ptr<const dealii::Function<dim>>
  make_function(const std::string &expressions,
                const Constants   &constants,
                const unsigned int n_components = dim,
                const std::string &variables    = "");

  /// Returns the values of constants by their names from expressions, which may
  /// use each other. Throws EntryError with the name of one that has no finite
  /// value.
  Constants
  evaluate_constants(std::map<std::string, std::string> expressions);

  /// Returns the list with the value in place of each item between commas,
  /// semicolons and colons that is an expression of constants but no number,
  /// and whole numbers without a point or an exponent.
  std::string
  with_values(const std::string &list, const Constants &constants);
} // namespace Debond

#endif
