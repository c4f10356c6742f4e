// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/exceptions.h>
#include <deal.II/base/table_handler.h>
#include <deal.II/base/utilities.h>

#include <debond/base/atomic_file.h>
#include <debond/base/data_table.h>
#include <debond/base/number_text.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    /// Numbers of this size are written without an exponent.
    bool
    is_handy(const double number)
    {
      return number == 0. ||
             (std::abs(number) >= 1e-3 && std::abs(number) < 1e4);
    }



    /// In place of a number of digits: those that read back as the number.
    constexpr unsigned int all_digits = 0;



    std::string
    cell_text(const Cell &cell, const unsigned int digits)
    {
      if (const auto *const words = std::get_if<std::string>(&cell))
        return *words;
      if (const auto *const count = std::get_if<long>(&cell))
        return std::to_string(*count);
      if (const auto *const number = std::get_if<double>(&cell))
        return digits == all_digits ? shortest_text(*number) :
                                      readable_number(*number, digits);
      return "";
    }



    std::string
    replace_each(const std::string                 &text,
                 const std::map<char, std::string> &replacements)
    {
      std::string result;
      for (const char c : text)
        if (const auto entry = replacements.find(c);
            entry != replacements.end())
          result += entry->second;
        else
          result += c;
      return result;
    }



    std::string
    quoted_for_csv(const std::string &text)
    {
      if (text.find_first_of(",\"\n") == std::string::npos)
        return text;
      return '"' + replace_each(text, {{'"', "\"\""}}) + '"';
    }



    std::string
    escaped_for_markdown(const std::string &text)
    {
      return replace_each(text, {{'|', "\\|"}, {'_', "\\_"}, {'*', "\\*"}});
    }



    std::string
    escaped_for_latex(const std::string &text)
    {
      return replace_each(text,
                          {{'_', "\\_"},
                           {'%', "\\%"},
                           {'&', "\\&"},
                           {'#', "\\#"},
                           {'$', "\\$"},
                           {'{', "\\{"},
                           {'}', "\\}"},
                           {'^', "\\^{}"},
                           {'~', "\\~{}"},
                           {'\\', "\\textbackslash{}"},
                           {'|', "$|$"},
                           {'<', "$<$"},
                           {'>', "$>$"}});
    }



    /// As deal.II has it, which prints an empty text as two quotation marks.
    dealii::TableHandler
    table_handler(const std::vector<std::string>       &titles,
                  const std::vector<unsigned int>      &digits,
                  const std::vector<std::vector<Cell>> &rows,
                  std::string (*const escape)(const std::string &))
    {
      dealii::TableHandler handler;
      for (const std::string &title : titles)
        {
          handler.declare_column(escape(title));
          handler.set_tex_format(escape(title), "r");
        }
      for (const auto &row : rows)
        for (std::size_t i = 0; i < titles.size(); ++i)
          {
            const std::string text = escape(cell_text(row[i], digits[i]));
            handler.add_value(escape(titles[i]), text.empty() ? " " : text);
          }
      return handler;
    }
  } // namespace



  std::string
  readable_number(const double number, const unsigned int digits)
  {
    std::ostringstream text;
    if (is_handy(number))
      text << std::setprecision(digits) << number;
    else
      text << std::scientific << std::setprecision(digits - 1) << number;
    return text.str();
  }



  void
  DataTable::add_column(const std::string &title, const unsigned int n_digits)
  {
    titles.push_back(title);
    digits.push_back(n_digits);
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
        out << (i > 0 ? "," : "") << quoted_for_csv(titles[i]);
      out << '\n';
      for (const auto &row : rows)
        {
          for (std::size_t i = 0; i < row.size(); ++i)
            out << (i > 0 ? "," : "")
                << quoted_for_csv(cell_text(row[i], all_digits));
          out << '\n';
        }
    });
  }



  std::string
  DataTable::markdown() const
  {
    std::ostringstream text;
    table_handler(titles, digits, rows, escaped_for_markdown)
      .write_text(text, dealii::TableHandler::org_mode_table);
    // Markdown wants a line between the titles and the rows.
    std::string       lines = text.str();
    const std::size_t end   = lines.find('\n') + 1;
    std::string       separator;
    for (std::size_t i = 0; i < titles.size(); ++i)
      separator += "|---";
    lines.insert(end, separator + "|\n");
    return lines;
  }



  void
  DataTable::write_markdown(const std::string &file_name) const
  {
    write_atomically(file_name, [&](std::ostream &out) { out << markdown(); });
  }



  void
  DataTable::write_latex(const std::string &file_name) const
  {
    write_atomically(file_name, [&](std::ostream &out) {
      table_handler(titles, digits, rows, escaped_for_latex)
        .write_tex(out, false);
    });
  }



  std::optional<std::size_t>
  CsvFile::column(const std::string &title) const
  {
    const auto entry = std::find(titles.begin(), titles.end(), title);
    if (entry == titles.end())
      return {};
    return entry - titles.begin();
  }



  CsvFile
  read_csv(const std::string &file_name)
  {
    std::ifstream file = open_plain_file(file_name);
    if (!file)
      throw std::runtime_error(file_name + ": cannot be read");
    CsvFile result;
    for (std::string line; std::getline(file, line);)
      {
        if (line.empty() || line[0] == '#')
          continue;
        std::vector<std::string> entries =
          dealii::Utilities::split_string_list(line, ',');
        if (result.titles.empty())
          {
            result.titles = entries;
            continue;
          }
        if (entries.size() > result.titles.size())
          throw std::runtime_error(file_name +
                                   ": its rows do not fit its titles");
        entries.resize(result.titles.size());
        result.rows.push_back(entries);
      }
    return result;
  }
} // namespace Debond
