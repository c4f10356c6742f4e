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
   * ... A line has iteration, J, v_k, bundle size and step kind; a line with
   * these titles comes first.
   */
  class Progress
  {
  public:
    /// Keeps a reference to the stream.
    Progress(std::ostream &stream, const bool is_terminal);

    void
    report(const BundleIteration &iteration);

    /// Prints the last iteration, if that was not done yet, and ends the line.
    void
    finish();

  private:
    std::ostream   &out;
    bool            terminal;
    bool            header_printed = false;
    bool            pending        = false; ///< last is not a finished line
    double          last_print_seconds;
    unsigned int    next_logged = 1;
    BundleIteration last        = {};
  };
} // namespace Debond

#endif
