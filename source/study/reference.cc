// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/input/parameters.h>
#include <debond/study/reference.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace Debond
{
  namespace
  {
    /// Whether two texts are the same value: as numbers, if they are numbers.
    bool
    is_same_value(const std::string &a, const std::string &b)
    {
      double x, y;
      if (read_number(a, x) && read_number(b, y))
        return x == y;
      return a == b;
    }
  } // namespace



  Reference::Reference(const ReferenceParameters &parameters)
    : parameters(parameters)
  {
    std::ifstream file(parameters.file);
    if (!file)
      throw BadInput({parameters.file + ": cannot be read"});
    std::vector<std::string> titles;
    for (std::string line; std::getline(file, line);)
      {
        if (line.empty() || line[0] == '#')
          continue;
        const std::vector<std::string> entries =
          dealii::Utilities::split_string_list(line, ',');
        if (titles.empty())
          {
            titles = entries;
            continue;
          }
        // An empty last entry is none to split_string_list().
        Row row;
        for (std::size_t i = 0; i < titles.size(); ++i)
          row[titles[i]] = i < entries.size() ? entries[i] : "";
        if (std::all_of(parameters.rows.begin(),
                        parameters.rows.end(),
                        [&row](const auto &wanted) {
                          return row.count(wanted.first) > 0 &&
                                 is_same_value(row.at(wanted.first),
                                               wanted.second);
                        }))
          rows.push_back(row);
      }
    if (rows.empty())
      throw BadInput(
        {parameters.file + ": has no rows with what Reference/Rows asks for"});

    const auto require = [&](const std::string &title) {
      if (std::find(titles.begin(), titles.end(), title) == titles.end())
        throw BadInput({parameters.file + ": there is no column " + title});
    };
    require(parameters.key);
    for (const auto &column : parameters.columns)
      require(column.second);
  }



  Cell
  Reference::value(const std::string &sweep_value,
                   const std::string &study_column,
                   const bool         as_error) const
  {
    const auto column = parameters.columns.find(study_column);
    const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const Row &candidate) {
        return is_same_value(candidate.at(parameters.key), sweep_value);
      });
    double number;
    if (column == parameters.columns.end() || row == rows.end() ||
        !read_number(row->at(column->second), number))
      return {};
    if (as_error)
      return (number - parameters.minimum) / std::abs(parameters.minimum);
    if (number == std::round(number))
      return std::lround(number);
    return number;
  }
} // namespace Debond
