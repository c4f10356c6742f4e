// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/child_process.h>
#include <debond/benchmark/measurement.h>

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <fstream>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    /// A job shorter than this is repeated until it has taken so much time.
    constexpr double repeated_seconds = 0.2;



    double
    seconds_of(const clockid_t clock)
    {
      timespec time;
      clock_gettime(clock, &time);
      return static_cast<double>(time.tv_sec) +
             1e-9 * static_cast<double>(time.tv_nsec);
    }



    /// An entry of /proc/self/status, such as VmHWM, in bytes.
    double
    memory_status(const std::string &name)
    {
      std::ifstream status("/proc/self/status");
      for (std::string key; status >> key; std::getline(status, key))
        if (key == name + ":")
          {
            double kibibytes;
            status >> kibibytes;
            return 1024. * kibibytes;
          }
      throw std::runtime_error("there is no " + name + " in /proc/self/status");
    }



    /// The times of several calls.
    struct Times
    {
      std::vector<double> wall;
      std::vector<double> cpu;

      void
      add_call(const std::function<void()> &run)
      {
        const double wall_start = seconds_of(CLOCK_MONOTONIC);
        const double cpu_start  = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
        run();
        cpu.push_back(seconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu_start);
        wall.push_back(seconds_of(CLOCK_MONOTONIC) - wall_start);
      }
    };



    nlohmann::json
    measure_here(const Job &job)
    {
      malloc_trim(0);
      std::ofstream clear("/proc/self/clear_refs");
      clear << "5" << std::flush;
      if (!clear)
        throw std::runtime_error("cannot reset the peak of the memory");
      const double memory_before = memory_status("RssAnon");

      Times times;
      times.add_call(job.run);
      const double first_seconds = times.wall.front();

      // The peak has no entry of its own for memory without files.
      const double peak_bytes = memory_status("VmHWM") -
                                memory_status("RssFile") -
                                memory_status("RssShmem") - memory_before;

      if (first_seconds < repeated_seconds)
        {
          times = Times();
          for (double sum = 0.; sum < repeated_seconds;
               sum += times.wall.back())
            times.add_call(job.run);
        }
      return {{"seconds", spread(times.wall).median},
              {"cpu_seconds", spread(times.cpu).median},
              {"first_seconds", first_seconds},
              {"peak_bytes", peak_bytes},
              {"facts", job.facts ? job.facts() : nlohmann::json()}};
    }



    /// Returns an exit code.
    int
    send_measurement(const Job &job, const int pipe_end)
    {
      nlohmann::json result;
      try
        {
          result = measure_here(job);
        }
      catch (const std::exception &error)
        {
          result = {{"error", error.what()}};
        }
      const std::string text = result.dump();
      const char       *next = text.data();
      for (std::size_t left = text.size(); left > 0;)
        {
          const ssize_t written = write(pipe_end, next, left);
          if (written < 0 && errno != EINTR)
            return 1;
          next += std::max<ssize_t>(written, 0);
          left -= std::max<ssize_t>(written, 0);
        }
      return 0;
    }



    std::string
    read_all(const int pipe_end)
    {
      std::string text;
      char        buffer[4096];
      while (true)
        {
          const ssize_t n = read(pipe_end, buffer, sizeof(buffer));
          if (n == 0 || (n < 0 && errno != EINTR))
            return text;
          text.append(buffer, std::max<ssize_t>(n, 0));
        }
    }
  } // namespace



  Measurement
  measure(const Job &job)
  {
    int ends[2];
    if (pipe(ends) != 0)
      throw std::runtime_error(job.name + ": " + std::strerror(errno));
    ChildProcess child(
      [&]() {
        close(ends[0]);
        return send_measurement(job, ends[1]);
      },
      "/dev/null");
    close(ends[1]);
    const std::string text = read_all(ends[0]);
    close(ends[0]);
    if (const std::string &ending = child.wait(); !ending.empty())
      throw std::runtime_error(job.name + ": " + ending);

    const nlohmann::json result = nlohmann::json::parse(text);
    if (result.contains("error"))
      throw std::runtime_error(job.name + ": " +
                               result["error"].get<std::string>());
    return {result["seconds"],
            result["cpu_seconds"],
            result["first_seconds"],
            result["peak_bytes"],
            result["facts"]};
  }



  std::vector<Measurements>
  measure_alternating(const std::vector<Job> &jobs,
                      const unsigned int      repetitions,
                      const double            seconds)
  {
    std::vector<Measurements> result(jobs.size());
    const double              start = seconds_of(CLOCK_MONOTONIC);
    for (unsigned int r = 0; r < repetitions; ++r)
      {
        for (std::size_t k = 0; k < jobs.size(); ++k)
          {
            const std::size_t i = r % 2 == 0 ? k : jobs.size() - 1 - k;
            if (!result[i].error.empty())
              continue;
            Job job = jobs[i];
            if (r > 0)
              job.facts = nullptr;
            try
              {
                result[i].values.push_back(measure(job));
              }
            catch (const std::runtime_error &error)
              {
                result[i] = {{}, error.what()};
              }
          }
        if (seconds_of(CLOCK_MONOTONIC) - start > seconds)
          break;
      }
    return result;
  }



  Spread
  spread(std::vector<double> values)
  {
    if (values.empty())
      throw std::invalid_argument("spread: there are no values");
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return {0.5 * (values[(n - 1) / 2] + values[n / 2]),
            values.front(),
            values.back()};
  }



  Spread
  spread(const std::vector<Measurement> &measurements,
         double Measurement::*const figure)
  {
    std::vector<double> values;
    for (const Measurement &measurement : measurements)
      values.push_back(measurement.*figure);
    return spread(values);
  }



  Spread
  spread_of_ratios(const std::vector<Measurement> &numerators,
                   const std::vector<Measurement> &denominators,
                   double Measurement::*const figure)
  {
    std::vector<double> ratios;
    for (std::size_t r = 0; r < numerators.size(); ++r)
      ratios.push_back(numerators[r].*figure / denominators.at(r).*figure);
    return spread(ratios);
  }
} // namespace Debond
