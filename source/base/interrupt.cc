// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/interrupt.h>

namespace Debond
{
  namespace
  {
    volatile std::sig_atomic_t signal_arrived = 0;

    unsigned int n_guards = 0;

    extern "C" void
    debond_record_signal(int /*number*/)
    {
      signal_arrived = 1;
    }
  } // namespace



  InterruptGuard::InterruptGuard()
  {
    // What arrived under an outer guard, between two solves, is not lost.
    if (n_guards++ > 0)
      return;
    signal_arrived = 0;

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
  }



  bool
  InterruptGuard::requested() const
  {
    return signal_arrived != 0;
  }



  void
  InterruptGuard::leave_to_parent()
  {
    n_guards = 0;
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
  }
} // namespace Debond
