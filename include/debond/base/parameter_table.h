// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_parameter_table_h
#define debond_base_parameter_table_h

#include <deal.II/base/parameter_handler.h>

#include <debond/base/patterns.h>

#include <functional>
#include <istream>
#include <map>
#include <ostream>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace Debond
{
  /// Whether a run that goes on from a checkpoint may have another value of an
  /// entry than the run that wrote it.
  enum class AtRestart
  {
    same, ///< the iterates depend on it
    any   ///< it decides when a run ends, or what is done with the result
  };



  /**
   * A dealii::ParameterHandler whose entries have paths ("Section/Name"), which
   * writes their values into variables that are bound to them, and which
   * collects all errors of a scene file, each one line with file, line,
   * parameter, value and what is allowed, in place of throwing the first one.
   */
  class ParameterTable
  {
  public:
    /// Takes the text of an entry, which its pattern allows. What it throws as
    /// std::invalid_argument is why the value is rejected all the same.
    using Reader = std::function<void(const std::string &)>;

    /// Declares an entry whose value parse() writes into @p variable; the value
    /// that this has now is the default. The @p documentation and the @p units
    /// are sentences without their full stop; the printed documentation also
    /// says which values are allowed. The variable has to live as long as
    /// parse() is called.
    void
    bind(const std::string &path,
         double            &variable,
         const Pattern     &pattern,
         const std::string &documentation,
         const std::string &units,
         const AtRestart    restart = AtRestart::same);

    void
    bind(const std::string &path,
         unsigned int      &variable,
         const Pattern     &pattern,
         const std::string &documentation,
         const std::string &units,
         const AtRestart    restart = AtRestart::same);

    void
    bind(const std::string &path,
         std::string       &variable,
         const Pattern     &pattern,
         const std::string &documentation,
         const std::string &units,
         const AtRestart    restart = AtRestart::same);

    /// Numbers, separated by commas.
    void
    bind(const std::string   &path,
         std::vector<double> &variable,
         const Pattern       &pattern,
         const std::string   &documentation,
         const std::string   &units,
         const AtRestart      restart = AtRestart::same);

    /// Any names, separated by commas.
    void
    bind(const std::string     &path,
         std::set<std::string> &variable,
         const std::string     &documentation,
         const AtRestart        restart = AtRestart::same);

    /// "true" or "false".
    void
    bind(const std::string &path,
         bool              &variable,
         const std::string &documentation,
         const AtRestart    restart = AtRestart::same);

    /// One of the @p choices, each a name and the value it stands for.
    template <typename T>
    void
    bind_choice(const std::string                            &path,
                T                                            &variable,
                const std::vector<std::pair<std::string, T>> &choices,
                const std::string                            &documentation,
                const AtRestart restart = AtRestart::same);

    /// Lets scenes set entries "Section/Name WORDS" beside those declared: what
    /// @p path, "Section/Name", is to be followed by is not known beforehand;
    /// "Section/" stands for entries "Section/WORDS". parse() writes those that
    /// are not empty into @p variable, by their WORDS.
    void
    bind_family(const std::string                  &path,
                std::map<std::string, std::string> &variable,
                const Pattern                      &pattern,
                const std::string                  &documentation,
                const std::string                  &units);

    /// Declares an entry that @p reader takes. Without one it is a member of a
    /// family, known beforehand.
    void
    declare(const std::string &path,
            const std::string &default_value,
            const Pattern     &pattern,
            const std::string &documentation,
            const std::string &units,
            const Reader      &reader  = {},
            const AtRestart    restart = AtRestart::same);

    /// Reads a scene in ParameterHandler's format ("subsection", "set", "end",
    /// comments from '#', continuation by '\'). "include FILE" outside of
    /// subsections reads another file first, whose path is relative to this
    /// one's folder; what it sets can be set again. Setting an entry twice in
    /// one file is an error. @p file is used in messages.
    void
    read(std::istream &input, const std::string &file);

    /// An assignment "Section/Name=value" from the command line.
    void
    assign(const std::string &assignment);

    /// Sets an entry to what follows from @p source, another one or its own
    /// text, whose place it gets in messages.
    void
    derive(const std::string &path,
           const std::string &value,
           const std::string &source);

    /// Writes all variables, in the order in which they were bound. An entry
    /// whose value was not allowed counts as left out.
    void
    parse();

    /// Whether a scene or the command line sets the entry.
    bool
    is_set(const std::string &path) const;

    /// The value as it was written.
    std::string
    get(const std::string &path) const;

    /// Where each entry was set, "FILE:LINE"; the file if it was not.
    std::map<std::string, std::string>
    locations() const;

    /// Adds @p message to errors(), with the file and line of the entry @p
    /// path, unless the value of it, or of one of @p others, of which the
    /// message speaks too, was not allowed in the first place.
    void
    add_error(const std::string              &path,
              const std::string              &message,
              const std::vector<std::string> &others = {});

    /// As add_error(), with a message made of the name and value of @p path and
    /// the @p reason why this value is not allowed.
    void
    reject(const std::string              &path,
           const std::string              &reason,
           const std::vector<std::string> &others = {});

    /// For @p entries, separated by commas, that the run does not look at for
    /// this @p reason, with their families and sections ("Section/"). What has
    /// another value than the default is named in notes(), or rejected if an
    /// entry is given because of whose value the run does not.
    void
    without_effect(const std::string &entries,
                   const std::string &reason,
                   const std::string &rejected_for = "");

    /// One line each, in the order of their detection.
    const std::vector<std::string> &
    errors() const;

    const std::vector<std::string> &
    notes() const;

    /// Whether a file had this section, which is not declared.
    bool
    has_unknown_section(const std::string &path) const;

    /// Prints all entries in the order of their declaration as a scene that
    /// read() accepts.
    void
    print(std::ostream &out, const bool documentation) const;

  private:
    struct Entry
    {
      std::string expected; ///< in words
      std::string default_value;
      AtRestart   restart;
    };

    struct Family
    {
      Pattern                             pattern;
      std::string                         documentation;
      std::string                         units;
      std::map<std::string, std::string> *variable;
    };

    std::string
    location(const std::string &path) const;

    std::vector<std::string>
    known_entries() const;

    /// Declares @p path if it belongs to a family; otherwise returns false.
    bool
    declare_member(const std::string &path);

    void
    set(const std::string &path,
        const std::string &value,
        const std::string &location);

    void
    read_included(const std::string &name,
                  const std::string &file,
                  const std::string &location);

    dealii::ParameterHandler           handler;
    std::map<std::string, Entry>       entries;  ///< by path
    std::map<std::string, Family>      families; ///< by path
    std::map<std::string, std::string> set_at;   ///< by path
    std::set<std::string>              rejected;
    std::set<std::string>              unknown_sections;
    std::vector<std::string>           lines;
    std::vector<std::string>           note_lines;
    std::string                        file_name;
    std::vector<std::string>           reading; ///< files that include others
    unsigned int                       n_included = 0; ///< files in all

    /// By path, in the order of their declaration.
    std::vector<std::pair<std::string, Reader>> readers;
  };



  template <typename T>
  void
  ParameterTable::bind_choice(
    const std::string                            &path,
    T                                            &variable,
    const std::vector<std::pair<std::string, T>> &choices,
    const std::string                            &documentation,
    const AtRestart                               restart)
  {
    std::vector<std::string> names;
    std::string              default_name;
    for (const auto &[name, value] : choices)
      {
        names.push_back(name);
        if (value == variable)
          default_name = name;
      }
    declare(
      path,
      default_name,
      one_of(names),
      documentation,
      "none",
      [&variable, choices](const std::string &text) {
        for (const auto &[name, value] : choices)
          if (name == text)
            variable = value;
      },
      restart);
  }
} // namespace Debond

#endif
