// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_output_files_h
#define debond_output_output_files_h

#include <debond/input/output_parameters.h>
#include <debond/output/output_file.h>
#include <debond/output/run_result.h>
#include <debond/solve/scene.h>

#include <string>
#include <vector>

namespace Debond
{
  /**
   * The files of a run but those that are there before the end of the solve
   * (parameters.prm), those of a load path (LoadPathOutput) and
   * summary.json. Keeps references: the @p result need not be there yet.
   */
  template <int dim>
  std::vector<OutputFile>
  output_files(const OutputParameters &output,
               const Scene<dim>       &scene,
               const RunResult<dim>   &result);
} // namespace Debond

#endif
