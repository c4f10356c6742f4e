// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_benchmark_benchmark_table_h
#define debond_benchmark_benchmark_table_h

#include <debond/benchmark/measurement.h>

#include <nlohmann/json.hpp>

#include <functional>
#include <string>
#include <vector>

namespace Debond
{
  /// A row of results: values by name, in order.
  using BenchmarkRow = nlohmann::ordered_json;

  /// Adds median, minimum and maximum as `name`, `name_min` and `name_max`.
  void
  add_spread(const std::string &name, const Spread &spread, BenchmarkRow &row);



  /// A column of a table for readers: its title and what stands in a row.
  struct BenchmarkColumn
  {
    std::string                                      title;
    std::function<std::string(const BenchmarkRow &)> text;
  };

  /// The value as it is.
  BenchmarkColumn
  plain_column(const std::string &title, const std::string &name);

  /// With so many significant digits; scientific where that is shorter.
  BenchmarkColumn
  number_column(const std::string &title,
                const std::string &name,
                const unsigned int digits);

  /// "median (minimum to maximum)".
  BenchmarkColumn
  spread_column(const std::string &title,
                const std::string &name,
                const unsigned int digits);



  /// All values with all digits. A value that a row does not have is left
  /// empty. Throws std::runtime_error naming the
  /// file if it cannot be written.
  void
  write_csv(const std::vector<BenchmarkRow> &rows,
            const std::string               &file_name);

  /// A Markdown table with lines above it.
  void
  write_markdown(const std::string                  &heading,
                 const std::vector<BenchmarkColumn> &columns,
                 const std::vector<BenchmarkRow>    &rows,
                 const std::string                  &file_name);
} // namespace Debond

#endif
