// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_output_file_h
#define debond_output_output_file_h

#include <functional>
#include <string>
#include <vector>

namespace Debond
{
  /// A file that a run may write into its directory.
  struct OutputFile
  {
    std::string name;

    /// Whether the scene asks for it and the run has it.
    std::function<bool()> is_wanted;

    /// Gets the path. Throws std::runtime_error naming what cannot be written.
    std::function<void(const std::string &)> write;
  };

  /// Removes what an earlier run left: it must not stand beside new results.
  void
  remove_files(const std::vector<OutputFile> &files,
               const std::string             &directory);

  /// Writes those that are wanted and returns the paths. Throws
  /// std::runtime_error as their functions do.
  std::vector<std::string>
  write_files(const std::vector<OutputFile> &files,
              const std::string             &directory);
} // namespace Debond

#endif
