// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/base/atomic_file.h>
#include <debond/base/nearest_name.h>
#include <debond/base/number_text.h>
#include <debond/base/parameter_table.h>
#include <debond/base/text.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <regex>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    using dealii::Utilities::trim;

    /// "A/B/C" as {"A", "B"} and "C".
    std::pair<std::vector<std::string>, std::string>
    split_path(const std::string &path)
    {
      std::vector<std::string> parts =
        dealii::Utilities::split_string_list(path, '/');
      const std::string name = parts.back();
      parts.pop_back();
      return {parts, name};
    }



    bool
    starts_with(const std::string &text, const std::string &start)
    {
      return text.compare(0, start.size(), start) == 0;
    }



    /// "; did you mean ...?", or what there is in the same section, or that
    /// there is no such thing.
    std::string
    suggestion(const std::string &path, const std::vector<std::string> &known)
    {
      static const std::map<std::string, std::string> absent = {
        {"friction|coulomb", "friction"},
        {"plastic|yield|hardening", "plasticity"},
        {"visc|creep|damping", "viscosity"},
        {"density|\\bmass|veloc|accelerat|time step", "inertia"},
        {"(large|finite) (displ|strain|rot|def)", "large displacements"},
        {"orthotrop|anisotrop", "directions of the material"},
        {"soften|damage|fatigue", "damage"}};
      for (const auto &[words, what] : absent)
        if (std::regex_search(path, std::regex(words, std::regex::icase)))
          return "; Debond has no " + what +
                 ", see 'What the model does not contain' in "
                 "doc/guide/manual.md";
      const std::vector<std::string> near = nearest_names(path, known);
      if (!near.empty())
        return "; did you mean " + join(near, " or ") + "?";

      const std::string        section = path.substr(0, path.rfind('/') + 1);
      std::vector<std::string> siblings;
      for (const std::string &candidate : known)
        if (starts_with(candidate, section) &&
            candidate.find('/', section.size()) == std::string::npos)
          siblings.push_back(candidate);
      return siblings.empty() ? "" : "; known are " + join(siblings, ", ");
    }



    /// A value for a message.
    std::string
    shortened(const std::string &value)
    {
      constexpr std::size_t longest = 100;
      return value.size() <= longest ? value : value.substr(0, longest) + "...";
    }



    /// What the paths of the members of a family begin with.
    std::string
    prefix_of(const std::string &family)
    {
      return family.back() == '/' ? family : family + ' ';
    }



    std::vector<std::string>
    sections_of(const std::vector<std::string> &paths)
    {
      std::set<std::string> sections;
      for (const std::string &path : paths)
        for (std::size_t slash = path.find('/'); slash != std::string::npos;
             slash             = path.find('/', slash + 1))
          sections.insert(path.substr(0, slash));
      return {sections.begin(), sections.end()};
    }
  } // namespace



  void
  ParameterTable::declare(const std::string &path,
                          const std::string &default_value,
                          const Pattern     &pattern,
                          const std::string &documentation,
                          const std::string &units,
                          const Reader      &reader,
                          const AtRestart    restart)
  {
    const std::string expected = pattern.description();
    entries[path]              = {expected, default_value, restart};
    if (reader)
      readers.emplace_back(path, reader);

    const auto [sections, name] = split_path(path);
    for (const std::string &section : sections)
      handler.enter_subsection(section);
    handler.declare_entry(name,
                          default_value,
                          pattern,
                          documentation + ". Allowed: " + expected +
                            ". Units: " + units + ".");
    for (std::size_t i = 0; i < sections.size(); ++i)
      handler.leave_subsection();
  }



  void
  ParameterTable::bind(const std::string &path,
                       double            &variable,
                       const Pattern     &pattern,
                       const std::string &documentation,
                       const std::string &units,
                       const AtRestart    restart)
  {
    declare(
      path,
      shortest_text(variable),
      pattern,
      documentation,
      units,
      [&variable](const std::string &text) { read_number(text, variable); },
      restart);
  }



  void
  ParameterTable::bind(const std::string &path,
                       unsigned int      &variable,
                       const Pattern     &pattern,
                       const std::string &documentation,
                       const std::string &units,
                       const AtRestart    restart)
  {
    declare(
      path,
      std::to_string(variable),
      pattern,
      documentation,
      units,
      [&variable](const std::string &text) {
        variable = static_cast<unsigned int>(std::stoul(text));
      },
      restart);
  }



  void
  ParameterTable::bind(const std::string &path,
                       std::string       &variable,
                       const Pattern     &pattern,
                       const std::string &documentation,
                       const std::string &units,
                       const AtRestart    restart)
  {
    declare(
      path,
      variable,
      pattern,
      documentation,
      units,
      [&variable](const std::string &text) { variable = text; },
      restart);
  }



  void
  ParameterTable::bind(const std::string   &path,
                       std::vector<double> &variable,
                       const Pattern       &pattern,
                       const std::string   &documentation,
                       const std::string   &units,
                       const AtRestart      restart)
  {
    std::vector<std::string> words;
    for (const double number : variable)
      words.push_back(shortest_text(number));
    declare(
      path,
      join(words, ", "),
      pattern,
      documentation,
      units,
      [&variable](const std::string &text) {
        variable.clear();
        for (const std::string &word :
             dealii::Utilities::split_string_list(text, ','))
          read_number(word, variable.emplace_back());
      },
      restart);
  }



  void
  ParameterTable::bind(const std::string     &path,
                       std::set<std::string> &variable,
                       const std::string     &documentation,
                       const AtRestart        restart)
  {
    declare(
      path,
      join({variable.begin(), variable.end()}, ", "),
      list_of_names(),
      documentation,
      "none",
      [&variable](const std::string &text) {
        const std::vector<std::string> names =
          dealii::Utilities::split_string_list(text, ',');
        variable = {names.begin(), names.end()};
      },
      restart);
  }



  void
  ParameterTable::bind(const std::string &path,
                       bool              &variable,
                       const std::string &documentation,
                       const AtRestart    restart)
  {
    bind_choice(path,
                variable,
                {{"true", true}, {"false", false}},
                documentation,
                restart);
  }



  void
  ParameterTable::bind_family(const std::string                  &path,
                              std::map<std::string, std::string> &variable,
                              const Pattern                      &pattern,
                              const std::string                  &documentation,
                              const std::string                  &units)
  {
    // A member that is not set has the default of nothing.
    const Pattern or_nothing(pattern.description(),
                             [pattern](const std::string &value) {
                               return value.empty() || pattern.match(value);
                             });
    families.emplace(path, Family{or_nothing, documentation, units, &variable});
  }



  bool
  ParameterTable::declare_member(const std::string &path)
  {
    for (const auto &[start, family] : families)
      if (starts_with(path, prefix_of(start)) && printable(path) == path)
        {
          declare(path, "", family.pattern, family.documentation, family.units);
          return true;
        }
    return false;
  }



  void
  ParameterTable::set(const std::string &path,
                      const std::string &value,
                      const std::string &location)
  {
    if (entries.count(path) == 0 && !declare_member(path))
      {
        lines.push_back(location + ": unknown parameter " + shortened(path) +
                        suggestion(shortened(path), known_entries()));
        return;
      }
    set_at[path] = location;

    const auto [sections, name] = split_path(path);
    for (const std::string &section : sections)
      handler.enter_subsection(section);
    try
      {
        handler.set(name, value);
        rejected.erase(path);
      }
    catch (const dealii::ParameterHandler::ExcValueDoesNotMatchPattern &)
      {
        lines.push_back(location + ": " + path + " = " + shortened(value) +
                        ": expected " + entries[path].expected +
                        comma_hint(value));
        rejected.insert(path);
      }
    for (std::size_t i = 0; i < sections.size(); ++i)
      handler.leave_subsection();
  }



  void
  ParameterTable::read(std::istream &input, const std::string &file)
  {
    file_name = file;
    reading.push_back(file);

    std::vector<std::string> known_paths = known_entries();
    for (const auto &[path, unused] : families)
      known_paths.push_back(path);
    const std::vector<std::string> known_sections = sections_of(known_paths);

    // The sections that are open, and where they were opened. What is in an
    // unknown section is skipped, since the section is reported already.
    std::vector<std::string> open;
    std::vector<std::string> opened_at;
    std::size_t              known_depth = 0;

    std::map<std::string, std::string> set_here;

    std::string  logical_line;
    unsigned int line_number       = 0;
    unsigned int first_line_number = 1;
    for (std::string line; std::getline(input, line);)
      {
        // Some editors begin a file with the mark of UTF-8.
        if (line_number == 0 && starts_with(line, "\xef\xbb\xbf"))
          line.erase(0, 3);
        ++line_number;
        line                 = trim(line);
        const bool continued = !line.empty() && line.back() == '\\';
        if (continued)
          line.pop_back();
        logical_line += line;
        if (continued)
          continue;

        std::string text = trim(logical_line.substr(0, logical_line.find('#')));
        const std::string location =
          file + ":" + std::to_string(first_line_number);
        logical_line.clear();
        first_line_number = line_number + 1;
        std::replace(text.begin(), text.end(), '\t', ' ');
        if (text.empty())
          continue;

        std::string keyword = text.substr(0, text.find(' '));
        for (char &letter : keyword)
          letter =
            static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
        const std::string rest = trim(text.substr(keyword.size()));

        if (keyword == "subsection" && !rest.empty())
          {
            const bool inside_known = known_depth == open.size();
            open.push_back(rest);
            opened_at.push_back(location);
            if (!inside_known)
              continue;
            const std::string path = join(open, "/");
            if (std::find(known_sections.begin(), known_sections.end(), path) !=
                known_sections.end())
              ++known_depth;
            else
              {
                unknown_sections.insert(path);
                lines.push_back(location + ": unknown subsection " +
                                shortened(path) +
                                suggestion(shortened(path), known_sections));
              }
          }
        else if (keyword == "end" && rest.empty())
          {
            if (open.empty())
              {
                lines.push_back(location +
                                ": 'end' without an open subsection");
                continue;
              }
            open.pop_back();
            opened_at.pop_back();
            known_depth = std::min(known_depth, open.size());
          }
        else if (keyword == "set" && rest.find('=') != std::string::npos)
          {
            if (known_depth != open.size())
              continue;
            const std::size_t equals = rest.find('=');
            const std::string name   = trim(rest.substr(0, equals));
            const std::string path =
              (open.empty() ? "" : join(open, "/") + "/") + name;
            const auto [earlier, is_first] = set_here.emplace(path, location);
            if (is_first)
              set(path, trim(rest.substr(equals + 1)), location);
            else
              lines.push_back(location + ": " + path + " is set already, at " +
                              earlier->second);
          }
        else if (keyword == "include" && !rest.empty() && open.empty())
          read_included(rest, file, location);
        else
          lines.push_back(
            location + ": cannot read '" + text +
            "': expected 'subsection NAME', "
            "'set NAME = VALUE', 'end' or, outside of subsections, "
            "'include FILE'");
      }

    if (!logical_line.empty())
      lines.push_back(file + ":" + std::to_string(first_line_number) +
                      ": the file ends in a continued line");
    for (std::size_t i = 0; i < open.size(); ++i)
      lines.push_back(opened_at[i] + ": subsection " + open[i] +
                      " is not closed by 'end'");
    reading.pop_back();
  }



  void
  ParameterTable::read_included(const std::string &name,
                                const std::string &file,
                                const std::string &location)
  {
    const std::filesystem::path path =
      std::filesystem::path(file).parent_path() / name;
    const auto is_this_file = [&path](const std::string &other) {
      std::error_code unreadable;
      return std::filesystem::equivalent(path, other, unreadable);
    };

    // Files that each include others twice have no end.
    constexpr unsigned int most_included = 100;
    std::ifstream          input         = open_plain_file(path);
    if (n_included == most_included)
      return;
    if (!input)
      lines.push_back(location + ": include " + name +
                      ": there is no such file, or it cannot be read");
    else if (std::any_of(reading.begin(), reading.end(), is_this_file))
      lines.push_back(location + ": include " + name +
                      ": the file includes itself");
    else if (++n_included == most_included)
      lines.push_back(location + ": include " + name +
                      ": it is one of more than 100 files");
    else
      read(input, path.string());
    file_name = file;
  }



  void
  ParameterTable::assign(const std::string &assignment)
  {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos)
      {
        lines.push_back("--set: cannot read '" + assignment +
                        "': expected Section/Parameter=value");
        return;
      }
    set(trim(assignment.substr(0, equals)),
        trim(assignment.substr(equals + 1)),
        "--set");
  }



  void
  ParameterTable::derive(const std::string &path,
                         const std::string &value,
                         const std::string &source)
  {
    set(path, value, location(source));
  }



  void
  ParameterTable::parse()
  {
    for (const auto &[path, reader] : readers)
      try
        {
          reader(get(path));
        }
      catch (const std::invalid_argument &error)
        {
          reject(path, error.what());
        }

    for (const auto &[path, family] : families)
      {
        family.variable->clear();
        for (const std::string &member : known_entries())
          if (const std::string prefix = prefix_of(path);
              starts_with(member, prefix))
            if (const std::string value = get(member); !value.empty())
              (*family.variable)[member.substr(prefix.size())] = value;
      }
  }



  bool
  ParameterTable::is_set(const std::string &path) const
  {
    return set_at.count(path) > 0;
  }



  std::string
  ParameterTable::get(const std::string &path) const
  {
    const auto [sections, name] = split_path(path);
    return handler.get(sections, name);
  }



  std::string
  ParameterTable::location(const std::string &path) const
  {
    const auto location = set_at.find(path);
    return location != set_at.end() ? location->second : file_name;
  }



  std::map<std::string, std::string>
  ParameterTable::locations() const
  {
    std::map<std::string, std::string> result;
    for (const std::string &path : known_entries())
      result[path] = location(path);
    return result;
  }



  std::vector<std::string>
  ParameterTable::known_entries() const
  {
    std::vector<std::string> paths;
    for (const auto &[path, unused] : entries)
      paths.push_back(path);
    return paths;
  }



  void
  ParameterTable::add_error(const std::string              &path,
                            const std::string              &message,
                            const std::vector<std::string> &others)
  {
    const auto is_rejected = [&](const std::string &entry) {
      return rejected.count(entry) > 0;
    };
    if (is_rejected(path) ||
        std::any_of(others.begin(), others.end(), is_rejected))
      return;

    lines.push_back(location(path) + ": " + message);
  }



  void
  ParameterTable::reject(const std::string              &path,
                         const std::string              &reason,
                         const std::vector<std::string> &others)
  {
    const bool is_default = set_at.count(path) == 0;
    add_error(path,
              path + " = " + shortened(get(path)) +
                (is_default ? " (default): " : ": ") + reason,
              others);
  }



  void
  ParameterTable::without_effect(const std::string &entries,
                                 const std::string &reason,
                                 const std::string &rejected_for)
  {
    const auto is_default = [this](const std::string &path) {
      const std::string &value = this->entries.at(path).default_value;
      double             a, b;
      return get(path) == value ||
             (read_number(get(path), a) && read_number(value, b) && a == b);
    };
    std::set<std::string> names;
    for (const std::string &start :
         dealii::Utilities::split_string_list(entries, ','))
      for (const auto &[path, unused] : set_at)
        if ((path == start || starts_with(path, prefix_of(start))) &&
            !is_default(path))
          {
            names.insert(path);
            if (!rejected_for.empty())
              reject(path, reason, {rejected_for});
          }
    if (!names.empty() && rejected_for.empty())
      note_lines.push_back("no effect of " +
                           join({names.begin(), names.end()}, ", ") + ": " +
                           reason);
  }



  const std::vector<std::string> &
  ParameterTable::notes() const
  {
    return note_lines;
  }



  const std::vector<std::string> &
  ParameterTable::errors() const
  {
    return lines;
  }



  bool
  ParameterTable::has_unknown_section(const std::string &path) const
  {
    return unknown_sections.count(path) > 0;
  }



  void
  ParameterTable::print(std::ostream &out, const bool documentation) const
  {
    using Handler = dealii::ParameterHandler;
    handler.print_parameters(out,
                             (documentation ? Handler::PRM :
                                              Handler::ShortPRM) |
                               Handler::KeepDeclarationOrder);
    if (!documentation || families.empty())
      return;
    out << "\n# Entries with a name in place of NAME, as many as one needs\n"
        << "# ---------------------\n";
    for (const auto &[path, family] : families)
      {
        const std::string text = family.documentation +
                                 ". Allowed: " + family.pattern.description() +
                                 ". Units: " + family.units + ".";
        out << "# " << prefix_of(path) << "NAME\n";
        for (const std::string &line :
             dealii::Utilities::break_text_into_lines(text, 76))
          out << "# " << line << '\n';
        out << '\n';
      }
  }
} // namespace Debond
