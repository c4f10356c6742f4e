// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_solver_parameters_h
#define debond_input_solver_parameters_h

#include <debond/input/parameters.h>

namespace Debond
{
  /// The section Solver.
  void
  bind_solver(Parameters &p, ParameterTable &table);

  /// What its patterns leave to be checked.
  void
  check_solver(const Parameters &p, ParameterTable &table);
} // namespace Debond

#endif
