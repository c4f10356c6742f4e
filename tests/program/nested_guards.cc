// SPDX-License-Identifier: LGPL-2.1-or-later
// A signal that arrives between two solves, when only the guard of the whole
// run is there, is seen by the guard of the next solve.

#include <debond/base/interrupt.h>

#include "../check.h"

using namespace Debond;

namespace
{
  bool
  is_ignored(const int number)
  {
    struct sigaction action;
    sigaction(number, nullptr, &action);
    return action.sa_handler == SIG_IGN;
  }
} // namespace



int
main()
{
  // For a signal that no guard has seen must not end the test.
  std::signal(SIGINT, SIG_IGN);
  for (const int number : {SIGINT, SIGTERM})
    {
      const InterruptGuard whole;
      {
        const InterruptGuard first_solve;
        check("nothing has arrived", !first_solve.requested());
      }
      std::raise(number);
      check("the outer guard knows", whole.requested());
      const InterruptGuard second_solve;
      check("the inner guard knows", second_solve.requested());
    }
  check("the action of before is back", is_ignored(SIGINT));
  const InterruptGuard next_run;
  check("the next run begins anew", !next_run.requested());
}
