// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/base/text.h>
#include <debond/output/csv_table.h>

#include <boost/algorithm/string/replace.hpp>

namespace Debond
{
  CsvTable::CsvTable(const Row &titles)
    : rows({titles})
  {}



  std::string
  CsvTable::cell(const std::string &text)
  {
    if (text.find_first_of(",\"\n") == std::string::npos)
      return text;
    return '"' + boost::algorithm::replace_all_copy(text, "\"", "\"\"") + '"';
  }



  std::string
  CsvTable::cell(const double number)
  {
    return shortest_text(number);
  }



  std::string
  CsvTable::cell(const std::optional<double> &number)
  {
    return number ? shortest_text(*number) : "";
  }



  void
  CsvTable::add_row(const Row &cells)
  {
    rows.push_back(cells);
    rows.back().resize(rows[0].size());
  }



  void
  CsvTable::write(const std::string &file_name) const
  {
    write_atomically(file_name, [&](std::ostream &out) {
      for (const Row &row : rows)
        out << join(row, ",") << '\n';
    });
  }
} // namespace Debond
