// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_parameter_table_h
#define debond_base_parameter_table_h

#include <deal.II/base/parameter_handler.h>

#include <debond/base/text.h>

#include <array>
#include <functional>
#include <istream>
#include <map>
#include <memory>
#include <ostream>
#include <set>
#include <type_traits>
#include <utility>

namespace Debond
{
  /// The values that an entry may have, by a property and the words that
  /// describe it. Of a list they are the words for it all, and the property of
  /// each item.
  class Pattern : public dealii::Patterns::PatternBase
  {
  public:
    using Property = std::function<bool(const std::string &)>;

    /// Allows any text without a property.
    explicit Pattern(const std::string &words, const Property &property = {})
      : words(words)
      , property(property)
    {}

    bool
    match(const std::string &value) const override
    {
      return printable(value) == value && (!property || property(value));
    }

    std::string
    description(const OutputStyle = Machine) const override
    {
      return words;
    }

    std::unique_ptr<PatternBase>
    clone() const override
    {
      return std::make_unique<Pattern>(*this);
    }

    bool
    allows_any_text() const
    {
      return !property;
    }

  private:
    std::string words;
    Property    property;
  };

  /// A finite number with the property that @p range describes, as "> 0" does.
  Pattern
  number(
    const std::string &range       = "",
    bool (*const property)(double) = [](double) { return true; });

  /// "a number > 0".
  inline Pattern
  positive_number()
  {
    return number("> 0", [](double x) { return x > 0; });
  }

  /// What may be aimed at, relative to J; 0 for no aim.
  inline Pattern
  relative_target()
  {
    return number("that is 0 or in [1e-7, 1)",
                  [](double x) { return x == 0. || (x >= 1e-7 && x < 1.); });
  }

  /// A positive number in units of the user, such that its products with others
  /// can be computed.
  Pattern
  quantity(const bool may_be_zero = false);

  /// Any text with items between commas, semicolons and colons that may be
  /// expressions of constants.
  inline Pattern
  text_with_numbers(const std::string &words)
  {
    return Pattern(words, [](const std::string &) { return true; });
  }

  Pattern
  whole_number(const int smallest, const int largest);

  Pattern
  one_of(const std::vector<std::string> &names);



  /**
   * A dealii::ParameterHandler whose entries have paths ("Section/Name"), and
   * which collects all errors of a scene file, each one line with file, line,
   * parameter, value and what is allowed, in place of throwing the first one.
   */
  class ParameterTable
  {
  public:
    /// add_parameter(): the @p variable's value is the default, and it has to
    /// live as long as the table. The @p documentation and the @p units are
    /// sentences without their full stop.
    template <typename T>
    void
    bind(const std::string &path,
         T                 &variable,
         const Pattern     &pattern,
         const std::string &documentation,
         const std::string &units = "none");

    /// A bool, or a set of any names.
    template <typename T>
    void
    bind(const std::string &path, T &variable, const std::string &documentation)
    {
      const bool is_switch = std::is_same_v<T, bool>;
      bind(path,
           variable,
           is_switch ? one_of({"true", "false"}) : Pattern("a list of names"),
           documentation);
    }

    /// One of the @p choices, each a name and the value it stands for.
    template <typename T>
    void
    bind_choice(const std::string                            &path,
                T                                            &variable,
                const std::vector<std::pair<std::string, T>> &choices,
                const std::string                            &documentation);

    /// Takes the text of an entry, which its pattern allows. What it throws as
    /// std::invalid_argument is why the value is rejected all the same.
    using Reader = std::function<void(const std::string &)>;

    /// An entry that @p reader takes, the default at once.
    void
    declare(const std::string &path,
            const std::string &default_value,
            const Pattern     &pattern,
            const std::string &documentation,
            const std::string &units,
            const Reader      &reader);

    /// Entries "@p path WORDS" or, if this ends in '/', "@p pathWORDS", whose
    /// words only the scene knows; @p variable has those that are not empty, by
    /// their WORDS.
    void
    bind_family(const std::string                  &path,
                std::map<std::string, std::string> &variable,
                const Pattern                      &pattern,
                const std::string                  &documentation,
                const std::string                  &units = "none");

    /// Declares the entry @p path if it belongs to a family; otherwise returns
    /// false. It has the @p documentation of the family unless it has its own.
    bool
    declare_member(const std::string &path,
                   const std::string &documentation = "");

    /// Reads a scene in ParameterHandler's format ("subsection", "set", "end",
    /// comments from '#', continuation by '\'). "include FILE" outside of
    /// subsections reads another file first, whose path is relative to this
    /// one's folder; what it sets can be set again. Setting an entry twice in
    /// one file is an error.
    void
    read(std::istream &input, const std::string &file);

    /// Reads an assignment "Section/Name=value" from the command line.
    void
    assign(const std::string &assignment);

