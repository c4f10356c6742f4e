// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/base/text.h>
#include <debond/input/parameters.h>
#include <debond/study/columns.h>
#include <debond/study/plots.h>
#include <debond/study/study_parameters.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

namespace Debond
{
  namespace
  {
    using dealii::Utilities::trim;

    const std::vector<std::string> sweep_sections = {"Sweep 1", "Sweep 2"};

    const std::string method_parameter = "Solver/Method";



    Pattern
    any_text(const std::string &what)
    {
      return Pattern(what, [](const std::string & /*value*/) { return true; });
    }



    /// The items of "a | b | c". A separator counts only with blanks around it,
    /// since expressions may contain "||" and "&&".
    std::vector<std::string>
    split_at(const std::string &separator, const std::string &text)
    {
      std::vector<std::string> items;
      std::istringstream       words(text);
      std::string              item;
      for (std::string word; words >> word;)
        if (word == separator)
          {
            items.push_back(item);
            item.clear();
          }
        else
          item += (item.empty() ? "" : " ") + word;
      if (!item.empty() || !items.empty())
        items.push_back(item);
      return items;
    }



    std::vector<std::string>
    split_at_bars(const std::string &text)
    {
      return split_at("|", text);
    }



    std::vector<std::string>
    geometric_range(const std::string &text)
    {
      constexpr unsigned int largest_count = 1000; // each is a case to run
      std::istringstream     words(text);
      std::string            keyword, first_text, last_text;
      unsigned int           count = 0;
      double                 first = 0., last = 0.;
      words >> keyword >> first_text >> last_text >> count;
      if (!words || !(words >> std::ws).eof() ||
          !read_number(first_text, first) || !read_number(last_text, last) ||
          !(first > 0.) || !(last > 0.) || count < 2 || count > largest_count)
        throw std::invalid_argument(
          "expected 'geometric FIRST LAST COUNT' with numbers > 0 and 2 to " +
          std::to_string(largest_count) + " values");

      std::vector<std::string> values;
      for (unsigned int i = 0; i < count; ++i)
        {
          std::ostringstream value;
          value << first * std::pow(last / first, i / (count - 1.));
          values.push_back(value.str());
        }
      return values;
    }



    /// Reads "a = 1 | b = 2". Returns false if the text is not such a list.
    bool
    read_pairs(const std::string                                &text,
               std::vector<std::pair<std::string, std::string>> &pairs)
    {
      for (const std::string &item : split_at_bars(text))
        {
          const std::size_t equals = item.find('=');
          if (equals == std::string::npos)
            return false;
          pairs.emplace_back(trim(item.substr(0, equals)),
                             trim(item.substr(equals + 1)));
        }
      return true;
    }



    Pattern
    pairs_pattern(const std::string &what)
    {
      return Pattern(what, [](const std::string &value) {
        std::vector<std::pair<std::string, std::string>> pairs;
        return read_pairs(value, pairs);
      });
    }



    /// Reads "1e-3, 1e-8". Returns false if the text is anything else.
    bool
    read_fit_window(const std::string &text, double &from, double &to)
    {
      const std::vector<std::string> window =
        dealii::Utilities::split_string_list(text, ',');
      return window.size() == 2 && read_number(window[0], from) &&
             read_number(window[1], to) && from > to && to > 0.;
    }



