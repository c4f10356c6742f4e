// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/text.h>
#include <debond/input/parameters.h>
#include <debond/solve/scene_size.h>
#include <debond/study/cases.h>
#include <debond/study/columns.h>
#include <debond/study/plots.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

namespace Debond
{
  namespace
  {
    const std::string preparation_placeholder = "{preparation}";



    std::string
    directory_name(const std::string &label)
    {
      std::string name;
      for (const char c : label)
        if (std::isalnum(static_cast<unsigned char>(c)) != 0 ||
            std::string("=.,+-_").find(c) != std::string::npos)
          name += c;
        else if (c != ' ')
          name += '_';
      return name;
    }



    bool
    concerns_solver(const std::string &setting)
    {
      return setting.compare(0, 7, "Solver/") == 0;
    }



    bool
    concerns_solver(const Sweep &sweep, const std::string &value)
    {
      const std::vector<std::string> settings = sweep.settings(value);
      return std::all_of(settings.begin(),
                         settings.end(),
                         [](const std::string &setting) {
                           return concerns_solver(setting);
                         });
    }



    /// Fills in what follows from the settings. Throws BadInput.
    void
    complete_case(const StudyParameters &study, Case &one)
    {
      const std::string fields = study.fields ? "true" : "false";
      one.settings.push_back("Output/Body VTU=" + fields);
      one.settings.push_back("Output/Contact VTU=" + fields);
      one.settings.push_back("Output/Directory=" + one.directory);

      SceneTable table;
      read_scene(study.scene, table);
      for (const std::string &setting : one.settings)
        table.assign(setting);
      try
        {
          const Parameters parameters = table.parameters(study.scene);
          one.effective_scene         = parameters.effective_scene;
          one.law                     = parameters.law;
          const BodyShape shape       = scene_size(parameters).shape;
          one.cell_edge               = shape.lengths[0] / shape.cells[0];
        }
      catch (const BadInput &error)
        {
          std::vector<std::string> lines;
          for (const std::string &line : error.lines)
            lines.push_back(study.file + ": case " + one.label + ": " + line);
          throw BadInput(lines);
        }
    }



    /// The number of the case that minimises exactly what @p one minimises.
    std::size_t
    add_minimum(const StudyParameters &study,
                const Case            &one,
                std::vector<Case>     &minima)
    {
      Case minimum;
      for (const std::string &setting : one.settings)
        if (!concerns_solver(setting))
          minimum.settings.push_back(setting);
      minimum.settings.push_back("Solver/Method=majorise minimise");

      for (std::size_t i = 0; i < minima.size(); ++i)
        if (std::equal(minimum.settings.begin(),
                       minimum.settings.end(),
                       minima[i].settings.begin()))
          return i;

      std::vector<std::string> values;
      for (std::size_t i = 0; i < study.sweeps.size(); ++i)
        if (!concerns_solver(study.sweeps[i], one.values[i]))
          values.push_back(study.sweeps[i].label + " = " + one.values[i]);
      minimum.label =
        join(values, ", ") + (values.empty() ? "" : ", ") + "exact minimum";
      minimum.directory =
        study.directory + "/minima/" +
        directory_name(values.empty() ? "minimum" : join(values, ","));
      minimum.cell_edge = one.cell_edge;
      minima.push_back(minimum);
      return minima.size() - 1;
    }



    /// All combinations of the values of the sweeps from number @p i on.
    void
    add_combinations(const StudyParameters          &study,
                     const std::vector<std::string> &values,
                     std::vector<Case>              &cases)
    {
      if (values.size() < study.sweeps.size())
        {
          for (const std::string &value : study.sweeps[values.size()].values)
            {
              std::vector<std::string> more = values;
              more.push_back(value);
              add_combinations(study, more, cases);
            }
          return;
        }

      Case one;
      one.values   = values;
      one.settings = study.settings;
      std::vector<std::string> words;
      for (std::size_t i = 0; i < values.size(); ++i)
        {
          words.push_back(study.sweeps[i].label + " = " + values[i]);
          for (const std::string &setting : study.sweeps[i].settings(values[i]))
            one.settings.push_back(setting);
        }
      one.label = words.empty() ? "the scene" : join(words, ", ");
      one.directory =
        study.directory + "/cases/" +
        (words.empty() ? "scene" : directory_name(join(words, ",")));
      cases.push_back(one);
    }



    bool
    needs_minima(const StudyParameters &study)
    {
      return std::any_of(study.columns.begin(),
                         study.columns.end(),
                         [](const std::string &name) {
                           return Column::parse(name).needs_minimum();
                         }) ||
             std::any_of(study.plots.kinds.begin(),
                         study.plots.kinds.end(),
                         plot_needs_minimum);
    }



    void
    replace_preparation(const std::string &directory, Case &one)
    {
      for (std::string &setting : one.settings)
        if (const std::size_t at = setting.find(preparation_placeholder);
            at != std::string::npos)
          setting.replace(at, preparation_placeholder.size(), directory);
    }
  } // namespace



  Cases
  make_cases(const StudyParameters &study)
  {
    Cases result;
    add_combinations(study, {}, result.cases);

    std::set<std::string> directories;
    for (Case &one : result.cases)
      {
        if (!study.preparation.empty())
          replace_preparation(study.directory + "/preparation", one);
        // Values that differ only in letters a path does not have.
        while (!directories.insert(one.directory).second)
          one.directory += "_";
        if (needs_minima(study))
          one.minimum = add_minimum(study, one, result.minima);
        complete_case(study, one);
      }
    for (Case &one : result.minima)
      {
        while (!directories.insert(one.directory).second)
          one.directory += "_";
        complete_case(study, one);
      }
    if (!study.preparation.empty())
      {
        result.preparation            = Case();
        result.preparation->label     = "preparation";
        result.preparation->settings  = study.preparation;
        result.preparation->directory = study.directory + "/preparation";
        complete_case(study, *result.preparation);
      }
    return result;
  }
} // namespace Debond
