// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_data_table_h
#define debond_base_data_table_h

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace Debond
{
  /// What a cell of a table has: nothing, words, a count or a number.
  using Cell = std::variant<std::monostate, std::string, long, double>;

  /// A number with so many significant digits, without an exponent if it is
  /// handy.
  std::string
  readable_number(const double number, const unsigned int digits);

  /**
   * Rows under titles, for CSV with all digits, and for Markdown and LaTeX
   * with those that a reader wants.
   */
  class DataTable
  {
  public:
    /// @p digits: of its numbers, in Markdown and LaTeX; without any they have
    /// as many as read back as the number, as in CSV.
    void
    add_column(const std::string &title, const unsigned int digits = 0);

    /// As many cells as there are columns.
    void
    add_row(const std::vector<Cell> &cells);

    /// The three write_*() throw std::runtime_error naming the file if it
    /// cannot be written.
    void
    write_csv(const std::string &file_name) const;

    void
    write_markdown(const std::string &file_name) const;

    void
    write_latex(const std::string &file_name) const;

    std::string
    markdown() const;

  private:
    std::vector<std::string>       titles;
    std::vector<unsigned int>      digits;
    std::vector<std::vector<Cell>> rows;
  };



  /// A CSV file: a line of titles, then rows with as many entries, whose last
  /// ones are empty where a line is shorter. Lines that begin with '#' and
  /// empty ones are skipped.
  struct CsvFile
  {
    std::vector<std::string>              titles;
    std::vector<std::vector<std::string>> rows;

    /// The number of a column, none if there is no such title.
    std::optional<std::size_t>
    column(const std::string &title) const;
  };

  /// Throws std::runtime_error naming the file if it cannot be read or a line
  /// has more entries than there are titles.
  CsvFile
  read_csv(const std::string &file_name);
} // namespace Debond

#endif
