// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/patterns.h>
#include <debond/study/best_values.h>

#include <map>

namespace Debond
{
  namespace
  {
    struct Candidates
    {
      double              cell_edge;
      std::vector<double> values;
      std::vector<double> iterations;
    };
  } // namespace



  std::vector<BestRow>
  find_best_values(const StudyParameters       &study,
                   const std::vector<StudyRow> &rows)
  {
    if (study.sweeps.size() < 2)
      return {};

    // By the order of the sweeps' values, not of the letters in them.
    std::vector<std::pair<std::string, std::string>>          order;
    std::map<std::pair<std::string, std::string>, Candidates> groups;
    for (const StudyRow &row : rows)
      {
        const std::vector<std::string> &values = row.one->values;
        const auto                      key =
          std::make_pair(values[0], values.size() > 2 ? values[2] : "");
        if (groups.count(key) == 0)
          order.push_back(key);
        Candidates &group = groups[key];
        group.cell_edge   = row.one->cell_edge;
        double number;
        if (!read_number(values[1], number))
          return {};
        group.values.push_back(number);
        group.iterations.push_back(row.result.status == "success" ?
                                     row.result.number("/iterations/total") :
                                     0.);
      }

    std::vector<BestRow> result;
    for (const auto &key : order)
      {
        const Candidates &group = groups[key];
        if (const auto best = best_value(group.values, group.iterations); best)
          result.push_back({key.first, key.second, group.cell_edge, *best});
      }
    return result;
  }



  std::optional<PowerLaw>
  fit_best_values(const std::vector<BestRow> &rows)
  {
    std::vector<double> h, values;
    for (const BestRow &row : rows)
      if (!row.best.at_end)
        {
          h.push_back(row.cell_edge);
          values.push_back(row.best.value);
        }
    return fit_power_law(h, values);
  }
} // namespace Debond
