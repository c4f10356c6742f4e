// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_load_path_h
#define debond_output_load_path_h

#include <debond/solve/load_path_steps.h>

#include <string>
#include <vector>

namespace Debond
{
  /// load_path.csv, a row for each step; what was not computed is left empty.
  template <int dim>
  void
  write_load_path(const std::vector<LoadPathStep<dim>> &steps,
                  const std::string                    &file_name);
} // namespace Debond

#endif
