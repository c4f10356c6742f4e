// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/base/data_table.h>
#include <debond/benchmark/benchmark_table.h>

#include <algorithm>
#include <cmath>

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



    Cell
    cell_of(const BenchmarkRow &row, const std::string &name)
    {
      if (!has(row, name))
        return {};
      const BenchmarkRow &value = row[name];
      if (value.is_number_integer())
        return value.get<long>();
      if (value.is_number())
        return value.get<double>();
      return value_text(value);
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
                const unsigned int digits)
  {
    return {title, [name, digits](const BenchmarkRow &row) {
              return has(row, name) ? readable_number(row[name], digits) :
                                      absent;
            }};
  }



  BenchmarkColumn
  spread_column(const std::string &title,
                const std::string &name,
                const unsigned int digits)
  {
    return {title, [name, digits](const BenchmarkRow &row) -> std::string {
              if (!has(row, name))
                return absent;
              return readable_number(row[name], digits) + " (" +
                     readable_number(row[name + "_min"], digits) + " to " +
                     readable_number(row[name + "_max"], digits) + ")";
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

    DataTable table;
    for (const std::string &name : names)
      table.add_column(name);
    for (const BenchmarkRow &row : rows)
      {
        std::vector<Cell> cells;
        for (const std::string &name : names)
          cells.push_back(cell_of(row, name));
        table.add_row(cells);
      }
    table.write_csv(file_name);
  }



  void
  write_markdown(const std::string                  &heading,
                 const std::vector<BenchmarkColumn> &columns,
                 const std::vector<BenchmarkRow>    &rows,
                 const std::string                  &file_name)
  {
    DataTable table;
    for (const BenchmarkColumn &column : columns)
      table.add_column(column.title);
    for (const BenchmarkRow &row : rows)
      {
        std::vector<Cell> cells;
        for (const BenchmarkColumn &column : columns)
          cells.emplace_back(column.text(row));
        table.add_row(cells);
      }
    write_atomically(file_name, [&](std::ostream &out) {
      out << heading << "\n\n" << table.markdown();
    });
  }
} // namespace Debond
