// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_program_command_line_h
#define debond_program_command_line_h

#include <debond/program/exit_code.h>

#include <functional>
#include <string>
#include <vector>

namespace Debond
{
  /// An option "--name FILE" that does something else than solve a scene.
  struct FileCommand
  {
    std::string                                  name;
    std::string                                  documentation;
    std::function<ExitCode(const std::string &)> execute;
  };

  /// Does what the command line asks for. Bad input is reported on std::cerr,
  /// a line for each error; faults of the program are thrown. The @p commands
  /// are of rooms that this one does not know.
  ExitCode
  execute_command_line(const int                       argc,
                       const char *const               argv[],
                       const std::vector<FileCommand> &commands);
} // namespace Debond

#endif
