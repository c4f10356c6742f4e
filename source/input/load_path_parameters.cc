// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/input/load_path_parameters.h>

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    constexpr unsigned int most_factors = 10000;



    double
    rounded_to_decimals(const double number)
    {
      std::ostringstream text;
      text.precision(12);
      text << number;
      return std::stod(text.str());
    }



    /// The values of FIRST:STEP:LAST.
    std::vector<double>
    range(const std::string &item,
          const double       first,
          const double       step,
          const double       last)
    {
      const double n = step == 0. ? -1. : std::round((last - first) / step);
      if (!(n >= 1. && std::abs(first + n * step - last) <=
                         1e-9 * (std::abs(first) + std::abs(last))))
        throw std::invalid_argument("the step of " + item +
                                    " does not lead from its first to its "
                                    "last factor");
      if (n >= most_factors)
        throw std::invalid_argument(item + " has more than " +
                                    std::to_string(most_factors) + " factors");

      std::vector<double> values;
      for (unsigned int k = 0; k <= n; ++k)
        {
          const double value = first + (last - first) * (k / n);
          values.push_back(std::abs(value) < 1e-9 * std::abs(step) ?
                             0. :
                             rounded_to_decimals(value));
        }
      return values;
    }



    /// A number, or a range.
    std::vector<double>
    parse_item(const std::string &item)
    {
      std::vector<double> numbers;
      for (const std::string &word :
           dealii::Utilities::split_string_list(item, ':'))
        {
          double number;
          if (!read_number(word, number))
            throw std::invalid_argument("'" + word + "' is not a number");
          numbers.push_back(number);
        }
      switch (numbers.size())
        {
          case 1:
            return numbers;
          case 3:
            return range(item, numbers[0], numbers[1], numbers[2]);
          default:
            throw std::invalid_argument(
              "'" + item + "' is neither a number nor a range FIRST:STEP:LAST");
        }
    }
  } // namespace



  std::vector<double>
  parse_load_factors(const std::string &text)
  {
    std::vector<double> factors;
    for (const std::string &item :
         dealii::Utilities::split_string_list(text, ','))
      for (const double factor : parse_item(item))
        if (factors.empty() || factor != factors.back())
          factors.push_back(factor);
    if (factors.size() > most_factors)
      throw std::invalid_argument("there are more than " +
                                  std::to_string(most_factors) + " factors");
    return factors;
  }



  void
  bind_load_path(LoadPathParameters &load_path, ParameterTable &table)
  {
    table.declare(
      "Load path/Factors",
      "",
      Pattern("nothing, or numbers and ranges FIRST:STEP:LAST, separated by "
              "commas",
              [](const std::string & /*value*/) { return true; }),
      "Multiples of all loads that are applied one after the other, each solved from the state before it, the first one from rest, such as '0:0.05:1.2, 1.2:-0.05:0' for loading and unloading; empty for the loads as they are. Needs majorise minimise with a direct linear solver",
      "none",
      [&load_path](const std::string &text) {
        load_path.factors = parse_load_factors(text);
      });
    table.bind_choice(
      "Load path/Global branch",
      load_path.global_branch,
      {{"none", GlobalBranch::none},
       {"search", GlobalBranch::search},
       {"prove", GlobalBranch::prove}},
      "What is computed beside the states that the load path leads to: search is the lowest minimum that a search finds at each factor (full, unless Solver/Search is quick), prove has it proved as well, with the limits of Solver/Proof for each factor, and needs nodal quadrature");
  }
} // namespace Debond
