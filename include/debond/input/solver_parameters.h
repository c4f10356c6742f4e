// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_solver_parameters_h
#define debond_input_solver_parameters_h

#include <debond/input/parameters.h>

namespace Debond
{
  /// Declares the section Solver.
  void
  declare_solver(ParameterTable &table);

  /// Takes the section out of the table into @p p; what does not fit together
  /// is left in the table as an error.
  void
  read_solver(ParameterTable &table, Parameters &p);
} // namespace Debond

#endif
