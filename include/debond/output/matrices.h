// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_matrices_h
#define debond_output_matrices_h

#include <debond/output/output_files.h>

namespace Debond
{
  /// Returns the discrete problem of a scene as Matrix Market files for other
  /// programs, if they are @p wanted; see doc/reference/output.md. Keeps a
  /// reference to the scene. A is factorised once more for S and g.
  template <int dim>
  std::vector<OutputFile>
  matrix_files(const Scene<dim> &scene, const bool wanted);
} // namespace Debond

#endif
