// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/base/atomic_file.h>
#include <debond/base/parameter_table.h>
#include <debond/base/suggestion.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <stdexcept>

namespace Debond
{
  using boost::starts_with;
  using dealii::Utilities::split_string_list;
  using dealii::Utilities::trim;

  Pattern
  number(const std::string &range, bool (*const property)(double))
  {
    return Pattern("a number" + (range.empty() ? "" : " " + range),
                   [property](const std::string &value) {
                     double result;
                     return read_number(value, result) && property(result);
                   });
  }



  Pattern
  quantity(const bool may_be_zero)
  {
    // Products of up to three quantities, such as a stiffness and a threshold
    // squared, have to stay within the range of doubles, from 2e-308 to 1e308.
    return may_be_zero ? number("from 1e-100 to 1e100, or 0",
                                [](double x) {
                                  return x == 0. || (x >= 1e-100 && x <= 1e100);
                                }) :
                         number("from 1e-100 to 1e100", [](double x) {
                           return x >= 1e-100 && x <= 1e100;
                         });
  }



  Pattern
  whole_number(const int smallest, const int largest)
  {
    // deal.II's patterns decide what matches, but describe themselves in a
    // notation for programs. The words here are for messages.
    const dealii::Patterns::Integer whole(smallest, largest);
    return Pattern(words("a whole number from ", smallest, " to ", largest),
                   [whole](const std::string &value) {
                     return whole.match(value);
                   });
  }



  Pattern
  one_of(const std::vector<std::string> &names)
  {
    const dealii::Patterns::Selection selection(join(names, "|"));
    return Pattern((names.size() == 1 ? "" : "one of ") + join(names, ", "),
                   [selection](const std::string &value) {
                     return selection.match(value);
                   });
  }



  namespace
  {
    /// A text for a message.
    std::string
    shortened(const std::string &text)
    {
      constexpr std::size_t longest = 100;
      return text.size() <= longest ? text : text.substr(0, longest) + "...";
    }



    /// They look like blanks, and come with texts from word processors.
    const std::string spaces_of_unicode =
      "\xc2\xa0|\xe2\x80\xaf|\xe2\x80\x89|\xe2\x80\x8b";

    /// A file with more lines that cannot be read is something else.
    constexpr unsigned int most_unread = 5;

    /// Returns the beginning of the paths of the members of a family.
    std::string
    prefix_of(const std::string &family)
    {
      return family.back() == '/' ? family : family + ' ';
    }
  } // namespace



  /// Has @p action done in the entry's section, with the entry's name.
  void
  ParameterTable::in_section(
    const std::string                              &path,
    const std::function<void(const std::string &)> &action)
  {
    // deal.II's handler has a current section in place of paths. It is the root
    // again afterwards only if the action does not throw.
    std::vector<std::string> sections = split_string_list(path, '/');
    const std::string        name     = sections.back();
    sections.pop_back();
    for (const std::string &section : sections)
      handler.enter_subsection(section);
    action(name);
    for (std::size_t i = 0; i < sections.size(); ++i)
      handler.leave_subsection();
  }



  void
  ParameterTable::declare(const std::string &path,
                          const std::string &default_value,
                          const Pattern     &pattern,
                          const std::string &documentation,
                          const std::string &units,
                          const Reader      &reader)
  {
    // add_action() calls the reader with the default at once, so that the
    // variable and the table agree from the beginning. The handler keeps what
    // is printed, and `entries` what it does not know: where a value was set
    // and whether it was rejected.
    in_section(path, [&](const std::string &name) {
      handler.declare_entry(name,
                            default_value,
                            pattern,
                            text(documentation, pattern, units));
      handler.add_action(name, reader);
    });
    entries.emplace(path, Entry{default_value, default_value, pattern});
  }



