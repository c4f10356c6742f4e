// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_benchmark_contact_against_linear_h
#define debond_benchmark_contact_against_linear_h

#include <debond/benchmark/benchmark_study.h>
#include <debond/benchmark/benchmark_table.h>

namespace Debond
{
  /**
   * Time and memory of the whole contact solve, from the assembled A and f to
   * u, beside the linear solves of A u = f that the study asks for, which start
   * from the same A and f, as often as it says. @p name: of the scene. What
   * fails has no times, and its reason in the row's "failed".
   */
  template <int dim>
  BenchmarkRow
  measure_contact_against_linear(const std::string    &name,
                                 const Parameters     &parameters,
                                 const BenchmarkStudy &study);

  /**
   * The growth exponents p of time and memory, fitted by least squares to
   * log y = p log(unknowns) + c over the rows of each path (the linear solver
   * of the contact solve and the dimension) that have at least @p smallest
   * unknowns: a row for each path with at least two of them.
   */
  std::vector<BenchmarkRow>
  fit_growth(const std::vector<BenchmarkRow> &rows,
             const unsigned int               smallest);
} // namespace Debond

#endif
