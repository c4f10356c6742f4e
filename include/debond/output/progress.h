// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_progress_h
#define debond_output_progress_h

#include <debond/optimization/proximal_bundle.h>

#include <ostream>

namespace Debond
{
  /**
   * Prints iterations: on a terminal one line that is rewritten a few times a
   * second, in a log a line at iterations 1, 2, 5, 10, 20, 50, 100, 200, 500,
   * ... A line has iteration, J, v_k, bundle size and step kind.
   */
  class Progress
  {
  public:
    /// @p terminal: whether @p out is a terminal.
    Progress(std::ostream &out, const bool terminal);

    void
    report(const BundleIteration &iteration);

    /// Ends the line of a terminal and prints the last iteration in a log.
    void
    finish();

  private:
    std::ostream &  out;
    bool            terminal;
    bool            pending = false;
    double          last_print_seconds;
    unsigned int    next_logged = 1;
    BundleIteration last        = {};
  };
} // namespace Debond

#endif