  void
  ParameterTable::bind_family(const std::string                  &path,
                              std::map<std::string, std::string> &variable,
                              const Pattern                      &pattern,
                              const std::string                  &documentation,
                              const std::string                  &units)
  {
    // A member that is not set has the default of nothing.
    const Pattern or_nothing =
      pattern.allows_any_text() ?
        pattern :
        Pattern(pattern.description(), [pattern](const std::string &value) {
          return value.empty() || pattern.match(value);
        });
    families.emplace(path, Family{&variable, or_nothing, documentation, units});
  }



  bool
  ParameterTable::declare_member(const std::string &path,
                                 const std::string &documentation)
  {
    // The members of a family become entries when the scene names them. Their
    // default is empty, at which the reader removes the member from the map:
    // the map has the members with a value and no others. A path with control
    // characters is declared for no family, since it would be printed later.
    for (const auto &[start, family] : families)
      if (starts_with(path, prefix_of(start)) && printable(path) == path)
        {
          declare(path,
                  "",
                  family.pattern,
                  documentation.empty() ? family.documentation : documentation,
                  family.units,
                  [name = path.substr(prefix_of(start).size()),
                   map  = family.variable](const std::string &value) {
                    if (value.empty())
                      map->erase(name);
                    else
                      (*map)[name] = value;
                  });
          return true;
        }
    return false;
  }



  void
  ParameterTable::set(const std::string &path,
                      const std::string &value,
                      const std::string &location)
  {
    // Values are only noted here and taken after everything has been read:
    // expressions may need constants that are set further down, and a later
    // value replaces an earlier one without its errors.
    if (entries.count(path) == 0 && !declare_member(path))
      {
        std::vector<std::string> known;
        for (const auto &[other, unused] : entries)
          known.push_back(other);
        for (const auto &[other, unused] : families)
          if (other.back() != '/')
            known.push_back(other + " NAME");
        errors.push_back(location + ": unknown parameter " + shortened(path) +
                         suggestion(shortened(path), known));
        return;
      }
    Entry &entry = entries.at(path);
    entry.value  = value;
    entry.set_at = location;
    set_paths.push_back(path);
    // Files that are being read at this moment include each other one within
    // the other. Each of them has set this value, directly or by what it
    // includes, and has to set it again if it is included another time.
    for (auto &[unused, file] : read_files)
      if (file.is_open)
        file.values[path] = {{value, location}};
  }



  void
  ParameterTable::take_values(
    const std::function<std::string(const std::string &)> &evaluate)
  {
    // An entry that has been set several times is taken once, with its last
    // value. If the pattern asks for more than any text, the evaluated
    // expression is tried first; a free text, such as a function of x, stays as
    // it was written. If that is not allowed the other form is tried, so that
    // an entry for numbers or words accepts both. Errors are of what was
    // written.
    std::set<std::string> taken;
    for (const std::string &path : set_paths)
      if (taken.insert(path).second)
        {
          Entry            &entry      = entries.at(path);
          const std::string written    = entry.value;
          const std::string evaluated  = evaluate(written);
          const bool        is_checked = !entry.pattern.allows_any_text();
          std::string reason = take(path, is_checked ? evaluated : written);
          if (!reason.empty() && evaluated != written)
            reason = take(path, is_checked ? written : evaluated);
          entry.is_rejected = !reason.empty();
          if (!entry.is_rejected)
            continue;
          // An operator in a text that could not be evaluated shows that an
          // expression was meant.
          if (evaluated == written && is_checked &&
              written.find_first_of("*/^(") != std::string::npos)
            reason += "; an expression here has numbers and Constants only";
          errors.push_back(entry.set_at + ": " + path + " = " +
                           shortened(written) + ": " + reason);
          // The default stands in for the rejected value, so that later checks
          // look at something valid and find errors of their own.
          entry.value = entry.default_value;
        }
    set_paths.clear();
  }



