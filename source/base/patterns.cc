// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/base/patterns.h>
#include <debond/base/text.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace Debond
{
  Pattern::Pattern(const std::string                              &text,
                   const std::function<bool(const std::string &)> &predicate)
    : text(text)
    , predicate(predicate)
  {}



  bool
  Pattern::match(const std::string &value) const
  {
    return printable(value) == value && predicate(value);
  }



  std::string
  Pattern::description(const OutputStyle /*style*/) const
  {
    return text;
  }



  std::unique_ptr<dealii::Patterns::PatternBase>
  Pattern::clone() const
  {
    return std::make_unique<Pattern>(*this);
  }



  bool
  read_number(const std::string &text, double &number)
  {
    // std::from_chars() knows no plus sign.
    const char *const first =
      text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-');
    const char *const last   = text.data() + text.size();
    const auto        result = std::from_chars(first, last, number);
    return result.ec == std::errc() && result.ptr == last &&
           std::isfinite(number);
  }



  std::string
  comma_hint(const std::string &text)
  {
    const std::string digits = "0123456789";
    for (std::size_t i = 1; i + 1 < text.size(); ++i)
      if (text[i] == ',' && digits.find(text[i - 1]) != std::string::npos &&
          digits.find(text[i + 1]) != std::string::npos)
        return "; " + decimal_comma;
    return "";
  }



  Pattern
  any_number()
  {
    return Pattern("a number", [](const std::string &value) {
      double result;
      return read_number(value, result);
    });
  }



  Pattern
  number(const std::string &range, bool (*const property)(double))
  {
    return Pattern("a number " + range, [property](const std::string &value) {
      double result;
      return read_number(value, result) && property(result);
    });
  }



  Pattern
  positive_number()
  {
    return number("> 0", [](double x) { return x > 0; });
  }



  Pattern
  quantity(const bool may_be_zero)
  {
    const std::string range = "from 1e-100 to 1e100";
    return Pattern("a number " + range + (may_be_zero ? ", or 0" : ""),
                   [may_be_zero](const std::string &value) {
                     double result;
                     return read_number(value, result) &&
                            ((may_be_zero && result == 0.) ||
                             (result >= 1e-100 && result <= 1e100));
                   });
  }



  Pattern
  whole_number(const unsigned int smallest, const unsigned int largest)
  {
    return Pattern("a whole number from " + std::to_string(smallest) + " to " +
                     std::to_string(largest),
                   [smallest, largest](const std::string &value) {
                     unsigned int      result;
                     const char *const last = value.data() + value.size();
                     const auto [end, error] =
                       std::from_chars(value.data(), last, result);
                     return error == std::errc() && end == last &&
                            smallest <= result && result <= largest;
                   });
  }



  Pattern
  one_of(const std::vector<std::string> &names)
  {
    return Pattern((names.size() == 1 ? "" : "one of ") + join(names, ", "),
                   [names](const std::string &value) {
                     return std::find(names.begin(), names.end(), value) !=
                            names.end();
                   });
  }



  Pattern
  list_of(const std::vector<std::string> &names)
  {
    const Pattern item = one_of(names);
    return Pattern("a list of " + join(names, ", "),
                   [item](const std::string &value) {
                     const std::vector<std::string> items =
                       dealii::Utilities::split_string_list(value, ',');
                     return std::all_of(items.begin(),
                                        items.end(),
                                        [&item](const std::string &name) {
                                          return item.match(name);
                                        });
                   });
  }



  Pattern
  list_of(const Pattern &pattern)
  {
    return Pattern("a list, each " + pattern.description(),
                   [pattern](const std::string &value) {
                     const std::vector<std::string> items =
                       dealii::Utilities::split_string_list(value, ',');
                     return std::all_of(items.begin(),
                                        items.end(),
                                        [&pattern](const std::string &item) {
                                          return pattern.match(item);
                                        });
                   });
  }



  Pattern
  list_of_names()
  {
    return Pattern("a list of names",
                   [](const std::string & /*value*/) { return true; });
  }



  Pattern
  one_for_each_dimension(const Pattern &pattern)
  {
    return Pattern("2 or 3 times " + pattern.description(),
                   [pattern](const std::string &value) {
                     const std::vector<std::string> items =
                       dealii::Utilities::split_string_list(value, ',');
                     return (items.size() == 2 || items.size() == 3) &&
                            std::all_of(items.begin(),
                                        items.end(),
                                        [&pattern](const std::string &item) {
                                          return pattern.match(item);
                                        });
                   });
  }
} // namespace Debond