    void
    declare_reference(ParameterTable &table)
    {
      table.declare(
        "Reference/File",
        "",
        any_text("nothing, or a path relative to the study file"),
        "A CSV file with printed results, to stand beside those of the study; its first line that is not a comment ('#') has the titles",
        "none");
      table.declare("Reference/Label",
                    "reference",
                    any_text("a text"),
                    "What the columns of the reference are called",
                    "none");
      table.declare("Reference/Rows",
                    "",
                    pairs_pattern("a list COLUMN=TEXT | COLUMN=TEXT | ..."),
                    "Which rows of the file count",
                    "none");
      table.declare(
        "Reference/Key",
        "value",
        any_text("the name of a column"),
        "The column of the file that has the value of the first sweep",
        "none");
      table.declare(
        "Reference/Columns",
        "",
        pairs_pattern("a list COLUMN=COLUMN | COLUMN=COLUMN | ..."),
        "For columns of the study the columns of the file that are shown beside them. If the study's column is an error, the file's is a functional, and its error is shown",
        "none");
      table.declare("Reference/Minimum",
                    "0",
                    any_number(),
                    "The functional to which those of the file are compared",
                    "energy");
    }



    void
    declare_sweep(const std::string &section, ParameterTable &table)
    {
      table.declare(section + "/Parameter",
                    "",
                    any_text("nothing, or Section/Entry as for --set"),
                    "The parameter of the scene that is varied; none if empty",
                    "none");
      table.declare(section + "/Label",
                    "",
                    any_text("a text"),
                    "Its name in tables and plots; Section/Entry if empty",
                    "none");
      table.declare(
        section + "/Values",
        "",
        Pattern("a | b | c (with blanks around the bars), or geometric FIRST "
                "LAST COUNT",
                [](const std::string &value) {
                  try
                    {
                      parse_sweep_values(value);
                      return true;
                    }
                  catch (const std::invalid_argument &)
                    {
                      return false;
                    }
                }),
        "The values it is given: each one as it would stand in the scene, or a geometric range of numbers",
        "those of the parameter");
    }



    /// A path in the study file, which is relative to that file.
    std::string
    beside(const std::string &study_file, const std::string &path)
    {
      return (std::filesystem::path(study_file).parent_path() / path)
        .lexically_normal()
        .string();
    }



    /// Rejects the entry @p path if the scene does not accept the setting.
    void
    check_setting(const std::string &scene,
                  const std::string &setting,
                  const std::string &path,
                  ParameterTable    &table)
    {
      ParameterTable scene_table;
      declare_parameters(scene_table);
      read_scene(scene, scene_table);
      const std::size_t errors_before = scene_table.errors().size();
      scene_table.assign(setting);
      if (scene_table.errors().size() == errors_before)
        return;

      const std::string origin = "--set: ";
      std::string       reason = scene_table.errors().back();
      if (reason.compare(0, origin.size(), origin) == 0)
        reason = reason.substr(origin.size());
      table.add_error(path, path + ": " + reason);
    }



    std::vector<std::string>
    read_settings(const std::string &path,
                  const std::string &scene,
                  ParameterTable    &table)
    {
      const std::vector<std::string> settings = split_at_bars(table.get(path));
      for (const std::string &setting : settings)
        check_setting(scene, setting, path, table);
      return settings;
    }



    void
    read_sweep(const std::string &section,
               StudyParameters   &study,
               ParameterTable    &table)
    {
      Sweep sweep;
      sweep.parameter = table.get(section + "/Parameter");
      sweep.label     = table.get(section + "/Label");
      if (sweep.label.empty())
        sweep.label = sweep.parameter;
      sweep.values = parse_sweep_values(table.get(section + "/Values"));
      if (sweep.parameter.empty())
        {
          if (!sweep.values.empty())
            table.add_error(section + "/Values",
                            section + "/Values: there is no " + section +
                              "/Parameter");
          return;
        }
      if (sweep.values.empty())
        table.add_error(section + "/Parameter",
                        section + "/Parameter: there are no " + section +
                          "/Values",
                        {section + "/Values"});
      for (const std::string &value : sweep.values)
        try
          {
            for (const std::string &setting : sweep.settings(value))
              check_setting(study.scene, setting, section + "/Values", table);
          }
        catch (const std::invalid_argument &error)
          {
            table.reject(section + "/Values", error.what());
          }
      const std::set<std::string> distinct(sweep.values.begin(),
                                           sweep.values.end());
      if (distinct.size() < sweep.values.size())
        table.reject(section + "/Values", "a value is there twice");
      for (const Sweep &other : study.sweeps)
        if (other.parameter == sweep.parameter)
          table.reject(section + "/Parameter", "is varied by another sweep");
      study.sweeps.push_back(sweep);
    }



