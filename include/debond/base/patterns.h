// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_patterns_h
#define debond_base_patterns_h

#include <deal.II/base/patterns.h>

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace Debond
{
  /// Which values a parameter may have, by a predicate and the words that
  /// describe it.
  class Pattern : public dealii::Patterns::PatternBase
  {
  public:
    Pattern(const std::string                              &text,
            const std::function<bool(const std::string &)> &predicate);

    bool
    match(const std::string &value) const override;

    /// The words given to the constructor, for any @p style.
    std::string
    description(const OutputStyle style = Machine) const override;

    std::unique_ptr<PatternBase>
    clone() const override;

  private:
    std::string                              text;
    std::function<bool(const std::string &)> predicate;
  };

  /// What @p parse takes without throwing std::invalid_argument.
  template <typename Parser>
  Pattern
  parsed_by(const std::string &text, const Parser &parse)
  {
    return Pattern(text, [parse](const std::string &value) {
      try
        {
          parse(value);
          return true;
        }
      catch (const std::invalid_argument &)
        {
          return false;
        }
    });
  }

  /// Reads a finite number. Returns false if the text is anything else.
  bool
  read_number(const std::string &text, double &number);

  /// The question for one who may have written one.
  inline const std::string decimal_comma =
    "decimal comma? Numbers have a point, and nothing between thousands";

  /// That behind "; " if the text has a comma between two digits, or nothing.
  std::string
  comma_hint(const std::string &text);

  /// A finite number.
  Pattern
  any_number();

  /// A number with the property that @p range describes, such as "> 0".
  Pattern
  number(const std::string &range, bool (*const property)(double));

  /// "a number > 0".
  Pattern
  positive_number();

  /// A positive number in units of the user, such that its products with others
  /// can be computed.
  Pattern
  quantity(const bool may_be_zero = false);

  Pattern
  whole_number(const unsigned int smallest, const unsigned int largest);

  /// One of the names.
  Pattern
  one_of(const std::vector<std::string> &names);

  /// Any number of the names, separated by commas.
  Pattern
  list_of(const std::vector<std::string> &names);

  /// Any number of values that fit @p pattern, separated by commas, described
  /// as "a list, each " and the words of the pattern.
  Pattern
  list_of(const Pattern &pattern);

  /// Any number of any names, separated by commas.
  Pattern
  list_of_names();

  /// 2 or 3 values, one for each dimension, that fit @p pattern, described as
  /// "2 or 3 times " and the words of the pattern.
  Pattern
  one_for_each_dimension(const Pattern &pattern);
} // namespace Debond

#endif
