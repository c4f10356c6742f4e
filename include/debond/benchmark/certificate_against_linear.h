// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_benchmark_certificate_against_linear_h
#define debond_benchmark_certificate_against_linear_h

#include <debond/benchmark/benchmark_study.h>
#include <debond/benchmark/benchmark_table.h>

namespace Debond
{
  /**
   * Processor time of a certificate of a plane scene, from the solved u to the
   * interval, beside a linear solve A u = f of the same mesh by CHOLMOD, from
   * the assembled A and f, and with assembly. @p name: of the scene. What fails
   * has no times, and its reason in the row's "failed".
   */
  BenchmarkRow
  measure_certificate_against_linear(const std::string    &name,
                                     const Parameters     &parameters,
                                     const BenchmarkStudy &study);
} // namespace Debond

#endif
