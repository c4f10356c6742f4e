// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_run_watch_h
#define debond_base_run_watch_h

#include <debond/base/interrupt.h>

#include <atomic>
#include <chrono>
#include <ostream>
#include <string>
#include <thread>

namespace Debond
{
  /// What a run does while an object of this class exists.
  class Stage
  {
  public:
    explicit Stage(const std::string &name);

    ~Stage();

  private:
    friend class RunWatch;

    const std::string                           name;
    const std::chrono::steady_clock::time_point begin;
    double                                      next_line = 2.; ///< in seconds
    Stage *const                                outer;
  };



  /// A thread that says in what stage the run is, after 2, 4, 8, ... s of it,
  /// and hears signals also where a library works. There is one at a time.
  class RunWatch
  {
  public:
    /// Keeps a reference to @p out; @p exit_code is for a run that is ended.
    RunWatch(std::ostream &out, const int exit_code);

    ~RunWatch();

    /// Without lines, since they depend on the machine.
    static std::atomic<bool> is_quiet;

    /// As long as there is none a signal ends the program at once.
    static std::atomic<bool> has_result;

  private:
    void
    look();

    std::ostream        &out;
    const int            exit_code;
    const InterruptGuard guard;
    int                  n_looks = 0; ///< since the signal
    std::thread          thread;
  };
} // namespace Debond

#endif
