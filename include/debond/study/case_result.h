// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_study_case_result_h
#define debond_study_case_result_h

#include <debond/study/cases.h>

#include <map>
#include <string>
#include <vector>

namespace Debond
{
  /// What a case left behind.
  struct CaseResult
  {
    /// Of the run, as in summary.json, or what happened to it in place of one.
    std::string status;
    std::string message;

    /// The numbers of summary.json by their JSON pointers, "/iterations/total".
    std::map<std::string, double> numbers;

    /// J after each iteration.
    std::vector<double> history;

    /// Throws std::runtime_error if summary.json has no such number.
    double
    number(const std::string &pointer) const;

    bool
    has_results() const
    {
      return !numbers.empty();
    }
  };

  /// Whether the directory of the case holds the complete results of exactly
  /// this case.
  bool
  is_finished(const Case &one);

  /// Whether there is a checkpoint of exactly this case.
  bool
  can_restart(const Case &one);

  /// Reads summary.json and history.csv of a case. Throws std::runtime_error
  /// naming the file that cannot be read.
  CaseResult
  read_results(const Case &one);
} // namespace Debond

#endif
