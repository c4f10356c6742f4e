// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/solve/minimum/progress.h>

#include <iomanip>
#include <sstream>

namespace Debond
{
  namespace
  {
    /// The time between two versions of the line on a terminal.
    constexpr double seconds_between_prints = 0.2;

    /// The number of unknowns from which on setups are announced: with fewer
    /// ones nothing takes more than some seconds.
    constexpr unsigned int fewest_announced = 50000;



    double
    now_in_seconds()
    {
      return std::chrono::duration<double>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
    }



    std::string
    bundle_header()
    {
      std::ostringstream text;
      text << std::setw(11) << "iteration" << std::setw(17) << "J"
           << std::setw(12) << "v" << std::setw(9) << "bundle"
           << "  step";
      return text.str();
    }



    std::string
    majorise_header()
    {
      std::ostringstream text;
      text << std::setw(11) << "iteration" << std::setw(17) << "J"
           << std::setw(12) << "residual" << std::setw(9) << "systems"
           << std::setw(8) << "CG" << std::setw(9) << "contact";
      return text.str();
    }



    /// A line that covers the longest of its predecessors on a terminal.
    std::string
    padded(const std::string &line)
    {
      // A shorter line would leave the end of the longer one before it on the
      // terminal.
      constexpr unsigned int longest = 60;
      return line.size() < longest ?
               line + std::string(longest - line.size(), ' ') :
               line;
    }



    /// The next of 1, 2, 5, 10, 20, 50, ...
    unsigned int
    following(const unsigned int number)
    {
      // By the leading digit: 1 and 5 are doubled, 2 is followed by 5.
      unsigned int leading_digit = number;
      while (leading_digit >= 10)
        leading_digit /= 10;
      return leading_digit == 2 ? number / 2 * 5 : number * 2;
    }
  } // namespace



  void
  Progress::report(const BundleIteration &iteration)
  {
    std::ostringstream text;
    text << std::setw(11) << iteration.iteration << std::scientific
         << std::setprecision(8) << std::setw(17) << iteration.functional
         << std::setprecision(2) << std::setw(12) << iteration.v << std::setw(9)
         << iteration.bundle_size << "  " << to_string(iteration.kind);
    report_row(iteration.iteration, bundle_header(), text.str());
  }



  void
  Progress::report(const MajoriseMinimiseIteration &iteration)
  {
    std::ostringstream text;
    text << std::setw(11) << iteration.iteration << std::scientific
         << std::setprecision(8) << std::setw(17) << iteration.functional
         << std::setprecision(2) << std::setw(12) << iteration.residual
         << std::setw(9) << iteration.active_set_steps << std::setw(8)
         << iteration.linear_iterations << std::setw(9) << iteration.n_active;
    report_row(iteration.iteration, majorise_header(), text.str());
  }



  void
  Progress::report_row(const unsigned int iteration,
                       const std::string &header,
                       const std::string &row)
  {
    if (out == nullptr)
      return;
    if (!header_printed)
      *out << header << std::endl;
    header_printed = true;

    // A terminal has one line that is rewritten, a log has lines at 1, 2, 5,
    // 10, ..., so that thousands of bundle iterations remain readable.
    last_row = row;
    pending  = true;
    if (terminal)
      {
        const double now = now_in_seconds();
        if (now - last_print_seconds < seconds_between_prints)
          return;
        last_print_seconds = now;
        *out << '\r' << padded(row) << std::flush;
      }
    else if (iteration >= next_logged)
      {
        while (next_logged <= iteration)
          next_logged = following(next_logged);
        *out << row << std::endl;
        pending = false;
      }
  }



  void
  Progress::announce(const std::string &what,
                     const unsigned int n_unknowns) const
  {
    if (out != nullptr && n_unknowns > fewest_announced)
      *out << "  " << what << ", " << n_unknowns << " unknowns" << std::endl;
  }



  void
  Progress::finish()
  {
    // The last iteration is the one that users look for, whether or not its
    // turn has come.
    if (pending)
      *out << (terminal ? '\r' + padded(last_row) : last_row) << std::endl;
    pending = false;
  }
} // namespace Debond
