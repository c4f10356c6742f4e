// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/output/csv_table.h>

#include <boost/algorithm/string/replace.hpp>

namespace Debond
{
  std::string
  CsvTable::cell(const std::string &text)
  {
    if (text.find_first_of(",\"\n") == std::string::npos)
      return text;
    return '"' + boost::algorithm::replace_all_copy(text, "\"", "\"\"") + '"';
  }



  void
  CsvTable::add_row(const std::vector<Cell> &cells)
  {
    std::vector<std::string> titles, row;
    for (const auto &[title, text] : cells)
      {
        titles.push_back(cell(title));
        row.push_back(text);
      }
    if (rows.empty())
      rows.push_back(titles);
    rows.push_back(row);
  }



  void
  CsvTable::write(const std::string &file_name) const
  {
    write_atomically(file_name, [&](std::ostream &out) {
      for (const std::vector<std::string> &row : rows)
        out << join(row, ",") << '\n';
    });
  }
} // namespace Debond
