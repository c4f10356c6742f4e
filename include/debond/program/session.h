// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_program_session_h
#define debond_program_session_h

#include <debond/output/output_files.h>
#include <debond/output/record.h>
#include <debond/output/run_result.h>
#include <debond/program/exit_code.h>

#include <string>
#include <vector>

namespace Debond
{
  /// The path of a file in the output directory.
  std::string
  output_path(const std::string &directory, const std::string &name);

  /// Writes the scene with all entries that it leaves to their defaults;
  /// returns the path.
  std::string
  write_effective_scene(const std::string &scene, const std::string &directory);

  /// Says on std::cerr what did not go well, and returns how the program ends.
  template <int dim>
  ExitCode
  conclude(const RunResult<dim> &result, const std::string &output_error);
} // namespace Debond

#endif
