// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_matrices_h
#define debond_output_matrices_h

#include <debond/output/output_files.h>

namespace Debond
{
  /// Returns the discrete problem of a scene as Matrix Market files for other
  /// programs, if they are @p wanted, and the proof of its minimum if the
  /// @p result has one when they are written; see doc/reference/output.md and
  /// proofs.md. Keeps references. Without a proof A is factorised once more for
  /// S and g.
  template <int dim>
  std::vector<OutputFile>
  matrix_files(const bool        wanted,
               const Scene<dim> &scene,
               const Solution   &result);
} // namespace Debond

#endif