    void
    read_methods(StudyParameters &study, ParameterTable &table)
    {
      Sweep methods{method_parameter,
                    "method",
                    split_at_bars(table.get("Study/Methods"))};
      for (const std::string &method : methods.values)
        check_setting(study.scene,
                      method_parameter + "=" + method,
                      "Study/Methods",
                      table);
      if (methods.values.size() > 1)
        study.sweeps.push_back(methods);
      else if (methods.values.size() == 1)
        study.settings.push_back(method_parameter + "=" +
                                 methods.values.front());
    }



    void
    read_columns(StudyParameters &study, ParameterTable &table)
    {
      study.columns = split_at_bars(table.get("Study/Columns"));
      for (const std::string &name : study.columns)
        try
          {
            Column::parse(name);
          }
        catch (const std::invalid_argument &error)
          {
            table.add_error("Study/Columns",
                            std::string("Study/Columns: ") + error.what());
          }
    }



    void
    read_reference(StudyParameters &study, ParameterTable &table)
    {
      ReferenceParameters &reference = study.reference;
      if (table.get("Reference/File").empty())
        return;
      reference.file    = beside(study.file, table.get("Reference/File"));
      reference.label   = table.get("Reference/Label");
      reference.key     = table.get("Reference/Key");
      reference.minimum = table.get_double("Reference/Minimum");
      std::vector<std::pair<std::string, std::string>> pairs;
      read_pairs(table.get("Reference/Rows"), pairs);
      reference.rows.insert(pairs.begin(), pairs.end());
      pairs.clear();
      read_pairs(table.get("Reference/Columns"), pairs);
      reference.columns.insert(pairs.begin(), pairs.end());
      for (const auto &column : reference.columns)
        if (std::find(study.columns.begin(),
                      study.columns.end(),
                      column.first) == study.columns.end())
          table.add_error("Reference/Columns",
                          "Reference/Columns: " + column.first +
                            " is not one of Study/Columns");
    }
  } // namespace



  std::vector<std::string>
  Sweep::settings(const std::string &value) const
  {
    const std::vector<std::string> names = split_at("&", parameter);
    const std::vector<std::string> parts = split_at("&", value);
    if (names.size() != parts.size())
      throw std::invalid_argument("'" + value + "' has not as many parts as " +
                                  parameter);
    std::vector<std::string> result;
    for (std::size_t i = 0; i < names.size(); ++i)
      result.push_back(names[i] + "=" + parts[i]);
    return result;
  }



  std::vector<std::string>
  parse_sweep_values(const std::string &text)
  {
    const std::string keyword = "geometric";
    if (text.compare(0, keyword.size(), keyword) == 0)
      return geometric_range(text);
    return split_at_bars(text);
  }



