// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_watch_h
#define debond_solve_watch_h

#include <deal.II/base/mpi.h>

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
    /// Several ranks all do what the first one decides.
    explicit Watch(const InterruptGuard &guard,
                   const MPI_Comm        ranks = MPI_COMM_NULL)
      : guard(guard)
      , ranks(ranks)
    {}

    Watch(const InterruptGuard &guard,
          std::ostream         &out,
          const bool            terminal,
          const MPI_Comm        ranks)
      : guard(guard)
      , ranks(ranks)
      , progress(std::make_unique<Progress>(out, terminal))
      , log(&out)
    {}

    /// Prints no iterations, but what the other one announces.
    Watch(const InterruptGuard &guard, const Watch &other)
      : guard(guard)
      , log(other.log)
    {}

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

    Watch(const Watch &) = delete;

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
      const bool is_requested = guard.requested();
      return !(ranks == MPI_COMM_NULL ?
                 is_requested :
                 dealii::Utilities::MPI::broadcast(ranks, is_requested));
    }

  private:
    /// With fewer unknowns nothing takes more than some seconds.
    static constexpr unsigned int fewest_announced = 50000;

    double                    offset = 0.;
    const InterruptGuard     &guard;
    const MPI_Comm            ranks = MPI_COMM_NULL;
    std::unique_ptr<Progress> progress;
    std::ostream             *log = nullptr;
  };
} // namespace Debond

#endif
