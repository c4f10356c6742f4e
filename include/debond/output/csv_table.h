// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_csv_table_h
#define debond_output_csv_table_h

#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace Debond
{
  /// Texts, counts and numbers under titles, as CSV. Numbers have as many
  /// digits as read back as the number.
  class CsvTable
  {
  public:
    using Row = std::vector<std::string>;

    explicit CsvTable(const Row &titles);

    static std::string
    cell(const std::string &text);

    static std::string
    cell(const double number);

    /// Empty without a number.
    static std::string
    cell(const std::optional<double> &number);

    template <typename T>
    static std::enable_if_t<std::is_integral_v<T>, std::string>
    cell(const T count)
    {
      return std::to_string(count);
    }

    /// As many cells as there are titles, but for empty ones at the end.
    template <typename... Cells>
    void
    add_row(const Cells &...cells)
    {
      add_row(Row{cell(cells)...});
    }

    void
    add_row(const Row &cells);

    /// Throws std::runtime_error naming the file if it cannot be written.
    void
    write(const std::string &file_name) const;

  private:
    std::vector<Row> rows; ///< the titles first
  };
} // namespace Debond

#endif
