// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_program_command_line_h
#define debond_program_command_line_h

#include <debond/program/companion.h>
#include <debond/program/exit_code.h>

namespace Debond
{
  /// Does what the command line asks for, with a companion for each scene.
  /// Errors are reported on std::cerr.
  ExitCode
  execute_command_line(const int            argc,
                       const char *const    argv[],
                       const MakeCompanion &make_companion);
} // namespace Debond

#endif
