// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_report_h
#define debond_output_report_h

#include <debond/check/verification.h>
#include <debond/input/parameters.h>
#include <debond/output/summary.h>

#include <ostream>
#include <string>
#include <vector>

namespace Debond
{
  /// The log's head: program, scene, problem size and method.
  void
  report_problem(const Parameters  &parameters,
                 const Summary     &summary,
                 const std::string &reason,
                 std::ostream      &out);

  /// The log's end: status, result, verification and times.
  template <int dim>
  void
  report_result(const Parameters        &parameters,
                const Summary           &summary,
                const Verification<dim> &verification,
                std::ostream            &out);

  /// The steps at which most bonds break and close, and how far the path is
  /// from the global branch.
  void
  report_load_path(const LoadPathTotals &path, std::ostream &out);

  /// The paths of the files written.
  void
  report_files(const std::vector<std::string> &files, std::ostream &out);
} // namespace Debond

#endif
