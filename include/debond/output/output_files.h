// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_output_files_h
#define debond_output_output_files_h

#include <debond/input/output_parameters.h>
#include <debond/output/run_result.h>

namespace Debond
{
  /// A file that a run may write into its directory.
  struct OutputFile
  {
    std::string name;

    /// Says whether the scene asks for the file and the run has it.
    std::function<bool()> is_wanted;

    /// Writes it at the path that it gets. Throws std::runtime_error naming
    /// what cannot be written.
    std::function<void(const std::string &)> write;
  };

  /// Removes the files that an earlier run left: they must not stand beside new
  /// results.
  void
  remove_files(const std::vector<OutputFile> &files,
               const std::string             &directory);

  /// Writes those that are wanted and adds their paths to @p written. Throws
  /// std::runtime_error as their functions do.
  void
  write_files(const std::vector<OutputFile> &files,
              const std::string             &directory,
              std::vector<std::string>      &written);



  /**
   * The files of a run but those that are there before the end of the solve
   * (parameters.prm), those of a load path (LoadPathOutput) and
   * summary.json. Keeps references: the @p result need not be there yet.
   */
  template <int dim>
  std::vector<OutputFile>
  output_files(const OutputParameters &output,
               const Scene<dim>       &scene,
               const RunResult<dim>   &result);
} // namespace Debond

#endif
