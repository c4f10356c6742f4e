// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_study_plots_h
#define debond_study_plots_h

#include <debond/output/gnuplot.h>
#include <debond/study/best_values.h>
#include <debond/study/columns.h>
#include <debond/study/study_parameters.h>

#include <string>
#include <vector>

namespace Debond
{
  /// The kinds of plots that there are, in words.
  std::string
  plot_documentation();

  /// Why a study cannot have a plot; empty if it can.
  std::string
  why_no_plot(const std::string &kind, const StudyParameters &study);

  /// Whether a plot needs the exact minima.
  bool
  plot_needs_minimum(const std::string &kind);

  /// The plots that the study asks for.
  std::vector<Plot>
  make_plots(const StudyParameters       &study,
             const std::vector<StudyRow> &rows,
             const std::vector<BestRow>  &best);
} // namespace Debond

#endif
