// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/base/data_table.h>
#include <debond/study/case_result.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    std::string
    summary_file(const Case &one)
    {
      return one.directory + "/summary.json";
    }



    /// Throws std::runtime_error naming the file.
    nlohmann::json
    read_summary(const std::string &file_name)
    {
      std::ifstream file = open_plain_file(file_name);
      try
        {
          return nlohmann::json::parse(file);
        }
      catch (const nlohmann::json::exception &error)
        {
          throw std::runtime_error("Cannot read " + file_name + ": " +
                                   error.what());
        }
    }



    bool
    has_parameters_of(const Case &one)
    {
      std::ifstream file = open_plain_file(one.directory + "/parameters.prm");
      std::ostringstream text;
      text << file.rdbuf();
      return text.str() == one.effective_scene;
    }



    /// The column `functional` of a history; empty if there is no such file.
    std::vector<double>
    read_functionals(const std::string &file_name)
    {
      std::vector<double> functionals;
      if (!std::filesystem::exists(file_name))
        return functionals;
      const CsvFile file   = read_csv(file_name);
      const auto    column = file.column("functional");
      if (!column)
        throw std::runtime_error(file_name + ": there is no column functional");
      for (const std::vector<std::string> &row : file.rows)
        functionals.push_back(std::stod(row[*column]));
      return functionals;
    }
  } // namespace



  double
  CaseResult::number(const std::string &pointer) const
  {
    const auto entry = numbers.find(pointer);
    if (entry == numbers.end())
      throw std::runtime_error("summary.json has no number " + pointer);
    return entry->second;
  }



  bool
  is_finished(const Case &one)
  {
    if (!has_parameters_of(one) ||
        !std::filesystem::is_regular_file(summary_file(one)))
      return false;
    try
      {
        return read_summary(summary_file(one)).at("status") != "interrupted";
      }
    catch (const std::exception &)
      {
        return false;
      }
  }



  bool
  can_restart(const Case &one)
  {
    return has_parameters_of(one) &&
           std::filesystem::is_regular_file(one.directory + "/checkpoint");
  }



  CaseResult
  read_results(const Case &one)
  {
    const nlohmann::json summary = read_summary(summary_file(one));
    CaseResult           result;
    result.status             = summary.value("status", "");
    result.message            = summary.value("message", "");
    const nlohmann::json flat = summary.flatten();
    for (const auto &[pointer, value] : flat.items())
      if (value.is_number())
        result.numbers[pointer] = value.get<double>();
    result.history = read_functionals(one.directory + "/history.csv");
    return result;
  }
} // namespace Debond
