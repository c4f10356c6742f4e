// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/base/text.h>
#include <debond/program/session.h>

#include <filesystem>

namespace Debond
{
  std::string
  output_path(const std::string &directory, const std::string &name)
  {
    return (std::filesystem::path(directory) / name).string();
  }



  std::string
  write_effective_scene(const std::string &scene, const std::string &directory)
  {
    const std::string path = output_path(directory, "parameters.prm");
    write_atomically(path, [&](std::ostream &file) { file << scene; });
    return path;
  }



  template <int dim>
  ExitCode
  conclude(const RunResult<dim> &result, const std::string &output_error)
  {
    const bool interrupted = result.solve.minimum.interrupted;
    if (!result.is_answer())
      print_error("NOT CONVERGED (" + result.status + "): " + result.message);
    else if (interrupted)
      print_error("the search or the proof was interrupted; the result is "
                  "what it had found");
    if (!output_error.empty())
      {
        print_error(output_error);
        return ExitCode::output_not_saved;
      }
    if (result.solve.status == SolverStatus::interrupted ||
        (result.is_success() && interrupted))
      return ExitCode::interrupted;
    return result.is_answer() ? ExitCode::success : ExitCode::not_converged;
  }



  template decltype(conclude<2>) conclude<2>;
  template decltype(conclude<3>) conclude<3>;
} // namespace Debond
