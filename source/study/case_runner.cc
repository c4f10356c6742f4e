// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/child_process.h>
#include <debond/base/interrupt.h>
#include <debond/linear_algebra/blas_threads.h>
#include <debond/program/command_line.h>
#include <debond/study/case_runner.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <memory>
#include <sstream>
#include <thread>

namespace Debond
{
  namespace
  {
    constexpr auto pause_between_polls = std::chrono::milliseconds(10);

    /// After an interruption the running cases have this long to write their
    /// results before they are killed.
    constexpr double seconds_to_end = 10.;



    struct RunningCase
    {
      RunningCase(const Case &one, const std::function<int()> &work)
        : one(&one)
        , process(work, one.directory + "/log")
      {}

      const Case   *one;
      ChildProcess  process;
      dealii::Timer timer;
    };



    std::unique_ptr<RunningCase>
    start_case(const std::string &scene, const Case &one, const bool afresh)
    {
      std::filesystem::create_directories(one.directory);
      // A case that ends before it writes anything must not inherit this.
      std::filesystem::remove(one.directory + "/summary.json");
      std::vector<std::string> command = {"debond", scene};
      for (const std::string &setting : one.settings)
        {
          command.emplace_back("--set");
          command.push_back(setting);
        }
      if (!afresh && can_restart(one))
        command.emplace_back("--restart");
      // To load the program takes longer than to solve a small scene.
      return std::make_unique<RunningCase>(one, [&command]() {
        use_one_blas_thread();
        std::vector<const char *> words;
        for (const std::string &word : command)
          words.push_back(word.c_str());
        return static_cast<int>(
          execute_command_line(static_cast<int>(words.size()), words.data()));
      });
    }



    /// How a case without results ended, with the last thing that it said.
    std::string
    describe_failure(const Case &one, const std::string &ending)
    {
      const std::string own_name = "debond: ";
      std::ifstream     log(one.directory + "/log");
      std::string       said;
      for (std::string line; std::getline(log, line);)
        if (line.compare(0, own_name.size(), own_name) == 0)
          said = line.substr(own_name.size());
      return (ending.empty() ? "no results" : ending) +
             (said.empty() ? "" : ": " + said);
    }



    std::string
    in_minutes(const double seconds)
    {
      std::ostringstream text;
      if (seconds < 99.5)
        text << std::lround(seconds) << " s";
      else
        text << std::lround(seconds / 60.) << " min";
      return text.str();
    }



    /// How far the study is, and how long the rest will take if the cases that
    /// are left take as long as the others on average.
    class CaseCounter
    {
    public:
      CaseCounter(const std::size_t  n_cases,
                  const std::size_t  n_finished,
                  const unsigned int jobs,
                  std::ostream      &out,
                  const bool         terminal)
        : n_cases(n_cases)
        , n_done(n_finished)
        , jobs(jobs)
        , out(out)
        , terminal(terminal)
      {}

      void
      add(const Case        &one,
          const double       seconds,
          const std::string &outcome,
          const std::size_t  n_running)
      {
        ++n_done;
        ++n_timed;
        seconds_spent += seconds;
        if (!terminal)
          out << progress(n_running) << "; " << one.label << ": " << outcome
              << ", " << in_minutes(seconds) << std::endl;
      }

      void
      show(const std::size_t n_running)
      {
        if (!terminal || (shown && since_shown.wall_time() < 0.2))
          return;
        shown = true;
        since_shown.restart();
        out << '\r' << std::left << std::setw(70) << progress(n_running)
            << std::flush;
      }

      void
      finish()
      {
        if (shown)
          out << '\r' << std::left << std::setw(70) << progress(0) << std::endl;
      }

    private:
      std::string
      progress(const std::size_t n_running) const
      {
        std::ostringstream text;
        text << n_done << " of " << n_cases << " cases done, " << n_running
             << " running, ";
        const double left = static_cast<double>(n_cases - n_done);
        if (n_timed == 0 && left > 0)
          text << "time left not known yet";
        else
          text << "about "
               << in_minutes(left == 0 ?
                               0. :
                               seconds_spent / static_cast<double>(n_timed) *
                                 left / std::min<double>(jobs, left))
               << " left";
        return text.str();
      }

      const std::size_t  n_cases;
      std::size_t        n_done;
      std::size_t        n_timed       = 0;
      double             seconds_spent = 0.;
      const unsigned int jobs;
      std::ostream      &out;
      const bool         terminal;
      bool               shown = false;
      dealii::Timer      since_shown;
    };



    /// Asks all to stop, and waits until they did.
    void
    end_cases(std::vector<std::unique_ptr<RunningCase>> &running)
    {
      for (const auto &child : running)
        child->process.send_signal(SIGTERM);
      const dealii::Timer timer;
      while (timer.wall_time() < seconds_to_end &&
             std::any_of(running.begin(), running.end(), [](const auto &child) {
               return !child->process.poll();
             }))
        std::this_thread::sleep_for(pause_between_polls);
      running.clear();
    }
  } // namespace



  CaseRunner::CaseRunner(const unsigned int jobs,
                         std::ostream      &out,
                         const bool         terminal)
    : jobs(jobs)
    , out(out)
    , terminal(terminal)
  {}



  bool
  CaseRunner::run(const std::string               &scene,
                  const std::vector<const Case *> &cases,
                  const bool                       afresh)
  {
    std::vector<const Case *> waiting;
    for (const Case *const one : cases)
      if (afresh || !is_finished(*one))
        waiting.push_back(one);
    run_count += static_cast<unsigned int>(waiting.size());
    CaseCounter counter(
      cases.size(), cases.size() - waiting.size(), jobs, out, terminal);

    std::vector<std::unique_ptr<RunningCase>> running;
    const InterruptGuard                      guard;
    for (auto next = waiting.begin();
         next != waiting.end() || !running.empty();)
      {
        if (guard.requested())
          {
            end_cases(running);
            counter.finish();
            return false;
          }
        while (next != waiting.end() && running.size() < jobs)
          running.push_back(start_case(scene, **next++, afresh));
        std::this_thread::sleep_for(pause_between_polls);

        for (auto child = running.begin(); child != running.end();)
          if (const std::optional<std::string> ending =
                (*child)->process.poll();
              ending)
            {
              const Case  &one     = *(*child)->one;
              const double seconds = (*child)->timer.wall_time();
              if (!is_finished(one))
                failures[one.directory] = describe_failure(one, *ending);
              child = running.erase(child);
              counter.add(one, seconds, result(one).status, running.size());
            }
          else
            ++child;
        counter.show(running.size());
      }
    counter.finish();
    return true;
  }



  CaseResult
  CaseRunner::result(const Case &one) const
  {
    CaseResult result;
    if (const auto failure = failures.find(one.directory);
        failure != failures.end())
      result.status = failure->second;
    else if (is_finished(one))
      result = read_results(one);
    else
      result.status = "not run";
    return result;
  }



  unsigned int
  CaseRunner::n_run() const
  {
    return run_count;
  }
} // namespace Debond
