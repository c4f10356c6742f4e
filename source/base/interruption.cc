// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/interruption.h>
#include <debond/base/processes.h>

#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <iostream>
#include <mutex>

namespace Debond
{
  namespace
  {
    // A process has one handler of signals, and so one state of them.
    std::atomic<bool> signal_arrived(false);
    std::atomic<bool> is_known(false); ///< to all ranks
    std::atomic<bool> is_asked(false); ///< by what iterates

    extern "C" void
    debond_record_signal(int /*number*/)
    {
      signal_arrived = true;
    }



    /// Of both threads; the mutex guards the rest.
    struct
    {
      std::mutex              mutex;
      std::condition_variable end;
      bool                    has_ended = false;
      Stage                  *innermost = nullptr;
    } watched;
  } // namespace



  bool
  Interruption::requested() const
  {
    is_asked = true;
    is_known = any_rank(signal_arrived);
    return is_known;
  }



  bool
  Interruption::noticed()
  {
    return n_started_ranks() == 1 ? signal_arrived : is_known;
  }



  const Interruption &
  Interruption::by_signal()
  {
    static const Interruption interruption;
    return interruption;
  }



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



  SignalWatch::SignalWatch(std::ostream &stream, const int code)
    : out(stream)
    , exit_code(code)
  {
    signal_arrived          = false;
    is_known                = false;
    struct sigaction action = {};
    action.sa_handler       = debond_record_signal;
    action.sa_flags         = SA_RESETHAND | SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, &previous_int);
    sigaction(SIGTERM, &action, &previous_term);

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



  SignalWatch::~SignalWatch()
  {
    {
      const std::lock_guard<std::mutex> lock(watched.mutex);
      watched.has_ended = true;
    }
    watched.end.notify_all();
    thread.join();
    sigaction(SIGINT, &previous_int, nullptr);
    sigaction(SIGTERM, &previous_term, nullptr);
  }



  void
  SignalWatch::begin_run(const bool quiet)
  {
    is_asked = false;
    is_quiet = quiet;
  }



  void
  SignalWatch::look()
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

    if (!signal_arrived)
      return;
    const std::string stage =
      watched.innermost != nullptr ? " (" + watched.innermost->name + ")" : "";
    if (!is_asked)
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
