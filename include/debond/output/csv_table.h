// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_csv_table_h
#define debond_output_csv_table_h

#include <debond/base/text.h>

#include <functional>
#include <optional>
#include <type_traits>

namespace Debond
{
  /// A table of texts, counts and numbers under titles, as CSV. Numbers have as
  /// many digits as read back as the number.
  class CsvTable
  {
  public:
    /// Adds a column with the @p value, a member or a function, of each item;
    /// all columns have as many items.
    template <typename Item, typename Value>
    void
    add(const std::string       &title,
        const std::vector<Item> &items,
        const Value             &value)
    {
      rows.resize(1 + items.size());
      rows[0].push_back(cell(title));
      for (std::size_t i = 0; i < items.size(); ++i)
        rows[1 + i].push_back(cell(std::invoke(value, items[i])));
    }

    /// Adds a last row, whose last cells may be left out.
    template <typename... Cells>
    void
    add_row(const Cells &...cells)
    {
      rows.push_back({cell(cells)...});
      rows.back().resize(rows[0].size());
    }

    /// A cell with the title of its column.
    using Cell = std::pair<std::string, std::string>;

    template <typename T>
    static Cell
    titled(const std::string &title, const T &value)
    {
      return {title, cell(value)};
    }

    /// Adds a row. All rows have the same titles, in the same order.
    void
    add_row(const std::vector<Cell> &cells);

    /// Writes the file. Throws std::runtime_error naming it if it cannot be
    /// written.
    void
    write(const std::string &file_name) const;

  private:
    static std::string
    cell(const std::string &text);

    template <typename T>
    static std::enable_if_t<std::is_arithmetic_v<T>, std::string>
    cell(const T number)
    {
      if constexpr (std::is_integral_v<T>)
        return std::to_string(number);
      else
        return shortest_text(number);
    }

    /// Empty without a value.
    template <typename T>
    static std::string
    cell(const std::optional<T> &value)
    {
      return value ? cell(*value) : "";
    }

    std::vector<std::vector<std::string>> rows; ///< the titles first
  };
} // namespace Debond

#endif
