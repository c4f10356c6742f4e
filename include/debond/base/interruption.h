// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_interruption_h
#define debond_base_interruption_h

#include <atomic>
#include <chrono>
#include <csignal>
#include <ostream>
#include <string>
#include <thread>

namespace Debond
{
  /// The request to end before the end, which iterations ask for: here SIGINT
  /// or SIGTERM, if a SignalWatch records them.
  class Interruption
  {
  public:
    virtual ~Interruption() = default;

    /// Returns whether to end, on all ranks that were started together: all of
    /// them have to ask. Loops ask before each piece of work that can take a
    /// good part of a second.
    virtual bool
    requested() const;

    /// Returns what requested() has last said of signals, for loops that each
    /// rank, or each thread, has for itself.
    static bool
    noticed();

    /// The one that knows no limit.
    static const Interruption &
    by_signal();
  };



  /// Ends what iterates after so many operations as well. Work is counted, not
  /// timed: the result is the same on a busy machine and on each rank.
  class WorkLimit : public Interruption
  {
  public:
    explicit WorkLimit(const double most_operations)
      : most_operations(most_operations)
    {}

    void
    add(const double operations)
    {
      done += operations;
    }

    double
    operations() const
    {
      return done;
    }

    bool
    requested() const override
    {
      return Interruption::requested() || done >= most_operations;
    }

  private:
    const double most_operations;
    double       done = 0.;
  };



  /// A stage of the run, which lasts as long as the object. The stages of a
  /// process are nested.
  class Stage
  {
  public:
    explicit Stage(const std::string &name);

    ~Stage();

  private:
    friend class SignalWatch;

    const std::string                           name;
    const std::chrono::steady_clock::time_point begin;
    double                                      next_line = 2.; ///< in seconds
    Stage *const                                outer;
  };



  /**
   * Records the first SIGINT or SIGTERM, so that what iterates can end with a
   * result; a second one ends the program at once. Nor does the first one wait
   * as long as nothing has asked for an Interruption: then there is no result.
   * A thread says in what stage the run is, after 2, 4, 8, ... s of it, and
   * hears signals also where a library works. There is one object at a time.
   */
  class SignalWatch
  {
  public:
    /// Keeps a reference to @p out; @p exit_code is for a run that is ended.
    SignalWatch(std::ostream &out, const int exit_code);

    ~SignalWatch();

    SignalWatch(const SignalWatch &) = delete;

    /// The next run has no result yet. Lines depend on the machine, which
    /// @p is_quiet does without.
    void
    begin_run(const bool is_quiet);

  private:
    void
    look();

    std::ostream     &out;
    const int         exit_code;
    std::atomic<bool> is_quiet = false;
    int               n_looks  = 0; ///< since the signal
    struct sigaction  previous_int;
    struct sigaction  previous_term;
    std::thread       thread;
  };
} // namespace Debond

#endif
