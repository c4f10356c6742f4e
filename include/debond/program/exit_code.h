// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_program_exit_code_h
#define debond_program_exit_code_h

namespace Debond
{
  /// The code that the program returns to the shell; a public interface that
  /// --help documents.
  enum class ExitCode
  {
    success        = 0,
    internal_error = 1,  ///< a fault of the program
    bad_input      = 2,  ///< command line or scene; mostly nothing was written
    not_converged  = 3,  ///< the stop criterion or the verification was not met
    interrupted    = 4,  ///< by SIGINT or SIGTERM, the last iterate is written
    output_not_saved = 5 ///< a directory or a file could not be written
  };
} // namespace Debond

#endif
