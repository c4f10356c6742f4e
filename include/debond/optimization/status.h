// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_status_h
#define debond_optimization_status_h

#include <string>

namespace Debond
{
  /// How a solver ended. Everything but success is reported to the user;
  /// comes_off is an answer, though none with a minimum.
  enum class SolverStatus
  {
    success,           ///< the stop criterion holds
    iteration_limit,   ///< the iteration cap was reached first
    line_search,       ///< no point with the required subgradient was found
    quadratic_program, ///< the direction-finding problem could not be solved
    no_descent,        ///< the objective rose by more than rounding
    stagnated,         ///< rounding keeps it from the stop criterion
    not_finite,        ///< the objective or a subgradient is NaN or infinite
    comes_off,         ///< the objective falls without end: nothing holds it
    interrupted        ///< stopped from outside, the last iterate is kept
  };

  /// A short name for files ("success", "iteration limit", ...).
  std::string
  to_string(const SolverStatus status);

  /// Returns whether the end is the best that the solver can do: success, or
  /// stagnated, where a verification has to decide what the point is worth.
  inline bool
  can_be_verified(const SolverStatus status)
  {
    return status == SolverStatus::success || status == SolverStatus::stagnated;
  }
} // namespace Debond

#endif
