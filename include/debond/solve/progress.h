// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_progress_h
#define debond_solve_progress_h

#include <debond/optimization/bundle/proximal_bundle.h>
#include <debond/optimization/majorise/majorise_minimise.h>

#include <ostream>
#include <string>

namespace Debond
{
  /**
   * Prints iterations: on a terminal one line that is rewritten a few times a
   * second, in a log a line at iterations 1, 2, 5, 10, 20, 50, 100, 200, 500,
   * ... A line with titles comes first.
   */
  class Progress
  {
  public:
    /// Keeps a reference to the stream.
    Progress(std::ostream &stream, const bool is_terminal)
      : out(stream)
      , terminal(is_terminal)
      , last_print_seconds(-std::numeric_limits<double>::infinity())
    {}

    /// Iteration, J, v_k, bundle size and step kind.
    void
    report(const BundleIteration &iteration);

    /// Iteration, functional, residual, linear systems, their iterations of
    /// conjugate gradients, and nodes in contact.
    void
    report(const MajoriseMinimiseIteration &iteration);

    /// Prints the last iteration, if that was not done yet, and ends the line.
    void
    finish();

  private:
    void
    report_row(const unsigned int iteration,
               const std::string &header,
               const std::string &row);

    std::ostream &out;
    bool          terminal;
    bool          header_printed = false;
    bool          pending        = false; ///< last is not a finished line
    double        last_print_seconds;
    unsigned int  next_logged = 1;
    std::string   last_row;
  };
} // namespace Debond

#endif
