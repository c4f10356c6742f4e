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

    const std::array<std::string, 2> sweep_sections = {{"Sweep 1", "Sweep 2"}};

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



    /// Reads "a = 1 | b = 2". Throws std::invalid_argument if the text is not
    /// such a list.
    std::map<std::string, std::string>
    parse_pairs(const std::string &text)
    {
      std::map<std::string, std::string> pairs;
      for (const std::string &item : split_at_bars(text))
        {
          const std::size_t equals = item.find('=');
          if (equals == std::string::npos)
            throw std::invalid_argument("'" + item + "' has no '='");
          pairs.emplace(trim(item.substr(0, equals)),
                        trim(item.substr(equals + 1)));
        }
      return pairs;
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
    bind_list(const std::string        &path,
              std::vector<std::string> &variable,
              const Pattern            &pattern,
              const std::string        &documentation,
              const std::string        &units,
              ParameterTable           &table)
    {
      table.declare(path,
                    join(variable, " | "),
                    pattern,
                    documentation,
                    units,
                    [&variable](const std::string &text) {
                      variable = split_at_bars(text);
                    });
    }



    void
    bind_settings(const std::string        &path,
                  std::vector<std::string> &variable,
                  const std::string        &documentation,
                  ParameterTable           &table)
    {
      bind_list(
        path,
        variable,
        parsed_by("a list Section/Entry=value | Section/Entry=value | ...",
                  parse_pairs),
        documentation,
        "those of the parameters",
        table);
    }



    void
    bind_pairs(const std::string                  &path,
               std::map<std::string, std::string> &variable,
               const std::string                  &allowed,
               const std::string                  &documentation,
               ParameterTable                     &table)
    {
      table.declare(path,
                    "",
                    parsed_by(allowed, parse_pairs),
                    documentation,
                    "none",
                    [&variable](const std::string &text) {
                      variable = parse_pairs(text);
                    });
    }



    void
    bind_study(StudyParameters          &study,
               std::vector<std::string> &methods,
               ParameterTable           &table)
    {
      table.bind("Study/Title",
                 study.title,
                 any_text("a text"),
                 "The head of the index page",
                 "none");
      table.bind("Study/Description",
                 study.description,
                 any_text("a text"),
                 "A paragraph for the index page",
                 "none");
      table.bind("Study/Scene",
                 study.scene,
                 any_text("a path relative to the study file"),
                 "The scene that all cases begin with",
                 "none");
      bind_settings(
        "Study/Settings",
        study.settings,
        "What all cases have different from the scene. {preparation} stands for the directory of the case of the section Preparation",
        table);
      bind_list("Study/Methods",
                methods,
                any_text(
                  "nothing, or a list of values of Solver/Method, separated by "
                  "' | '"),
                "The methods that are compared; the scene's if empty",
                "none",
                table);
      bind_list("Study/Columns",
                study.columns,
                any_text("a list of columns, separated by ' | '"),
                "What the table has for each case: " + Column::documentation(),
                "none",
                table);
      bind_list(
        "Study/Accepted statuses",
        study.accepted_statuses,
        any_text("a list, separated by ' | '"),
        "Cases with another status, as in summary.json, count as failed; 'success | iteration limit' for studies in which not all cases converge",
        "none",
        table);
      table.bind(
        "Study/Fields",
        study.fields,
        "Whether the cases write their VTU files, which fields.pvd and contact.pvd then list as a series");
      table.declare(
        "Study/Fit window",
        "1e-3, 1e-8",
        Pattern("two numbers > 0, the larger one first",
                [](const std::string &value) {
                  double from, to;
                  return read_fit_window(value, from, to);
                }),
        "The rate of convergence is fitted between the first iterations that have these errors (J - J_min) / |J_min|",
        "none",
        [&study](const std::string &text) {
          read_fit_window(text, study.fit_from, study.fit_to);
        });
      table.bind(
        "Study/Output directory",
        study.directory,
        any_text("a path"),
        "Relative to the working directory; {study} stands for the name of the study file without its ending",
        "none");
      bind_settings(
        "Preparation/Settings",
        study.preparation,
        "If there are any, a case with the scene and these settings is run before the others",
        table);
    }



    void
    bind_sweep(const std::string &section, Sweep &sweep, ParameterTable &table)
    {
      table.bind(section + "/Parameter",
                 sweep.parameter,
                 any_text("nothing, or Section/Entry as for --set"),
                 "The parameter of the scene that is varied; none if empty",
                 "none");
      table.bind(section + "/Label",
                 sweep.label,
                 any_text("a text"),
                 "Its name in tables and plots; Section/Entry if empty",
                 "none");
      table.declare(
        section + "/Values",
        "",
        parsed_by("a | b | c (with blanks around the bars), or geometric FIRST "
                  "LAST COUNT",
                  parse_sweep_values),
        "The values it is given: each one as it would stand in the scene, or a geometric range of numbers",
        "those of the parameter",
        [&sweep](const std::string &text) {
          sweep.values = parse_sweep_values(text);
        });
    }



    void
    bind_plots(PlotParameters &plots, ParameterTable &table)
    {
      bind_list("Plots/Kinds",
                plots.kinds,
                any_text("nothing, or a list separated by ' | '"),
                "Which plots are made: " + plot_documentation(),
                "none",
                table);
      bind_list("Plots/Fitted cases",
                plots.fitted,
                any_text(
                  "nothing, or a list of values of the first sweep, separated "
                  "by ' | '"),
                "The cases that the plot 'fit' shows; all if empty",
                "none",
                table);
    }



    void
    bind_reference(ReferenceParameters &reference, ParameterTable &table)
    {
      table.bind(
        "Reference/File",
        reference.file,
        any_text("nothing, or a path relative to the study file"),
        "A CSV file with printed results, to stand beside those of the study; its first line that is not a comment ('#') has the titles",
        "none");
      table.bind("Reference/Label",
                 reference.label,
                 any_text("a text"),
                 "What the columns of the reference are called",
                 "none");
      bind_pairs("Reference/Rows",
                 reference.rows,
                 "a list COLUMN=TEXT | COLUMN=TEXT | ...",
                 "Which rows of the file count",
                 table);
      table.bind("Reference/Key",
                 reference.key,
                 any_text("the name of a column"),
                 "The column of the file that has the value of the first sweep",
                 "none");
      bind_pairs(
        "Reference/Columns",
        reference.columns,
        "a list COLUMN=COLUMN | COLUMN=COLUMN | ...",
        "For columns of the study the columns of the file that are shown beside them. If the study's column is an error, the file's is a functional, and its error is shown",
        table);
      table.bind("Reference/Minimum",
                 reference.minimum,
                 any_number(),
                 "The functional to which those of the file are compared",
                 "energy");
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
      SceneTable scene_table;
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



    void
    check_settings(const std::string              &path,
                   const std::vector<std::string> &settings,
                   const std::string              &scene,
                   ParameterTable                 &table)
    {
      for (const std::string &setting : settings)
        check_setting(scene, setting, path, table);
    }



    void
    add_sweep(const std::string &section,
              Sweep              sweep,
              StudyParameters   &study,
              ParameterTable    &table)
    {
      if (sweep.label.empty())
        sweep.label = sweep.parameter;
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
            check_settings(section + "/Values",
                           sweep.settings(value),
                           study.scene,
                           table);
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
    add_methods(const std::vector<std::string> &methods,
                StudyParameters                &study,
                ParameterTable                 &table)
    {
      for (const std::string &method : methods)
        check_setting(study.scene,
                      method_parameter + "=" + method,
                      "Study/Methods",
                      table);
      if (methods.size() > 1)
        study.sweeps.push_back({method_parameter, "method", methods});
      else if (methods.size() == 1)
        study.settings.push_back(method_parameter + "=" + methods.front());
    }



    void
    check_columns(const StudyParameters &study, ParameterTable &table)
    {
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
    check_plots(const StudyParameters &study, ParameterTable &table)
    {
      for (const std::string &kind : study.plots.kinds)
        if (const std::string reason = why_no_plot(kind, study);
            !reason.empty())
          table.add_error("Plots/Kinds", "Plots/Kinds: " + reason);
    }



    void
    check_reference(const StudyParameters &study, ParameterTable &table)
    {
      for (const auto &column : study.reference.columns)
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



  StudyTable::StudyTable()
  {
    bind_study(study, methods, *this);
    for (std::size_t i = 0; i < sweeps.size(); ++i)
      bind_sweep(sweep_sections[i], sweeps[i], *this);
    bind_plots(study.plots, *this);
    bind_reference(study.reference, *this);
  }



  StudyParameters
  StudyTable::parameters(const std::string &file)
  {
    parse();
    const std::string name = std::filesystem::path(file).stem().string();
    study.file             = file;
    if (study.title.empty())
      study.title = name;
    const std::string placeholder = "{study}";
    if (const std::size_t at = study.directory.find(placeholder);
        at != std::string::npos)
      study.directory.replace(at, placeholder.size(), name);
    study.scene = beside(file, study.scene);
    if (study.reference.file.empty())
      study.reference = ReferenceParameters();
    else
      study.reference.file = beside(file, study.reference.file);

    std::error_code error; // of a name that no file can have
    if (!std::filesystem::is_regular_file(study.scene, error))
      {
        add_error("Study/Scene",
                  "Study/Scene: there is no file " + study.scene);
        throw BadInput(errors());
      }

    check_settings("Study/Settings", study.settings, study.scene, *this);
    check_settings("Preparation/Settings",
                   study.preparation,
                   study.scene,
                   *this);
    for (std::size_t i = 0; i < sweeps.size(); ++i)
      add_sweep(sweep_sections[i], sweeps[i], study, *this);
    add_methods(methods, study, *this);
    check_columns(study, *this);
    check_plots(study, *this);
    check_reference(study, *this);
    if (!errors().empty())
      throw BadInput(errors());
    return study;
  }
} // namespace Debond
