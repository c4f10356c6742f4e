// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_watch_h
#define debond_solve_watch_h

#include <debond/base/run_watch.h>
#include <debond/solve/progress.h>

#include <memory>
#include <ostream>
#include <string>

namespace Debond
{
  /// Prints iterations, if it has a stream, and ends the method on a signal.
  class Watch
  {
  public:
    explicit Watch(const InterruptGuard &guard)
      : guard(guard)
    {}

    Watch(const InterruptGuard &guard, std::ostream &out, const bool terminal)
      : guard(guard)
      , progress(std::make_unique<Progress>(out, terminal))
      , log(&out)
    {}

    /// Prints no iterations, but what this one announces.
    Watch
    without_iterations() const
    {
      Watch result(guard);
      result.log = log;
      return result;
    }

    /// Says what takes long now, if there are many unknowns.
    void
    announce(const std::string &what, const unsigned int n_unknowns) const
    {
      if (log != nullptr && n_unknowns > fewest_announced)
        *log << "  " << what << ", " << n_unknowns << " unknowns" << std::endl;
    }

    ~Watch()
    {
      if (progress)
        progress->finish();
    }

    Watch(Watch &&) = default;

    /// The difference between J and the functional that the method sees.
    void
    add_energy(const double energy)
    {
      offset = energy;
    }

    template <typename Iteration>
    bool
    operator()(Iteration iteration)
    {
      RunWatch::has_result = true;
      iteration.functional += offset;
      if (progress)
        progress->report(iteration);
      return may_go_on();
    }

    bool
    may_go_on() const
    {
      return !guard.requested();
    }

  private:
    /// With fewer unknowns nothing takes more than some seconds.
    static constexpr unsigned int fewest_announced = 50000;

    double                    offset = 0.;
    const InterruptGuard     &guard;
    std::unique_ptr<Progress> progress;
    std::ostream             *log = nullptr;
  };
} // namespace Debond

#endif
