// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/run_watch.h>

#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <iostream>
#include <mutex>

namespace Debond
{
  namespace
  {
    /// Of both threads; the mutex guards the rest.
    struct
    {
      std::mutex              mutex;
      std::condition_variable end;
      bool                    has_ended = false;
      Stage                  *innermost = nullptr;
    } watched;
  } // namespace

  std::atomic<bool> RunWatch::is_quiet(false), RunWatch::has_result(false);



  Stage::Stage(const std::string &stage_name)
    : name(stage_name)
    , begin(std::chrono::steady_clock::now())
    , outer(watched.innermost)
  {
    const std::lock_guard<std::mutex> lock(watched.mutex);
    watched.innermost = this;
  }



  Stage::~Stage()
  {
    const std::lock_guard<std::mutex> lock(watched.mutex);
    watched.innermost = outer;
  }



  RunWatch::RunWatch(std::ostream &stream, const int code)
    : out(stream)
    , exit_code(code)
  {
    watched.has_ended = false;
    thread            = std::thread([this]() {
      constexpr std::chrono::milliseconds between_looks(100);
      std::unique_lock<std::mutex>        lock(watched.mutex);
      while (!watched.end.wait_for(lock, between_looks, []() {
        return watched.has_ended;
      }))
        look();
    });
  }



  RunWatch::~RunWatch()
  {
    {
      const std::lock_guard<std::mutex> lock(watched.mutex);
      watched.has_ended = true;
    }
    watched.end.notify_all();
    thread.join();
  }



  void
  RunWatch::look()
  {
    for (Stage *stage = watched.innermost; stage; stage = stage->outer)
      {
        const std::chrono::duration<double> seconds(stage->next_line);
        if (std::chrono::steady_clock::now() - stage->begin < seconds)
          continue;
        if (!is_quiet)
          out << "  " + stage->name + ", " +
                   std::to_string(std::lround(stage->next_line)) + " s\n"
              << std::flush;
        stage->next_line *= 2.;
        break;
      }

    if (!guard.arrived())
      return;
    const std::string stage =
      watched.innermost != nullptr ? " (" + watched.innermost->name + ")" : "";
    if (!has_result)
      {
        std::cerr << "debond: interrupted before there was a result" + stage +
                       "\n";
        // The objects of the other thread are not this one's to destroy.
        out.flush();
        std::quick_exit(exit_code);
      }
    // Most runs have ended by then.
    if (++n_looks == 10)
      std::cerr << "debond: interrupted; what is being done" + stage +
                     " is finished first, and a second signal ends the program "
                     "at once\n";
  }
} // namespace Debond
