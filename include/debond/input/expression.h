// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_expression_h
#define debond_input_expression_h

#include <deal.II/base/function.h>

#include <map>
#include <memory>
#include <string>

namespace Debond
{
  /**
   * The function with @p n_components given by muParser expressions in x, y[,
   * z], separated by ';', and the given constants and pi. Throws
   * std::invalid_argument, with muParser's words if one does not parse, if
   * there are not as many of them, or if one is no single value that is fixed.
   */
  template <int dim>
  std::shared_ptr<const dealii::Function<dim>>
  make_function(const std::string                   &expressions,
                const std::map<std::string, double> &constants,
                const unsigned int                   n_components = dim);
} // namespace Debond

#endif
