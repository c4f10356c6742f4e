// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_study_reference_h
#define debond_study_reference_h

#include <debond/base/data_table.h>
#include <debond/study/study_parameters.h>

#include <map>
#include <string>
#include <vector>

namespace Debond
{
  /// Printed results from a CSV file.
  class Reference
  {
  public:
    /// Throws BadInput if the file cannot be read, has not the columns that
    /// @p parameters name, or no row with what they ask for.
    explicit Reference(const ReferenceParameters &parameters);

    /// What the file has for a value of the first sweep in the column beside
    /// that of the study: a number, or nothing. If @p as_error, its distance
    /// from the minimum of the reference.
    Cell
    value(const std::string &sweep_value,
          const std::string &study_column,
          const bool         as_error) const;

  private:
    using Row = std::map<std::string, std::string>;

    ReferenceParameters parameters;
    std::vector<Row>    rows;
  };
} // namespace Debond

#endif
