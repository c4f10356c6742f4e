// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_child_process_h
#define debond_base_child_process_h

#include <sys/types.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace Debond
{
  /**
   * A program that runs beside this one, with one thread, or a copy of this
   * one, which saves the time that loading it takes; with its output in a file.
   * It is killed when the object ends, and by the system if this program is
   * killed.
   */
  class ChildProcess
  {
  public:
    /// Throws std::runtime_error if the process cannot be made. A program that
    /// does not exist ends at once with exit code 127.
    ChildProcess(const std::vector<std::string> &command,
                 const std::string              &log_file,
                 const std::string              &working_directory = "");

    /// A copy of this process as it is now, which ends with what @p work
    /// returns as exit code; signals end it unless @p work asks for them. Work
    /// must not throw. Of this process's threads only the one that calls is
    /// copied: others must not hold what @p work needs. Throws
    /// std::runtime_error if the process cannot be made.
    ChildProcess(const std::function<int()> &work, const std::string &log_file);

    ~ChildProcess();

    ChildProcess(const ChildProcess &) = delete;

    /// How it ended, if it did: "" for exit code 0, or "exit code 3", or
    /// "killed by signal 9 (Killed)".
    const std::optional<std::string> &
    poll();

    const std::string &
    wait();

    void
    send_signal(const int number) const;

  private:
    void
    record(const int wait_status);

    pid_t                      process;
    std::optional<std::string> ending;
  };
} // namespace Debond

#endif