  std::string
  ParameterTable::take(const std::string &path, const std::string &value)
  {
    Entry      &entry = entries.at(path);
    std::string reason;
    // The exceptions are caught within the section: in_section() would
    // otherwise not leave it. They are of two kinds, a value that the pattern
    // does not allow and one that the reader refuses with its own reason.
    in_section(path, [&](const std::string &name) {
      try
        {
          handler.set(name, value);
          entry.value = value;
        }
      catch (const dealii::ParameterHandler::ExcValueDoesNotMatchPattern &)
        {
          reason =
            "expected " + entry.pattern.description() + number_hint(value);
        }
      catch (const std::invalid_argument &error)
        {
          reason = error.what();
        }
    });
    return reason;
  }



  namespace
  {
    /// The lines of a scene as they are meant: without comments, and joined if
    /// a backslash continues them.
    class SceneLines
    {
    public:
      explicit SceneLines(std::istream &input)
        : input(input)
      {}

      /// Returns false at the end of the file.
      bool
      next()
      {
        text.clear();
        first         = n_lines + 1;
        is_unfinished = false;
        std::string line;
        while (std::getline(input, line))
          {
            // Some editors begin a file with the byte order mark of UTF-8,
            // which would be a part of the first keyword.
            if (n_lines++ == 0 && starts_with(line, "\xef\xbb\xbf"))
              line.erase(0, 3);
            line = trim(line);
            if (starts_with(line, "#include "))
              commented_includes.push_back(n_lines);
            // A backslash at the end continues a line unless there is a comment
            // on it.
            is_unfinished = boost::ends_with(line, "\\") &&
                            line.find('#') == std::string::npos;
            text += line.substr(0, line.size() - (is_unfinished ? 1 : 0));
            if (is_unfinished)
              continue;
            text = trim(text.substr(0, text.find('#')));
            std::replace(text.begin(), text.end(), '\t', ' ');
            return true;
          }
        return false;
      }

      std::string               text;
      unsigned int              first         = 1; ///< number of its first line
      bool                      is_unfinished = false;
      std::vector<unsigned int> commented_includes; ///< numbers of lines

    private:
      std::istream &input;
      unsigned int  n_lines = 0;
    };
  } // namespace



