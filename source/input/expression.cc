// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/function_parser.h>
#include <deal.II/base/utilities.h>

#include <debond/base/entry_error.h>
#include <debond/base/instantiate.h>
#include <debond/base/text.h>
#include <debond/input/expression.h>

#include <boost/algorithm/string/replace.hpp>
#include <boost/io/ios_state.hpp>

#include <cctype>
#include <cmath>
#include <iostream>
#include <limits>

namespace Debond
{
  namespace
  {
    /// Throws std::invalid_argument for what muParser takes in another sense
    /// than its author: for it the value of "a, b" is b, "a < b < c" compares
    /// c with 0 or 1, "=" assigns to a coordinate, and rand() has another value
    /// each time.
    void
    check_sense(const std::string &text)
    {
      // The text is gone through once. Letters, digits and underscores make up
      // a name, which any other character but a blank ends. For each open
      // bracket it is known whether the name of a function stands in front of
      // it, since only there a comma separates arguments, and how many
      // comparisons have followed each other. A comma or an operator between
      // two comparisons sets that number back.
      std::vector<bool>         has_arguments; // of each bracket that is open
      std::vector<unsigned int> n_comparisons = {0}; // in each
      std::string               name;                // that ends here
      for (std::size_t i = 0; i <= text.size(); ++i)
        {
          const char c = text.c_str()[i];
          if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_')
            {
              name += c;
              continue;
            }
          if (name == "rand" || name == "rand_seed")
            throw std::invalid_argument(name + " has no fixed value");
          if (c == '<' || c == '>' ||
              (c == '=' && i > 0 && (text[i - 1] == '=' || text[i - 1] == '!')))
            ++n_comparisons.back();
          else if (c != '\0' &&
                   std::string(",&|?:").find(c) != std::string::npos)
            n_comparisons.back() = 0;
          if (n_comparisons.back() > 1)
            throw std::invalid_argument("behind '" + text.substr(0, i) +
                                        "' the second comparison is one with 0 "
                                        "or 1: write a < x && x < b");
          if (c == '*' && text.c_str()[i + 1] == '*')
            throw std::invalid_argument("'" + text.substr(0, i) +
                                        "' has **; powers are x^2");
          if (c == '(')
            {
              has_arguments.push_back(!name.empty());
              n_comparisons.push_back(0);
            }
          else if (c == ')' && !has_arguments.empty())
            {
              has_arguments.pop_back();
              n_comparisons.pop_back();
            }
          else if (c == ',' && (has_arguments.empty() || !has_arguments.back()))
            throw std::invalid_argument("the comma behind '" +
                                        text.substr(0, i) +
                                        "' separates no arguments of a "
                                        "function; components are separated by "
                                        "';'; " +
                                        decimal_comma);
          else if (c == '=' && text.c_str()[i + 1] != '=' &&
                   (i == 0 ||
                    std::string("<>!=").find(text[i - 1]) == std::string::npos))
            throw std::invalid_argument(
              "\"=\" behind '" + dealii::Utilities::trim(text.substr(0, i)) +
              "' assigns; \"==\" compares");
          if (std::isspace(static_cast<unsigned char>(c)) == 0)
            name.clear();
        }
    }
  } // namespace



  template <int dim>
  std::shared_ptr<const dealii::Function<dim>>
  make_function(const std::string &expressions,
                const Constants   &constants,
                const unsigned int n_components,
                const std::string &variables)
  {
    // Mistakes that muParser would not find, or would find in words that help
    // nobody, are looked for first. The sense of each component is checked
    // before their number, so that a comma in the place of a semicolon is
    // explained and not only counted.
    const std::vector<std::string> components =
      dealii::Utilities::split_string_list(expressions, ';');
    for (const std::string &component : components)
      {
        if (component.find_first_of("0123456789_abcdefghijklmnopqrstuvwxyz"
                                    "ABCDEFGHIJKLMNOPQRSTUVWXYZ") ==
            std::string::npos)
          throw std::invalid_argument("'" + component +
                                      "' is no expression; 0 stands for none");
        check_sense(component);
      }
    if (components.size() != n_components)
      throw std::invalid_argument("expected " + std::to_string(n_components) +
                                  " components separated by ';', but found " +
                                  std::to_string(components.size()));

    // A constant of the scene may be called pi; emplace() leaves it as it is.
    Constants all_constants = constants;
    all_constants.emplace("pi", dealii::numbers::PI);

    try
      {
        // FunctionParser reports errors in many lines before it throws.
        const boost::io::ios_rdbuf_saver quiet(std::cerr, nullptr);
        const auto                       function =
          std::make_shared<dealii::FunctionParser<dim>>(n_components);
        function->initialize(
          variables.empty() ?
            dealii::FunctionParser<dim>::default_variable_names() :
            variables,
          boost::replace_all_copy(
            boost::replace_all_copy(expressions, "||", " || "), "&&", " && "),
          all_constants);
        // FunctionParser parses when it is evaluated first. The blanks keep it
        // from taking the letters behind an operator for a part of that.
        for (unsigned int component = 0; component < n_components; ++component)
          function->value(dealii::Point<dim>(), component);
        return function;
      }
    catch (const dealii::ExceptionBase &error)
      {
        // Each component is parsed alone, so that the message names the one
        // that is wrong; the first of them throws.
        if (n_components > 1)
          for (const std::string &component : components)
            make_function<dim>(component, constants, 1);
        // The column before muParser's words is the number of its error.
        const std::string  start = "The parser said: ";
        std::ostringstream text;
        error.print_info(text);
        const std::size_t at = text.str().find(start);
        throw std::invalid_argument(
          "in '" + expressions + "': " +
          dealii::Utilities::trim(text.str().substr(
            at == std::string::npos ? 0 : at + start.size())) +
          number_hint(expressions));
      }
  }



