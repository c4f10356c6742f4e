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
    // A process has one handler of signals, and therefore one state of them.
    // They are atomic because the handler, the watching thread and the
    // iterations use them without a lock.
    std::atomic<bool> signal_arrived(false);
    std::atomic<bool> is_known(false); ///< to all ranks
    std::atomic<bool> is_asked(false); ///< by what iterates

    extern "C" void
    debond_record_signal(int /*number*/)
    {
      signal_arrived = true;
    }



    /// What the thread of the run and the watching one share. The mutex guards
    /// all other members.
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
    // The maximum over the ranks is a collective operation: all ranks end their
    // iterations at the same place, even if the signal has reached only one of
    // them. A question also shows that iterations have begun, which can end
    // with a result; from now on a signal does not end the program by itself.
    is_asked = true;
    is_known = any_rank(signal_arrived);
    return is_known;
  }



  bool
  Interruption::noticed()
  {
    // On several ranks only what all of them have agreed on counts, since loops
    // of different lengths on different ranks would make the results differ.
    // One rank need not wait for such an agreement.
    return n_started_ranks() == 1 ? signal_arrived : is_known;
  }



  const Interruption &
  Interruption::by_signal()
  {
    // It has no state of its own: whether a signal has arrived is known to the
    // whole file.
    static const Interruption interruption;
    return interruption;
  }



  Stage::Stage(const std::string &stage_name)
    : name(stage_name)
    , begin(std::chrono::steady_clock::now())
    , outer(watched.innermost)
  {
    // The stages form a list from the innermost one outwards, whose links are
    // on the stack of the run. The watching thread walks along it, so that it
    // changes under the mutex only.
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
    // SA_RESETHAND restores the default action when the first signal arrives,
    // so that a second one ends the program at once wherever it is. SA_RESTART
    // continues system calls that the signal interrupts, such as those of the
    // output.
    signal_arrived          = false;
    is_known                = false;
    struct sigaction action = {};
    action.sa_handler       = debond_record_signal;
    action.sa_flags         = SA_RESETHAND | SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, &previous_int);
    sigaction(SIGTERM, &action, &previous_term);

    // A library may compute for minutes without asking for an interruption. A
    // thread of its own notices signals there too, and says how long a stage
    // takes. It looks ten times a second and holds the mutex while it does.
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
    // The innermost stage whose time has come prints a line. The times are
    // doubled after each line, so that the number of lines grows with the
    // logarithm of the duration, and there is at most one line at a look.
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
        // The thread of the run still uses its objects, therefore no destructor
        // may run. std::quick_exit() calls the handlers registered for it
        // alone, such as the one that removes the lock of the output directory.
        out.flush();
        std::quick_exit(exit_code);
      }
    // This is one second after the signal. Most runs have ended by then, and a
    // message would only disturb their output.
    if (++n_looks == 10)
      std::cerr << "debond: interrupted; what is being done" + stage +
                     " is finished first, and a second signal ends the program "
                     "at once\n";
  }
} // namespace Debond
