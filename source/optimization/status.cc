// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/status.h>

namespace Debond
{
  std::string
  to_string(const SolverStatus status)
  {
    switch (status)
      {
        case SolverStatus::success:
          return "success";
        case SolverStatus::iteration_limit:
          return "iteration limit";
        case SolverStatus::line_search:
          return "line search failed";
        case SolverStatus::quadratic_program:
          return "quadratic program failed";
        case SolverStatus::no_descent:
          return "no descent";
        case SolverStatus::stagnated:
          return "stagnated";
        case SolverStatus::not_finite:
          return "not finite";
        case SolverStatus::comes_off:
          return "comes off";
        case SolverStatus::interrupted:
          return "interrupted";
      }
    return "unknown";
  }
} // namespace Debond