  void
  declare_study_parameters(ParameterTable &table)
  {
    table.declare("Study/Title",
                  "",
                  any_text("a text"),
                  "The head of the index page",
                  "none");
    table.declare("Study/Description",
                  "",
                  any_text("a text"),
                  "A paragraph for the index page",
                  "none");
    table.declare("Study/Scene",
                  "",
                  any_text("a path relative to the study file"),
                  "The scene that all cases begin with",
                  "none");
    table.declare(
      "Study/Settings",
      "",
      pairs_pattern("a list Section/Entry=value | Section/Entry=value | ..."),
      "What all cases have different from the scene. {preparation} stands for the directory of the case of the section Preparation",
      "those of the parameters");
    table.declare(
      "Study/Methods",
      "",
      any_text("nothing, or a list of values of Solver/Method, separated by "
               "' | '"),
      "The methods that are compared; the scene's if empty",
      "none");
    table.declare(
      "Study/Columns",
      "status | iterations | long | short | null | J | error | law violation | seconds",
      any_text("a list of columns, separated by ' | '"),
      "What the table has for each case: " + Column::documentation(),
      "none");
    table.declare(
      "Study/Accepted statuses",
      "success",
      any_text("a list, separated by ' | '"),
      "Cases with another status, as in summary.json, count as failed; 'success | iteration limit' for studies in which not all cases converge",
      "none");
    table.declare(
      "Study/Fields",
      "false",
      one_of({"true", "false"}),
      "Whether the cases write their VTU files, which fields.pvd and contact.pvd then list as a series",
      "none");
    table.declare(
      "Study/Fit window",
      "1e-3, 1e-8",
      Pattern("two numbers > 0, the larger one first",
              [](const std::string &value) {
                double from, to;
                return read_fit_window(value, from, to);
              }),
      "The rate of convergence is fitted between the first iterations that have these errors (J - J_min) / |J_min|",
      "none");
    table.declare(
      "Study/Output directory",
      "output/{study}",
      any_text("a path"),
      "Relative to the working directory; {study} stands for the name of the study file without its ending",
      "none");

    table.declare(
      "Preparation/Settings",
      "",
      pairs_pattern("a list Section/Entry=value | Section/Entry=value | ..."),
      "If there are any, a case with the scene and these settings is run before the others",
      "those of the parameters");

    for (const std::string &section : sweep_sections)
      declare_sweep(section, table);

    table.declare("Plots/Kinds",
                  "",
                  any_text("nothing, or a list separated by ' | '"),
                  "Which plots are made: " + plot_documentation(),
                  "none");
    table.declare(
      "Plots/Fitted cases",
      "",
      any_text("nothing, or a list of values of the first sweep, separated by "
               "' | '"),
      "The cases that the plot 'fit' shows; all if empty",
      "none");
    declare_reference(table);
  }



  StudyParameters
  to_study_parameters(const std::string &file, ParameterTable &table)
  {
    StudyParameters study;
    study.file                    = file;
    study.title                   = table.get("Study/Title");
    study.description             = table.get("Study/Description");
    study.scene                   = beside(file, table.get("Study/Scene"));
    study.directory               = table.get("Study/Output directory");
    const std::string placeholder = "{study}";
    if (const std::size_t at = study.directory.find(placeholder);
        at != std::string::npos)
      study.directory.replace(at,
                              placeholder.size(),
                              std::filesystem::path(file).stem().string());
    if (study.title.empty())
      study.title = std::filesystem::path(file).stem().string();

    std::error_code error; // of a name that no file can have
    if (!std::filesystem::is_regular_file(study.scene, error))
      {
        table.add_error("Study/Scene",
                        "Study/Scene: there is no file " + study.scene);
        throw BadInput(table.errors());
      }

    study.settings = read_settings("Study/Settings", study.scene, table);
    study.preparation =
      read_settings("Preparation/Settings", study.scene, table);
    for (const std::string &section : sweep_sections)
      read_sweep(section, study, table);
    read_methods(study, table);
    read_columns(study, table);
    study.accepted_statuses =
      split_at_bars(table.get("Study/Accepted statuses"));
    study.fields = table.get_bool("Study/Fields");
    read_fit_window(table.get("Study/Fit window"),
                    study.fit_from,
                    study.fit_to);
    study.plots.kinds  = split_at_bars(table.get("Plots/Kinds"));
    study.plots.fitted = split_at_bars(table.get("Plots/Fitted cases"));
    for (const std::string &kind : study.plots.kinds)
      if (const std::string reason = why_no_plot(kind, study); !reason.empty())
        table.add_error("Plots/Kinds", "Plots/Kinds: " + reason);
    read_reference(study, table);

    if (!table.errors().empty())
      throw BadInput(table.errors());
    return study;
  }
} // namespace Debond
