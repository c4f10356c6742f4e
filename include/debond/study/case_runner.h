// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_study_case_runner_h
#define debond_study_case_runner_h

#include <debond/study/case_result.h>
#include <debond/study/cases.h>

#include <ostream>
#include <string>
#include <vector>

namespace Debond
{
  /**
   * Runs cases as children of this program, several at a time, and prints how
   * far it is: on a terminal one line that changes, in a log a line for each
   * case that ends.
   */
  class CaseRunner
  {
  public:
    CaseRunner(const unsigned int jobs, std::ostream &out, const bool terminal);

    /**
     * Runs those of the cases that are not finished, all of them if @p afresh.
     * Returns false if SIGINT or SIGTERM came; the children are ended then.
     */
    bool
    run(const std::string               &scene,
        const std::vector<const Case *> &cases,
        const bool                       afresh);

    /// The results of a case that was run or was finished already. Its status
    /// says what happened to a case without results.
    CaseResult
    result(const Case &one) const;

    /// Cases that run() had to run.
    unsigned int
    n_run() const;

  private:
    unsigned int  jobs;
    std::ostream &out;
    bool          terminal;
    unsigned int  run_count = 0;

    /// How those ended that left no results, by directory.
    std::map<std::string, std::string> failures;
  };
} // namespace Debond

#endif
