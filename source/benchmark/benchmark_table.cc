// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/benchmark/benchmark_table.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Debond
{
  namespace
  {
    /// What stands where there is no value.
    const char *const absent = "-";



    bool
    has(const BenchmarkRow &row, const std::string &name)
    {
      if (!row.contains(name) || row[name].is_null())
        return false;
      return !row[name].is_number() || std::isfinite(row[name].get<double>());
    }



    std::string
    value_text(const BenchmarkRow &value)
    {
      return value.is_string() ? value.get<std::string>() : value.dump();
    }



    std::string
    number_text(const double value, const int digits)
    {
      std::ostringstream text;
      text.precision(digits);
      text << value;
      return text.str();
    }
  } // namespace



  void
  add_spread(const std::string &name, const Spread &spread, BenchmarkRow &row)
  {
    row[name]          = spread.median;
    row[name + "_min"] = spread.min;
    row[name + "_max"] = spread.max;
  }



  BenchmarkColumn
  plain_column(const std::string &title, const std::string &name)
  {
    return {title, [name](const BenchmarkRow &row) {
              return has(row, name) ? value_text(row[name]) : absent;
            }};
  }



  BenchmarkColumn
  number_column(const std::string &title,
                const std::string &name,
                const int          digits)
  {
    return {title, [name, digits](const BenchmarkRow &row) {
              return has(row, name) ? number_text(row[name], digits) : absent;
            }};
  }



  BenchmarkColumn
  spread_column(const std::string &title,
                const std::string &name,
                const int          digits)
  {
    return {title, [name, digits](const BenchmarkRow &row) -> std::string {
              if (!has(row, name))
                return absent;
              return number_text(row[name], digits) + " (" +
                     number_text(row[name + "_min"], digits) + " to " +
                     number_text(row[name + "_max"], digits) + ")";
            }};
  }



  void
  write_csv(const std::vector<BenchmarkRow> &rows, const std::string &file_name)
  {
    std::vector<std::string> names;
    for (const BenchmarkRow &row : rows)
      for (const auto &[name, value] : row.items())
        if (std::find(names.begin(), names.end(), name) == names.end())
          names.push_back(name);

    write_atomically(file_name, [&](std::ostream &out) {
      const char *separator = "";
      for (const std::string &name : names)
        {
          out << separator << name;
          separator = ",";
        }
      out << '\n';
      for (const BenchmarkRow &row : rows)
        {
          separator = "";
          for (const std::string &name : names)
            {
              out << separator << (has(row, name) ? value_text(row[name]) : "");
              separator = ",";
            }
          out << '\n';
        }
    });
  }



  void
  write_markdown(const std::string                  &heading,
                 const std::vector<BenchmarkColumn> &columns,
                 const std::vector<BenchmarkRow>    &rows,
                 const std::string                  &file_name)
  {
    write_atomically(file_name, [&](std::ostream &out) {
      out << heading << "\n\n|";
      for (const BenchmarkColumn &column : columns)
        out << ' ' << column.title << " |";
      out << "\n|";
      for (std::size_t k = 0; k < columns.size(); ++k)
        out << "---|";
      out << '\n';
      for (const BenchmarkRow &row : rows)
        {
          out << '|';
          for (const BenchmarkColumn &column : columns)
            out << ' ' << column.text(row) << " |";
          out << '\n';
        }
    });
  }
} // namespace Debond
