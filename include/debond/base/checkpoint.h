// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_checkpoint_h
#define debond_base_checkpoint_h

#include <debond/base/checkpoints.h>

#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace Debond
{
  /// What a checkpoint says of the run that it is of, before its state.
  struct CheckpointOrigin
  {
    /// What the run depends on, by name.
    std::map<std::string, std::string> settings;

    std::string  revision; ///< of the program
    unsigned int iterations;
  };

  /**
   * Writes a checkpoint: a line with the version of its format, its length
   * and the checksum of what follows, then the origin and what @p save writes.
   * Replaces an earlier one only when all of it is on the disk. Throws
   * std::runtime_error naming the file if it cannot be written.
   */
  void
  write_checkpoint(const std::string                              &file_name,
                   const CheckpointOrigin                         &origin,
                   const std::function<void(OutArchive &archive)> &save);



  /// A checkpoint that is whole.
  class CheckpointReader
  {
  public:
    /// Throws std::invalid_argument, naming the file and the reason, if it
    /// cannot be read, is none, has another format, or is truncated or damaged.
    explicit CheckpointReader(const std::string &file_name);

    ~CheckpointReader();

    const CheckpointOrigin &
    origin() const;

    /// What save() has written.
    InArchive &
    state();

  private:
    std::ifstream              file;
    std::unique_ptr<InArchive> archive;
    CheckpointOrigin           read_origin;
  };
} // namespace Debond

#endif
