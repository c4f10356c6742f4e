// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs of scenes within a test, and the same body in several systems of units.
#ifndef debond_tests_program_solve_scene_h
#define debond_tests_program_solve_scene_h

#include <debond/input/parameters.h>
#include <debond/program/run.h>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "assignments.h"

using Json = nlohmann::json;

/// The rows of a table, each with its cells by their titles; none if there is
/// no such file.
inline Json
read_table(const std::filesystem::path &file)
{
  std::ifstream input(file);
  std::string   line, cell;
  std::getline(input, line);
  std::vector<std::string> names;
  std::istringstream       titles(line);
  while (std::getline(titles, cell, ','))
    names.push_back(cell);
  Json rows = Json::array();
  while (std::getline(input, line))
    {
      std::istringstream cells(line);
      Json               row;
      for (unsigned int k = 0; std::getline(cells, cell, ','); ++k)
        row[names.at(k)] = cell;
      rows.push_back(row);
    }
  return rows;
}



/// The summary of a run with its exit code, the rows of load_path.csv as "path"
/// and those of contact_profile.csv as "profile"; "rejected" as status of what
/// is no scene, whose errors are printed.
inline Json
solve_scene(const Values &assignments)
{
  const std::filesystem::path directory =
    std::filesystem::temp_directory_path() /
    ("debond-scene-" + std::to_string(getpid()));
  Debond::SceneTable table;
  for (const std::string &assignment : assignments)
    table.assign(assignment);
  for (const char *file : {"Body VTU", "Contact VTU"})
    table.assign(std::string("Output/") + file + "=false");
  table.assign("Output/Directory=" + directory.string());
  std::ostringstream log;
  Json               summary;
  try
    {
      const Debond::Parameters parameters = table.parameters("scene.prm");
      const Debond::ExitCode   code       = parameters.dimension == 2 ?
                                              Debond::run<2>(parameters, log, false) :
                                              Debond::run<3>(parameters, log, false);
      std::ifstream(directory / "summary.json") >> summary;
      summary["exit_code"] = static_cast<int>(code);
      summary["path"]      = read_table(directory / "load_path.csv");
      summary["profile"]   = read_table(directory / "contact_profile.csv");
    }
  catch (const std::invalid_argument &error)
    {
      std::cout << error.what() << std::endl;
      summary["status"] = "rejected";
    }
  std::filesystem::remove_all(directory);
  return summary;
}



/// A cell of a row.
inline double
number(const Json &row, const std::string &column)
{
  return std::stod(row.at(column).get<std::string>());
}



inline double
relative(const double value, const double expected)
{
  return std::abs(value / expected - 1.);
}



/// A length and a modulus in some units.
struct Units
{
  std::string name;
  double      length, modulus;
};

inline const std::vector<Units> systems = {{"GPa and m", 1., 1.},
                                           {"Pa and m", 1., 1e9},
                                           {"MPa and mm", 1e3, 1e3}};

#endif
