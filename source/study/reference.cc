// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/input/parameters.h>
#include <debond/study/reference.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

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
    CsvFile file;
    try
      {
        file = read_csv(parameters.file);
      }
    catch (const std::runtime_error &error)
      {
        throw BadInput({error.what()});
      }
    for (const std::vector<std::string> &entries : file.rows)
      {
        Row row;
        for (std::size_t i = 0; i < file.titles.size(); ++i)
          row[file.titles[i]] = entries[i];
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
      if (!file.column(title))
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
