// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_report_h
#define debond_output_report_h

#include <debond/output/record.h>
#include <debond/output/run_result.h>

namespace Debond
{
  /// Reports program, scene, size of the problem and method, @p bundle_weight
  /// being the u_k of the Euclidean one.
  template <int dim>
  void
  report_problem(const Answer<dim> &begun,
                 const double       bundle_weight,
                 Record            &record);

  /// Adds the sizes of the mesh and its linear solver to the summary. Returns
  /// the number of unknowns as the paper counts them.
  template <int dim>
  unsigned int
  report_sizes(const Answer<dim> &answer, Record &record);

  /// Reports a mesh of a loop that refines, as the @p number-th one, when it is
  /// done.
  void
  report_level(const unsigned int   number,
               const AdaptiveLevel &level,
               Record              &record);

  /// Reports status, result, that of a load path as well, and verification.
  template <int dim>
  void
  report_result(const RunResult<dim> &result, Record &record);

  /// Reports times and memory, @p peak_memory in bytes.
  template <int dim>
  void
  report_cost(const RunResult<dim> &result,
              const double          peak_memory,
              Record               &record);

  /// Reports the paths of the files written.
  void
  report_files(const std::vector<std::string> &files, Record &record);
} // namespace Debond

#endif
