// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_study_command_line_h
#define debond_study_command_line_h

#include <debond/program/exit_code.h>

namespace Debond
{
  /// Whether the command line begins with --study.
  bool
  is_study_command_line(const int argc, const char *const argv[]);

  /// Does what "debond --study ..." asks for. Errors are reported on
  /// std::cerr.
  ExitCode
  execute_study_command_line(const int argc, const char *const argv[]);
} // namespace Debond

#endif
