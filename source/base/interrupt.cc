// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/interrupt.h>
#include <debond/base/processes.h>

#include <atomic>

namespace Debond
{
  namespace
  {
    std::atomic<bool> signal_arrived(false);
    std::atomic<bool> is_known(false); ///< to all ranks

    unsigned int n_guards = 0;

    extern "C" void
    debond_record_signal(int /*number*/)
    {
      signal_arrived = true;
    }
  } // namespace



  InterruptGuard::InterruptGuard()
  {
    // What arrived under an outer guard, between two solves, is not lost.
    if (n_guards++ > 0)
      return;

    struct sigaction action = {};
    action.sa_handler       = debond_record_signal;
    action.sa_flags         = SA_RESETHAND | SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, &previous_int);
    sigaction(SIGTERM, &action, &previous_term);
  }



  InterruptGuard::~InterruptGuard()
  {
    if (--n_guards > 0)
      return;
    sigaction(SIGINT, &previous_int, nullptr);
    sigaction(SIGTERM, &previous_term, nullptr);
    signal_arrived = false;
    is_known       = false;
  }



  bool
  InterruptGuard::arrived()
  {
    return signal_arrived;
  }



  bool
  InterruptGuard::noticed()
  {
    return n_started_ranks() == 1 ? signal_arrived : is_known;
  }



  bool
  InterruptGuard::requested()
  {
    is_known = any_rank(signal_arrived);
    return is_known;
  }
} // namespace Debond
