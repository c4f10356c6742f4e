// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_parameter_table_h
#define debond_base_parameter_table_h

#include <deal.II/base/parameter_handler.h>

#include <debond/base/patterns.h>

#include <istream>
#include <map>
#include <ostream>
#include <set>
#include <string>
#include <vector>

namespace Debond
{
  /**
   * A dealii::ParameterHandler whose entries have paths ("Section/Name"), and
   * which collects all errors of a scene file, each one line with file, line,
   * parameter, value and what is allowed, in place of throwing the first one.
   */
  class ParameterTable
  {
  public:
    /// The @p documentation and the @p units are sentences without their full
    /// stop; the printed documentation also says which values are allowed.
    void
    declare(const std::string &path,
            const std::string &default_value,
            const Pattern     &pattern,
            const std::string &documentation,
            const std::string &units);

    /// Lets scenes set entries "Section/Name WORDS" beside those declared: what
    /// @p path, "Section/Name", is to be followed by is not known beforehand.
    /// Their default is nothing.
    void
    declare_family(const std::string &path,
                   const Pattern     &pattern,
                   const std::string &documentation,
                   const std::string &units);

    /// The WORDS of the entries of a family, declared and set ones.
    std::vector<std::string>
    family(const std::string &path) const;

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

    std::string
    get(const std::string &path) const;

    double
    get_double(const std::string &path) const;

    unsigned int
    get_unsigned(const std::string &path) const;

    bool
    get_bool(const std::string &path) const;

    /// Comma-separated values, without blanks around them.
    std::vector<std::string>
    get_list(const std::string &path) const;

    /// All values by path, as they were written.
    std::map<std::string, std::string>
    values() const;

    /// Where the entry was set, "FILE:LINE"; the file if it was not.
    std::string
    location(const std::string &path) const;

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

    /// One line each, in the order of their detection.
    const std::vector<std::string> &
    errors() const;

    /// Whether a file had this section, which is not declared.
    bool
    has_unknown_section(const std::string &path) const;

    /// Prints all entries in the order of their declaration as a scene that
    /// read() accepts.
    void
    print(std::ostream &out, const bool documentation) const;

  private:
    struct Family
    {
      Pattern     pattern;
      std::string documentation;
      std::string units;
    };

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
    std::map<std::string, std::string> expected;  ///< by path, in words
    std::map<std::string, Family>      families;  ///< by path
    std::map<std::string, std::string> locations; ///< by path, where set
    std::set<std::string>              rejected;
    std::set<std::string>              unknown_sections;
    std::vector<std::string>           lines;
    std::string                        file_name;
    std::vector<std::string>           reading; ///< files that include others
  };
} // namespace Debond

#endif
