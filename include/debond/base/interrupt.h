// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_interrupt_h
#define debond_base_interrupt_h

#include <csignal>

namespace Debond
{
  /**
   * While an object of this class exists, the first SIGINT or SIGTERM is only
   * recorded, so that a solver can stop after its current iteration; a second
   * one ends the program at once. Guards may be nested: a signal that arrived
   * under an outer one has arrived for the inner ones as well.
   */
  class InterruptGuard
  {
  public:
    InterruptGuard();

    ~InterruptGuard();

    InterruptGuard(const InterruptGuard &) = delete;

    /// Whether a signal has arrived under a guard, at any of the ranks that
    /// were started together: all of them have to ask. Loops ask it before each
    /// piece of work that can take a good part of a second.
    static bool
    requested();

    /// The same for loops of which each rank, or each thread, has its own: on
    /// several ranks what requested() has last said.
    static bool
    noticed();

    /// Whether this process has had a signal.
    static bool
    arrived();

  private:
    struct sigaction previous_int;
    struct sigaction previous_term;
  };
} // namespace Debond

#endif
