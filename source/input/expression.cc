// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/function_parser.h>
#include <deal.II/base/utilities.h>

#include <debond/input/expression.h>

#include <iostream>
#include <sstream>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    /// FunctionParser reports errors on std::cerr in many lines before it
    /// throws; this keeps them back.
    class QuietErrors
    {
    public:
      QuietErrors()
        : buffer(std::cerr.rdbuf(nullptr))
      {}

      ~QuietErrors()
      {
        std::cerr.rdbuf(buffer);
        std::cerr.clear();
      }

      QuietErrors(const QuietErrors &) = delete;

    private:
      std::streambuf *const buffer;
    };
  } // namespace



  template <int dim>
  std::shared_ptr<const dealii::Function<dim>>
  make_function(const std::string                   &expressions,
                const std::map<std::string, double> &constants,
                const unsigned int                   n_components)
  {
    const std::size_t n_expressions =
      dealii::Utilities::split_string_list(expressions, ';').size();
    if (n_expressions != n_components)
      throw std::invalid_argument("expected " + std::to_string(n_components) +
                                  " components separated by ';', but found " +
                                  std::to_string(n_expressions));

    std::map<std::string, double> all_constants = constants;
    all_constants.emplace("pi", dealii::numbers::PI);

    try
      {
        const QuietErrors quiet;
        const auto        function =
          std::make_shared<dealii::FunctionParser<dim>>(n_components);
        function->initialize(
          dealii::FunctionParser<dim>::default_variable_names(),
          expressions,
          all_constants);
        // FunctionParser parses when it is evaluated first.
        for (unsigned int component = 0; component < n_components; ++component)
          function->value(dealii::Point<dim>(), component);
        return function;
      }
    catch (const dealii::ExceptionBase &error)
      {
        std::ostringstream text;
        error.print_info(text);
        throw std::invalid_argument(dealii::Utilities::trim(text.str()));
      }
  }



  template decltype(make_function<2>) make_function<2>;
  template decltype(make_function<3>) make_function<3>;
} // namespace Debond
