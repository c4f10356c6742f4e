// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_study_columns_h
#define debond_study_columns_h

#include <debond/study/case_result.h>
#include <debond/study/convergence.h>
#include <debond/study/data_table.h>

#include <optional>
#include <string>

namespace Debond
{
  /// A case and what is known about it.
  struct StudyRow
  {
    const Case                    *one;
    CaseResult                     result;
    std::optional<double>          minimum; ///< J_min of the same problem
    std::optional<ConvergenceRate> rate;
  };



  /// What a table has for each case.
  class Column
  {
  public:
    /// Throws std::invalid_argument, naming the columns that there are.
    static Column
    parse(const std::string &name);

    /// The columns that there are, in words.
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

    /// Of the number in summary.json; empty if the column is none.
    const std::string &
    json_pointer() const;

  private:
    enum class Kind
    {
      status,
      count,
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
