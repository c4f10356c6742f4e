// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/exceptions.h>

#include <debond/base/atomic_file.h>
#include <debond/base/data_table.h>
#include <debond/base/number_text.h>

#include <boost/algorithm/string/replace.hpp>

namespace Debond
{
  namespace
  {
    std::string
    cell_text(const Cell &cell)
    {
      if (const auto *const words = std::get_if<std::string>(&cell))
        return *words;
      if (const auto *const count = std::get_if<long>(&cell))
        return std::to_string(*count);
      if (const auto *const number = std::get_if<double>(&cell))
        return shortest_text(*number);
      return "";
    }



    std::string
    quoted(const std::string &text)
    {
      if (text.find_first_of(",\"\n") == std::string::npos)
        return text;
      return '"' + boost::algorithm::replace_all_copy(text, "\"", "\"\"") + '"';
    }
  } // namespace



  void
  DataTable::add_column(const std::string &title)
  {
    titles.push_back(title);
  }



  void
  DataTable::add_row(const std::vector<Cell> &cells)
  {
    AssertDimension(cells.size(), titles.size());
    rows.push_back(cells);
  }



  void
  DataTable::write_csv(const std::string &file_name) const
  {
    write_atomically(file_name, [&](std::ostream &out) {
      for (std::size_t i = 0; i < titles.size(); ++i)
        out << (i > 0 ? "," : "") << quoted(titles[i]);
      out << '\n';
      for (const auto &row : rows)
        {
          for (std::size_t i = 0; i < row.size(); ++i)
            out << (i > 0 ? "," : "") << quoted(cell_text(row[i]));
          out << '\n';
        }
    });
  }
} // namespace Debond
