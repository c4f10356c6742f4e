// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/study/benchmark_suite.h>

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



    BenchmarkSuite
    to_benchmark_suite(const nlohmann::json        &json,
                       const std::filesystem::path &directory)
    {
      BenchmarkSuite     suite;
      const unsigned int repetitions = json.at("repetitions");
      suite.output                   = json.at("output");

      const nlohmann::json &start_up = json.at("start-up");
      suite.start_up                 = to_benchmark_scene(start_up, directory);
      suite.start_up_repetitions = start_up.value("repetitions", repetitions);

      for (const nlohmann::json &row : json.at("contact solves"))
        suite.contact_solves.push_back({to_benchmark_scene(row, directory),
                                        row.at("linear solvers"),
                                        row.value("repetitions", repetitions)});
      for (const nlohmann::json &row : json.at("meshes"))
        suite.meshes.push_back({to_benchmark_scene(row, directory),
                                row.at("methods"),
                                row.value("repetitions", repetitions)});
      return suite;
    }
  } // namespace



  Parameters
  BenchmarkScene::parameters() const
  {
    ParameterTable table;
    declare_parameters(table);
    read_scene(scene, table);
    for (const std::string &setting : settings)
      table.assign(setting);
    // No iterations in the log.
    table.assign("Output/Machine details=false");
    return to_parameters(scene, table);
  }



  BenchmarkSuite
  read_benchmark_suite(const std::string &file)
  {
    std::ifstream stream(file);
    if (!stream)
      throw BadInput({"cannot read " + file});
    try
      {
        return to_benchmark_suite(nlohmann::json::parse(stream),
                                  std::filesystem::path(file).parent_path());
      }
    catch (const nlohmann::json::exception &error)
      {
        throw BadInput({file + ": " + error.what()});
      }
  }
} // namespace Debond
