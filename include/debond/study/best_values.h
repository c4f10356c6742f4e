// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_study_best_values_h
#define debond_study_best_values_h

#include <debond/study/columns.h>
#include <debond/study/study_parameters.h>

#include <optional>
#include <string>
#include <vector>

namespace Debond
{
  /// For one value of the first sweep and one method, the value of the second
  /// sweep with the fewest iterations.
  struct BestRow
  {
    std::string value;  ///< of the first sweep
    std::string method; ///< empty if only one is used
    double      cell_edge;
    BestValue   best;
  };

  /// Of a study with two sweeps, the second one over numbers; empty for
  /// others. Rows for which all cases failed are left out.
  std::vector<BestRow>
  find_best_values(const StudyParameters       &study,
                   const std::vector<StudyRow> &rows);

  /// The best value as a power of the edge h of the cells, without those at an
  /// end of the values; none if h is the same for all.
  std::optional<PowerLaw>
  fit_best_values(const std::vector<BestRow> &rows);
} // namespace Debond

#endif
