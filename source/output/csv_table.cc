// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/output/csv_table.h>

#include <boost/algorithm/string/replace.hpp>

namespace Debond
{
  std::string
  CsvTable::cell(const std::string &text)
  {
    // A text with a comma, a quotation mark or a new line would be taken for
    // several cells or rows. It stands between quotation marks then, and those
    // that it has itself are doubled.
    if (text.find_first_of(",\"\n") == std::string::npos)
      return text;
    return '"' + boost::algorithm::replace_all_copy(text, "\"", "\"\"") + '"';
  }



  void
  CsvTable::add_row(const std::vector<Cell> &cells)
  {
    // The titles are those of the first row, with which the caller makes all
    // others agree.
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
    // The table is written as a whole each time, so that a reader never finds
    // half a row.
    write_atomically(file_name, [&](std::ostream &out) {
      for (const std::vector<std::string> &row : rows)
        out << join(row, ",") << '\n';
    });
  }
} // namespace Debond
