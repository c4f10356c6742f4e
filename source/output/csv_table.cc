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
  CsvTable::write(const std::string &file_name) const
  {
    write_atomically(file_name, [&](std::ostream &out) {
      for (const std::vector<std::string> &row : rows)
        out << join(row, ",") << '\n';
    });
  }
} // namespace Debond