    /// Gives the variables the values that have been read. If an entry may not
    /// have just any text, or does not allow what was written, it has what
    /// @p evaluate makes of this as far as it allows that; errors are of what
    /// was written.
    void
    take_values(
      const std::function<std::string(const std::string &)> &evaluate =
        [](const std::string &text) { return text; });

    /// Sets an entry to what follows from the entry @p source, itself or
    /// another one, whose place it gets in messages.
    void
    derive(const std::string &path,
           const std::string &value,
           const std::string &source)
    {
      const std::string location = locations().at(source);
      if (entries.count(path) == 0)
        declare_member(path);
      entries.at(path).set_at = location;
      take(path, value);
    }

    bool
    is_set(const std::string &path) const
    {
      return entries.count(path) > 0 && !entries.at(path).set_at.empty();
    }

    /// The value as it was written or, after take_values(), as it was taken.
    const std::string &
    get(const std::string &path) const
    {
      return entries.at(path).value;
    }

    /// Returns the place where each entry was set, "FILE:LINE", or the file if
    /// it was not.
    std::map<std::string, std::string>
    locations() const;

    /// Adds an error: name and value of the entry @p path and the @p reason why
    /// it is not allowed, unless it, or one of @p others, of which the reason
    /// speaks too, was not allowed in the first place.
    void
    reject(const std::string              &path,
           const std::string              &reason,
           const std::vector<std::string> &others = {});

    /// Names in a note which of the @p entries, separated by commas, with their
    /// families and sections ("Section/"), have another value than the default
    /// although the run does not look at them for this @p reason, or rejects
    /// them if an entry is given because of whose value the run does not.
    void
    without_effect(const std::string &entries,
                   const std::string &reason,
                   const std::string &rejected_for = "");

    /// Prints all entries in the order of their declaration as a scene.
    void
    print(std::ostream &out, const bool documentation) const;

    /// Prints names, values, defaults, documentation and what is allowed as
    /// JSON, families with a member NAME.
    void
    print_json(std::ostream &out);

    /// Errors and notes have one line each, in the order of their detection.
    std::vector<std::string> errors, notes;

  private:
    struct Entry
    {
      std::string value, default_value;
      Pattern     pattern;
      std::string set_at      = ""; ///< "FILE:LINE"
      bool        is_rejected = false;
    };

    struct Family
    {
      std::map<std::string, std::string> *variable;
      Pattern                             pattern;
      std::string                         documentation, units;
    };

    void
    in_section(const std::string                              &path,
               const std::function<void(const std::string &)> &action);

    static std::string
    text(const std::string &documentation,
         const Pattern     &pattern,
         const std::string &units)
    {
      return documentation + ". Allowed: " + pattern.description() +
             ". Units: " + units + ".";
    }

    std::vector<std::string>
    known_sections() const;

    void
    set(const std::string &path,
        const std::string &value,
        const std::string &location);

    /// Returns why the value is not allowed, or nothing.
    std::string
    take(const std::string &path, const std::string &value);

    /// Values that a file and those that it includes set, with their
    /// locations, by path.
    using FileValues = std::map<std::string, std::array<std::string, 2>>;

    const FileValues &
    read_included(const std::string &name,
                  const std::string &file,
                  const std::string &location);

    dealii::ParameterHandler      handler;
    std::map<std::string, Entry>  entries;   ///< by path
    std::map<std::string, Family> families;  ///< by path
    std::vector<std::string>      set_paths; ///< in the order of reading
    std::string                   file_name;

    struct ReadFile
    {
      FileValues values;
      bool       is_open = true;
    };
    std::map<std::string, ReadFile> read_files; ///< by canonical name
  };



  template <typename T>
  void
  ParameterTable::bind(const std::string &path,
                       T                 &variable,
                       const Pattern     &pattern,
                       const std::string &documentation,
                       const std::string &units)
  {
    const auto add = [&](const dealii::Patterns::PatternBase &allowed) {
      in_section(path, [&](const std::string &name) {
        handler.add_parameter(name,
                              variable,
                              text(documentation, pattern, units),
                              allowed);
        const std::string value = handler.get(name);
        entries.emplace(path, Entry{value, value, pattern});
      });
    };
    if constexpr (dealii::Patterns::Tools::is_list_compatible<T>::value)
      add(dealii::Patterns::List(pattern));
    else
      add(pattern);
  }



  template <typename T>
  void
  ParameterTable::bind_choice(
    const std::string                            &path,
    T                                            &variable,
    const std::vector<std::pair<std::string, T>> &choices,
    const std::string                            &documentation)
  {
    std::vector<std::string> names;
    std::string              default_name;
    for (const auto &[name, value] : choices)
      {
        names.push_back(name);
        if (value == variable)
          default_name = name;
      }
    const auto read = [&variable, choices](const std::string &text) {
      for (const auto &[name, value] : choices)
        if (name == text)
          variable = value;
    };
    declare(path, default_name, one_of(names), documentation, "none", read);
  }
} // namespace Debond

#endif
