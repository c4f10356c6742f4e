// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_study_columns_h
#define debond_study_columns_h

#include <debond/base/data_table.h>
#include <debond/study/case_result.h>
#include <debond/study/convergence.h>

#include <optional>
#include <string>

namespace Debond
{
  /// A case, its result and what was computed from it: what a column
  /// takes its cell from.
  struct StudyRow
  {
    const Case                    *one;
    CaseResult                     result;
    std::optional<double>          minimum; ///< J_min of the same problem
    std::optional<ConvergenceRate> rate;
  };



  /// A column of a study's table: what to read or compute for a case, its
  /// title and the digits to print.
  class Column
  {
  public:
    /// The column of the name @p name in `Study/Columns`: a fixed one, such as
    /// "error at 1400", or "TITLE = /key/in/summary.json". Throws
    /// std::invalid_argument, naming the fixed ones, if it is neither.
    static Column
    parse(const std::string &name);

    /// The names of the fixed columns, for documentation and messages.
    static std::string
    documentation();

    /// Empty if the case has no such result.
    Cell
    value(const StudyRow &row) const;

    const std::string &
    title() const;

    unsigned int
    digits() const;

    /// Whether the column is a relative error of J.
    bool
    is_error() const;

    /// Whether the column needs the exact minimum.
    bool
    needs_minimum() const;

    /// The JSON pointer of the number in summary.json that the column shows;
    /// empty for a fixed column.
    const std::string &
    json_pointer() const;

  private:
    enum class Kind
    {
      status,
      number,
      functional,
      minimum,
      error,
      rate,
      window
    };

    explicit Column(const std::string &title);

    std::string  heading;
    Kind         kind = Kind::status;
    std::string  pointer;       ///< into summary.json
    unsigned int iteration = 0; ///< of "at K"; 0 for the end
  };
} // namespace Debond

#endif
