// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_displacement_h
#define debond_solve_displacement_h

#include <debond/linear_algebra/dof_vector.h>

#include <string>

namespace Debond
{
  /// Writes all degrees of freedom as text, a line each, with all digits.
  /// Throws std::runtime_error naming the file if it cannot be written.
  void
  write_displacement(const DofVector &u, const std::string &file_name);

  /// Reads what write_displacement() wrote. Throws std::invalid_argument
  /// naming the file if it has not @p n_dofs numbers and nothing else.
  DofVector
  read_displacement(const std::string &file_name, const unsigned int n_dofs);
} // namespace Debond

#endif
