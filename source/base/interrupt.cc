// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/interrupt.h>

#include <atomic>

namespace Debond
{
  namespace
  {
    std::atomic<bool> signal_arrived(false);

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
  }



  bool
  InterruptGuard::requested()
  {
    return signal_arrived;
  }
} // namespace Debond
