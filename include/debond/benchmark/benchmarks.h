// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_benchmark_benchmarks_h
#define debond_benchmark_benchmarks_h

#include <debond/program/exit_code.h>

#include <string>
#include <vector>

namespace Debond
{
  /// Measures the cases of the studies in @p files, see prm/benchmarks/, at
  /// least one file, and writes results as CSV and Markdown tables into @p
  /// directory. Throws BadInput.
  ExitCode
  run_benchmarks(const std::string              &directory,
                 const std::vector<std::string> &files);
} // namespace Debond

#endif