  void
  ParameterTable::read(std::istream &input, const std::string &file)
  {
    // The file is read line by line, and the handler's own reader is not used,
    // for that throws at the first error. Here each error gets a line of its
    // own with its place, and reading continues, so that the user sees all of
    // them in one run. A stack of open sections replaces the handler's current
    // one.
    file_name = file;
    // The canonical name makes files the same that are included by different
    // paths.
    std::error_code no_file; // There is none behind /dev/stdin.
    ReadFile       &own =
      read_files[std::filesystem::weakly_canonical(file, no_file)];
    own.is_open                             = true;
    const std::vector<std::string> sections = known_sections();
    const auto                     is_known = [&](const std::string &section) {
      return section.empty() ||
             std::binary_search(sections.begin(), sections.end(), section);
    };

    // Paths of sections that are open, and where they were opened.
    std::vector<std::pair<std::string, std::string>> open = {{"", ""}};
    std::map<std::string, std::string>               set_here;

    // Errors refer to the first of lines that are joined. A keyword ends at the
    // first blank. Keywords are compared without regard to case, names are not.
    SceneLines   lines(input);
    unsigned int n_unread = 0;
    while (n_unread <= most_unread && lines.next())
      {
        const std::string &text    = lines.text;
        const std::string  at      = words(file, ':', lines.first);
        const std::string  section = open.back().first;
        const std::string  prefix  = section.empty() ? "" : section + '/';
        const std::string  keyword =
          boost::to_lower_copy(text.substr(0, text.find(' ')));
        const std::string rest   = trim(text.substr(keyword.size()));
        const std::size_t equals = rest.find('=');
        // A blank of Unicode looks like any other in an editor, but is a part
        // of a name here. No later message would make the user look for it.
        if (std::smatch match;
            std::regex_search(text, match, std::regex(spaces_of_unicode)))
          errors.push_back(
            at + ": the space behind '" + match.prefix().str() +
            "' is a no-break space of Unicode; put a blank there");
        else if (keyword == "subsection" && !rest.empty())
          {
            const std::string path = prefix + rest;
            // An unknown subsection is opened all the same, so that the "end"
            // that belongs to it closes it. It is an error once: neither the
            // subsections in it nor its entries are errors again.
            open.emplace_back(path, at);
            if (is_known(section) && !is_known(path))
              errors.push_back(at + ": unknown subsection " + shortened(path) +
                               suggestion(shortened(path), sections));
          }
        else if (keyword == "end" && rest.empty() && open.size() > 1)
          open.pop_back();
        else if (keyword == "end" && rest.empty())
          errors.push_back(at + ": 'end' without an open subsection");
        else if (keyword == "set" && equals != std::string::npos)
          {
            // What an unknown section contains is not reported again. A second
            // value for an entry in the same file is an error, since one of
            // both is a mistake; that an included file is overruled is the
            // purpose of including it.
            const std::string path = prefix + trim(rest.substr(0, equals));
            const auto [earlier, is_first] = set_here.emplace(path, at);
            if (!is_first)
              errors.push_back(at + ": " + path + " is set already, at " +
                               earlier->second);
            else if (is_known(section))
              set(path, trim(rest.substr(equals + 1)), at);
          }
        else if (keyword == "include" && !rest.empty() && section.empty())
          {
            // An included file would silently replace what has been set above
            // it, so that it has to come first if both set the same entry.
            const auto &included = read_included(rest, file, at);
            for (const auto &[path, earlier] : set_here)
              if (included.count(path) > 0)
                errors.push_back(at + ": include " + rest + " sets " + path +
                                 " again, after " + earlier +
                                 ": put include first");
          }
        // A file of another kind, such as a mesh, would give an error for each
        // of its lines.
        else if (!text.empty() && ++n_unread > most_unread)
          errors.push_back(
            at + ": nor can this and what follows be read; is it a scene?");
        else if (!text.empty())
          errors.push_back(at + ": cannot read '" + shortened(text) +
                           "': expected 'subsection NAME', 'set NAME = "
                           "VALUE', 'end' or, outside of subsections, "
                           "'include FILE'");
      }
    for (const unsigned int line : lines.commented_includes)
      notes.push_back(
        words(file, ':', line, ": this is a comment; include FILE has no #"));
    own.is_open = false;
    if (n_unread > most_unread)
      return;
    if (lines.is_unfinished)
      errors.push_back(
        words(file, ':', lines.first, ": the file ends in a continued line"));
    for (std::size_t i = 1; i < open.size(); ++i)
      errors.push_back(open[i].second + ": subsection " + open[i].first +
                       " is not closed by 'end'");
  }



  const ParameterTable::FileValues &
  ParameterTable::read_included(const std::string &name,
                                const std::string &file,
                                const std::string &location)
  {
    // The path is relative to the folder of the file that includes it, wherever
    // the program was started.
    const std::filesystem::path path =
      std::filesystem::path(file).parent_path() / name;
    std::ifstream     input = open_plain_file(path);
    const std::string error = location + ": include " + name + ": ";
    const auto        key   = std::filesystem::weakly_canonical(path);
    if (!input)
      errors.push_back(error + "there is no such file, or it cannot be read");
    else if (const auto known = read_files.find(key); known == read_files.end())
      read(input, path.string());
    else if (known->second.is_open)
      errors.push_back(error + "the file includes itself");
    else
      {
        // A file that has been read before is not read again, since files that
        // include others twice each would be read 2^n times. Its values are set
        // once more, as reading would do, without repeating its errors.
        const std::size_t n_errors = errors.size();
        for (const auto &[entry, value] : known->second.values)
          set(entry, value[0], value[1]);
        errors.resize(n_errors);
      }
    // read() has set the name to that of the included file.
    file_name = file;
    static const FileValues nothing;
    const auto              found = read_files.find(key);
    return found == read_files.end() ? nothing : found->second.values;
  }