  namespace
  {
    /// Returns the value of an expression without a place. Throws
    /// std::invalid_argument.
    double
    constant_value(const std::string &expression, const Constants &constants)
    {
      // The variable that the function needs is called _, so that x, y and z
      // are unknown here.
      const double value =
        make_function<1>(expression, constants, 1, "_")->value({});
      if (!std::isfinite(value))
        throw std::invalid_argument(expression + " is not finite");
      return value;
    }
  } // namespace



  Constants
  evaluate_constants(std::map<std::string, std::string> expressions)
  {
    // Constants may stand in any order. Each pass evaluates those whose own
    // constants have values; one that evaluates none has met a mistake or a
    // circle, and the message is that of one of the remaining constants.
    Constants constants;
    while (!expressions.empty())
      {
        // One that uses others has a value as soon as they do.
        std::string       name, reason;
        const std::size_t n_left = expressions.size();
        for (auto it = expressions.begin(); it != expressions.end();)
          try
            {
              const double value   = constant_value(it->second, constants);
              constants[it->first] = value;
              it                   = expressions.erase(it);
            }
          catch (const std::invalid_argument &error)
            {
              name   = it->first;
              reason = error.what();
              ++it;
            }
        if (expressions.size() == n_left)
          throw EntryError(
            name, reason + " (constants may use each other, but in no circle)");
      }
    return constants;
  }



  std::string
  with_values(const std::string &list, const Constants &constants)
  {
    // What is neither a number nor an expression of constants stays as it is: a
    // name, a word or an expression in x, on which the pattern of the entry
    // decides.
    const auto with_value = [&constants](const std::string &item) {
      const std::string text = dealii::Utilities::trim(item);
      double            value;
      // Most words are none, which muParser would take long to say.
      const bool is_number = read_number(text, value);
      if (!is_number && text.find_first_of("+-*/^(") == std::string::npos &&
          constants.count(text) == 0 && text != "pi")
        return item;
      try
        {
          if (!is_number)
            value = constant_value(text, constants);
        }
      catch (const std::invalid_argument &)
        {
          return item;
        }
      // Numbers of cells may be written as 20.0, and 0.3 / 0.1 is 3 but for
      // rounding.
      const bool is_whole =
        std::abs(value - std::round(value)) <=
          4. * std::numeric_limits<double>::epsilon() * std::abs(value) &&
        std::abs(value) < 1e9;
      // A number keeps the digits that were written, unless it is whole:
      // patterns of whole numbers allow no point.
      return is_number && !is_whole ?
               item :
               item.substr(0, item.find(text)) +
                 (is_whole ? std::to_string(std::lround(value)) :
                             shortest_text(value));
    };
    // A comma within brackets separates the arguments of a function and no
    // items.
    std::string  result, item;
    unsigned int n_open = 0; // brackets
    for (const char c : list)
      {
        n_open += (c == '(') - (c == ')');
        if (n_open > 0 || std::string(",;:").find(c) == std::string::npos)
          item += c;
        else
          {
            result += with_value(item) + c;
            item.clear();
          }
      }
    return result + with_value(item);
  }



  template decltype(make_function<1>) make_function<1>;
  DEBOND_INSTANTIATE(make_function);
} // namespace Debond
