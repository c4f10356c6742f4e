// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_study_study_report_h
#define debond_study_study_report_h

#include <debond/output/gnuplot.h>
#include <debond/study/best_values.h>
#include <debond/study/columns.h>
#include <debond/study/reference.h>
#include <debond/study/study_parameters.h>

#include <optional>
#include <string>
#include <vector>

namespace Debond
{
  /// A row for each case: the sweeps, the columns that the study asks for, and
  /// beside them those of the reference.
  DataTable
  make_table(const StudyParameters          &study,
             const std::vector<StudyRow>    &rows,
             const std::optional<Reference> &reference);

  /// The best values of the second sweep.
  DataTable
  make_best_table(const StudyParameters      &study,
                  const std::vector<BestRow> &best);

  /// Writes fields.pvd and contact.pvd, whose time is the number of the case.
  /// Throws std::runtime_error naming the file that cannot be written.
  void
  write_series(const StudyParameters &study, const std::vector<StudyRow> &rows);

  /// The page that shows all of it. @p notes are paragraphs at its end.
  /// Throws std::runtime_error naming the file that cannot be written.
  void
  write_index(const StudyParameters          &study,
              const DataTable                &table,
              const std::vector<BestRow>     &best,
              const std::vector<Plot>        &plots,
              const std::vector<std::string> &notes);
} // namespace Debond

#endif
