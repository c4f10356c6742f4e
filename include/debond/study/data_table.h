// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_study_data_table_h
#define debond_study_data_table_h

#include <string>
#include <variant>
#include <vector>

namespace Debond
{
  /// What a cell of a table has: nothing, words, a count or a number.
  using Cell = std::variant<std::monostate, std::string, long, double>;

  /**
   * Rows under titles, for CSV with all digits, and for Markdown and LaTeX
   * with those that a reader wants.
   */
  class DataTable
  {
  public:
    /// @p digits: of its numbers, in Markdown and LaTeX.
    void
    add_column(const std::string &title, const unsigned int digits);

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
} // namespace Debond

#endif
