// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_program_report_errors_h
#define debond_program_report_errors_h

#include <debond/program/exit_code.h>

#include <functional>
#include <string>

namespace Debond
{
  /// Does @p action and returns its exit code. What it throws is reported on
  /// std::cerr, in lines that start with @p name: each error of bad input, too
  /// little memory, and faults of the program.
  ExitCode
  report_errors(const std::string               &name,
                const std::function<ExitCode()> &action);
} // namespace Debond

#endif
