// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_benchmark_start_up_h
#define debond_benchmark_start_up_h

#include <debond/benchmark/benchmark_study.h>
#include <debond/benchmark/benchmark_table.h>

namespace Debond
{
  /**
   * The whole program on a scene, from the start of the process until all files
   * are written, beside the program `empty_program`, which does nothing but is
   * linked with the same libraries and stands in the same directory.
   */
  BenchmarkRow
  measure_start_up(const BenchmarkScene &scene,
                   const std::string    &output,
                   const unsigned int    repetitions);
} // namespace Debond

#endif
