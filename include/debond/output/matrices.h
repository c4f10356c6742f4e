// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_matrices_h
#define debond_output_matrices_h

#include <debond/output/output_file.h>
#include <debond/solve/scene.h>

#include <vector>

namespace Debond
{
  /// The discrete problem of a scene as Matrix Market files for other programs,
  /// if they are @p wanted; see doc/reference/output.md. Keeps a reference to
  /// the scene. A is assembled once more, since solvers store it as they like.
  template <int dim>
  std::vector<OutputFile>
  matrix_files(const Scene<dim> &scene, const bool wanted);
} // namespace Debond

#endif