  void
  ParameterTable::assign(const std::string &assignment)
  {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos)
      errors.push_back("--set: cannot read '" + assignment +
                       "': expected Section/Parameter=value");
    else
      set(trim(assignment.substr(0, equals)),
          trim(assignment.substr(equals + 1)),
          "--set");
  }



  std::map<std::string, std::string>
  ParameterTable::locations() const
  {
    // An entry that has kept its default has no line of its own; messages on it
    // name the scene.
    std::map<std::string, std::string> result;
    for (const auto &[path, entry] : entries)
      result[path] = entry.set_at.empty() ? file_name : entry.set_at;
    return result;
  }



  /// The sections are in alphabetical order.
  std::vector<std::string>
  ParameterTable::known_sections() const
  {
    std::set<std::string> sections;
    const auto            add = [&sections](const std::string &path) {
      for (std::size_t slash = path.find('/'); slash != std::string::npos;
           slash             = path.find('/', slash + 1))
        sections.insert(path.substr(0, slash));
    };
    for (const auto &[path, unused] : entries)
      add(path);
    for (const auto &[path, unused] : families)
      add(path);
    return {sections.begin(), sections.end()};
  }



  void
  ParameterTable::reject(const std::string              &path,
                         const std::string              &reason,
                         const std::vector<std::string> &others)
  {
    // An entry that was rejected has its default now. What that default
    // contradicts is no mistake of the user, who has got a message on the entry
    // already.
    bool is_known = entries.at(path).is_rejected;
    for (const std::string &other : others)
      is_known |= entries.count(other) > 0 && entries.at(other).is_rejected;
    if (!is_known)
      errors.push_back(locations().at(path) + ": " + path + " = " +
                       shortened(get(path)) +
                       (is_set(path) ? ": " : " (default): ") + reason);
  }



  void
  ParameterTable::without_effect(const std::string &entries,
                                 const std::string &reason,
                                 const std::string &rejected_for)
  {
    // A value equals its default as a number too: "1.0" in place of "1" is no
    // decision that a note should mention.
    const auto is_default = [](const Entry &entry) {
      double a, b;
      return entry.value.empty() || entry.value == entry.default_value ||
             (read_number(entry.value, a) &&
              read_number(entry.default_value, b) && a == b);
    };
    std::set<std::string> names;
    for (const std::string &start : split_string_list(entries, ','))
      for (const auto &[path, entry] : this->entries)
        if ((path == start || starts_with(path, prefix_of(start))) &&
            !is_default(entry))
          names.insert(path);
    if (!rejected_for.empty())
      for (const std::string &path : names)
        reject(path, reason, {rejected_for});
    else if (!names.empty())
      notes.push_back("no effect of " +
                      join({names.begin(), names.end()}, ", ") + ": " + reason);
  }



  void
  ParameterTable::print_json(std::ostream &out)
  {
    // JSON has no place for families, so that a member with the name NAME
    // stands for each of them.
    for (const auto &[path, unused] : families)
      declare_member(prefix_of(path) + "NAME");
    handler.print_parameters(out, dealii::ParameterHandler::JSON);
  }



  void
  ParameterTable::print(std::ostream &out, const bool documentation) const
  {
    using Handler    = dealii::ParameterHandler;
    const auto style = documentation ? Handler::PRM : Handler::ShortPRM;
    handler.print_parameters(out, style | Handler::KeepDeclarationOrder);
    if (!documentation || families.empty())
      return;
    out << "\n# Entries with a name in place of NAME, as many as one needs\n"
        << "# ---------------------\n";
    for (const auto &[path, family] : families)
      {
        out << "# " << prefix_of(path) << "NAME\n";
        for (const std::string &line : dealii::Utilities::break_text_into_lines(
               text(family.documentation, family.pattern, family.units), 76))
          out << "# " << line << '\n';
        out << '\n';
      }
  }
} // namespace Debond
