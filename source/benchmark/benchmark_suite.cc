// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/benchmark/benchmark_suite.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>

namespace Debond
{
  namespace
  {
    BenchmarkScene
    to_benchmark_scene(const nlohmann::json        &json,
                       const std::filesystem::path &directory)
    {
      return {json.at("name"),
              (directory / json.at("scene").get<std::string>())
                .lexically_normal()
                .string(),
              json.value("settings", std::vector<std::string>())};
    }



    /// nlohmann::json would wrap a negative number and cut a fraction.
    unsigned int
    to_repetitions(const nlohmann::json &json)
    {
      if (!json.is_number_unsigned() || json < 1 || json > 1000)
        throw std::invalid_argument("repetitions = " + json.dump() +
                                    ": expected a whole number from 1 to 1000");
      return json;
    }



    BenchmarkSuite
    to_benchmark_suite(const nlohmann::json        &json,
                       const std::filesystem::path &directory)
    {
      BenchmarkSuite     suite;
      const unsigned int repetitions = to_repetitions(json.at("repetitions"));
      const auto         repetitions_of = [&](const nlohmann::json &row) {
        return row.contains("repetitions") ?
                         to_repetitions(row["repetitions"]) :
                         repetitions;
      };
      suite.output = json.at("output");

      const nlohmann::json &start_up = json.at("start-up");
      suite.start_up                 = to_benchmark_scene(start_up, directory);
      suite.start_up_repetitions     = repetitions_of(start_up);

      for (const nlohmann::json &row : json.at("contact solves"))
        suite.contact_solves.push_back({to_benchmark_scene(row, directory),
                                        row.at("linear solvers"),
                                        repetitions_of(row)});
      for (const nlohmann::json &row : json.at("meshes"))
        suite.meshes.push_back({to_benchmark_scene(row, directory),
                                row.at("methods"),
                                repetitions_of(row)});
      return suite;
    }
  } // namespace



  Parameters
  BenchmarkScene::parameters() const
  {
    try
      {
        SceneTable table;
        read_scene(scene, table);
        for (const std::string &setting : settings)
          table.assign(setting);
        // No iterations in the log.
        table.assign("Output/Machine details=false");
        return table.parameters(scene);
      }
    catch (const BadInput &error)
      {
        std::vector<std::string> lines;
        for (const std::string &line : error.lines)
          lines.push_back("benchmark \"" + name + "\": " + line);
        throw BadInput(lines);
      }
  }



  BenchmarkSuite
  read_benchmark_suite(const std::string &file)
  {
    std::ifstream stream(file);
    if (!stream)
      throw BadInput({"cannot read " + file});
    return read_benchmark_suite(stream, file);
  }



  BenchmarkSuite
  read_benchmark_suite(std::istream &stream, const std::string &file)
  {
    try
      {
        return to_benchmark_suite(nlohmann::json::parse(stream),
                                  std::filesystem::path(file).parent_path());
      }
    catch (const nlohmann::json::exception &error)
      {
        throw BadInput({file + ": " + error.what()});
      }
    catch (const std::invalid_argument &error)
      {
        throw BadInput({file + ": " + error.what()});
      }
  }
} // namespace Debond
