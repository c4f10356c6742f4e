// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_data_table_h
#define debond_base_data_table_h

#include <string>
#include <variant>
#include <vector>

namespace Debond
{
  /// What a cell of a table has: nothing, words, a count or a number.
  using Cell = std::variant<std::monostate, std::string, long, double>;

  /// Rows under titles, written as CSV; numbers have as many digits as read
  /// back as the number.
  class DataTable
  {
  public:
    void
    add_column(const std::string &title);

    /// As many cells as there are columns.
    void
    add_row(const std::vector<Cell> &cells);

    /// Throws std::runtime_error naming the file if it cannot be written.
    void
    write_csv(const std::string &file_name) const;

  private:
    std::vector<std::string>       titles;
    std::vector<std::vector<Cell>> rows;
  };
} // namespace Debond

#endif
