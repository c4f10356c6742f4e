// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_application_report_h
#define debond_application_report_h

#include <debond/application/parameters.h>
#include <debond/output/summary.h>
#include <debond/output/verification.h>

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

  /// The paths of the files written.
  void
  report_files(const std::vector<std::string> &files, std::ostream &out);
} // namespace Debond

#endif
