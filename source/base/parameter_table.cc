// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/base/nearest_name.h>
#include <debond/base/parameter_table.h>
#include <debond/base/text.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>

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



    /// "; did you mean ...?", or what there is in the same section.
    std::string
    suggestion(const std::string &path, const std::vector<std::string> &known)
    {
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
                          const std::string &units)
  {
    expected[path] = pattern.description();

    const auto [sections, name] = split_path(path);
    for (const std::string &section : sections)
      handler.enter_subsection(section);
    handler.declare_entry(name,
                          default_value,
                          pattern,
                          documentation + ". Allowed: " + expected[path] +
                            ". Units: " + units + ".");
    for (std::size_t i = 0; i < sections.size(); ++i)
      handler.leave_subsection();
  }



  void
  ParameterTable::declare_family(const std::string &path,
                                 const Pattern     &pattern,
                                 const std::string &documentation,
                                 const std::string &units)
  {
    families.emplace(path, Family{pattern, documentation, units});
  }



  bool
  ParameterTable::declare_member(const std::string &path)
  {
    for (const auto &[start, family] : families)
      if (starts_with(path, start + " "))
        {
          declare(path, "", family.pattern, family.documentation, family.units);
          return true;
        }
    return false;
  }



  std::vector<std::string>
  ParameterTable::family(const std::string &path) const
  {
    std::vector<std::string> members;
    for (const auto &[candidate, unused] : expected)
      if (starts_with(candidate, path + " "))
        members.push_back(candidate.substr(path.size() + 1));
    return members;
  }



  void
  ParameterTable::set(const std::string &path,
                      const std::string &value,
                      const std::string &location)
  {
    if (expected.find(path) == expected.end() && !declare_member(path))
      {
        std::vector<std::string> known;
        for (const auto &entry : expected)
          known.push_back(entry.first);
        lines.push_back(location + ": unknown parameter " + path +
                        suggestion(path, known));
        return;
      }
    locations[path] = location;

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
                        ": expected " + expected[path]);
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

    std::vector<std::string> known;
    for (const auto &entry : expected)
      known.push_back(entry.first);
    const std::vector<std::string> known_sections = sections_of(known);

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
                lines.push_back(location + ": unknown subsection " + path +
                                suggestion(path, known_sections));
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

    std::error_code error;
    std::ifstream   input(path);
    if (!std::filesystem::is_regular_file(path, error) || !input)
      lines.push_back(location + ": include " + name +
                      ": there is no such file, or it cannot be read");
    else if (std::any_of(reading.begin(), reading.end(), is_this_file))
      lines.push_back(location + ": include " + name +
                      ": the file includes itself");
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



  std::string
  ParameterTable::get(const std::string &path) const
  {
    const auto [sections, name] = split_path(path);
    return handler.get(sections, name);
  }



  double
  ParameterTable::get_double(const std::string &path) const
  {
    const auto [sections, name] = split_path(path);
    return handler.get_double(sections, name);
  }



  unsigned int
  ParameterTable::get_unsigned(const std::string &path) const
  {
    const auto [sections, name] = split_path(path);
    return static_cast<unsigned int>(handler.get_integer(sections, name));
  }



  bool
  ParameterTable::get_bool(const std::string &path) const
  {
    const auto [sections, name] = split_path(path);
    return handler.get_bool(sections, name);
  }



  std::vector<std::string>
  ParameterTable::get_list(const std::string &path) const
  {
    return dealii::Utilities::split_string_list(get(path), ',');
  }



  std::string
  ParameterTable::location(const std::string &path) const
  {
    const auto location = locations.find(path);
    return location != locations.end() ? location->second : file_name;
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
    const bool is_default = locations.count(path) == 0;
    add_error(path,
              path + " = " + shortened(get(path)) +
                (is_default ? " (default): " : ": ") + reason,
              others);
  }



  std::map<std::string, std::string>
  ParameterTable::values() const
  {
    std::map<std::string, std::string> result;
    for (const auto &[path, unused] : expected)
      result[path] = get(path);
    return result;
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
  }
} // namespace Debond
