// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_progress_h
#define debond_solve_minimum_progress_h

#include <debond/base/infinity.h>
#include <debond/optimization/bundle/proximal_bundle.h>
#include <debond/optimization/majorise/majorise_minimise.h>

namespace Debond
{
  /// Where iterations are printed.
  struct ProgressLog
  {
    std::ostream *out      = nullptr; ///< null for nowhere
    bool          terminal = false;   ///< whether it is one
  };



  /**
   * Prints iterations, and ends the method on an interruption. On a terminal it
   * is one line that is rewritten a few times a second, in a log a line at
   * iterations 1, 2, 5, 10, 20, 50, 100, 200, 500, ... A line with titles comes
   * first.
   */
  class Progress
  {
  public:
    /// Keeps the stream and the interruption.
    explicit Progress(
      const ProgressLog   log          = {},
      const Interruption &interruption = Interruption::by_signal())
      : interruption(interruption)
      , out(log.out)
      , terminal(log.terminal)
    {}

    Progress(const Progress &) = delete;

    ~Progress()
    {
      finish();
    }

    /// Prints iteration, J, v_k, bundle size and step kind.
    void
    report(const BundleIteration &iteration);

    /// Prints iteration, J, residual, linear systems, their iterations of
    /// conjugate gradients, and nodes in contact.
    void
    report(const MajoriseMinimiseIteration &iteration);

    /// Says what takes long now, if there are many unknowns.
    void
    announce(const std::string &what, const unsigned int n_unknowns) const;

    /// The monitor of a method whose functional is J without the @p energy of
    /// what is prescribed.
    template <typename Iteration>
    std::function<bool(const Iteration &)>
    monitor(const double energy)
    {
      return [this, energy](Iteration iteration) {
        iteration.functional += energy;
        report(iteration);
        return !interruption.requested();
      };
    }

    /// Prints the last iteration, if that was not done yet, and ends the line.
    void
    finish();

    const Interruption &interruption;

  private:
    void
    report_row(const unsigned int iteration,
               const std::string &header,
               const std::string &row);

    std::ostream *const out;
    const bool          terminal;
    bool                header_printed = false;
    bool                pending        = false; ///< last is not a finished line
    double              last_print_seconds = -infinity;
    unsigned int        next_logged        = 1;
    std::string         last_row;
  };
} // namespace Debond

#endif
