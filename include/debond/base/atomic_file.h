// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_atomic_file_h
#define debond_base_atomic_file_h

#include <fstream>
#include <functional>
#include <ostream>
#include <string>

namespace Debond
{
  /// Opens a file for reading; a stream that has failed if there is none, or
  /// if it is a device, a pipe or a folder, which need not end.
  std::ifstream
  open_plain_file(const std::string &file_name);

  /**
   * Writes a file in one piece: @p write fills "<file_name>.partial", which is
   * renamed only when all of it is on the disk, so that neither an error nor
   * an interruption leaves half a file under the final name. An existing file
   * is replaced.
   *
   * Throws std::runtime_error with the file and the system's reason if it
   * cannot be written; exceptions of @p write pass through. To be called by all
   * ranks, of which the first one writes.
   */
  void
  write_atomically(const std::string                         &file_name,
                   const std::function<void(std::ostream &)> &write);

  /// Writes a file as write_atomically() does, by this rank alone.
  void
  write_own_file(const std::string                         &file_name,
                 const std::function<void(std::ostream &)> &write);
} // namespace Debond

#endif
