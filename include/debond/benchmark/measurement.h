// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_benchmark_measurement_h
#define debond_benchmark_measurement_h

#include <nlohmann/json.hpp>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace Debond
{
  /// Something whose time and memory are measured.
  struct Job
  {
    std::string name;

    /// What is measured. Called several times if it is short.
    std::function<void()> run;

    /// What to report about the result of run(); not measured.
    std::function<nlohmann::json()> facts;
  };



  struct Measurement
  {
    /// Wall time of run(); of a short one the median of several calls after
    /// the first.
    double seconds;

    /// The same of the processor's time, which other programs disturb less.
    double cpu_seconds;

    /// Wall time of the first call, which finds caches cold and gets all memory
    /// from the system.
    double first_seconds;

    /// Most memory that the first call had at a time, beyond what was there
    /// before.
    double peak_bytes;

    nlohmann::json facts;
  };

  /**
   * Measures in a child process, which has all that this one has, so that no
   * measurement can change the next one.
   *
   * Memory is what the process has touched of its heap and stack: pages of
   * files, such as the code of libraries, do not count, nor does memory that
   * is allocated but never used. Before the start all freed memory is returned
   * to the system, so that using it again counts.
   *
   * Throws std::runtime_error with the name of the job if it throws or dies.
   */
  Measurement
  measure(const Job &job);

  /// Of a job.
  struct Measurements
  {
    /// The first one has the facts. None if a run failed.
    std::vector<Measurement> values = {};

    /// Why a run failed; empty if none did.
    std::string error = {};
  };

  /// Measures all jobs, at most @p repetitions times, every second time in
  /// reverse order, and not again once @p seconds are over. A job that throws
  /// or dies is left out from then on.
  std::vector<Measurements>
  measure_alternating(
    const std::vector<Job> &jobs,
    const unsigned int      repetitions,
    const double            seconds = std::numeric_limits<double>::infinity());



  struct Spread
  {
    double median;
    double min;
    double max;
  };

  Spread
  spread(std::vector<double> values);

  /// Of one figure of measurements.
  Spread
  spread(const std::vector<Measurement> &measurements,
         double Measurement::*const figure);

  /// Of the quotients of measurements of the same repetition, as many of both.
  Spread
  spread_of_ratios(const std::vector<Measurement> &numerators,
                   const std::vector<Measurement> &denominators,
                   double Measurement::*const figure);
} // namespace Debond

#endif
