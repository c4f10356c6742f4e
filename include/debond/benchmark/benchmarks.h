// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_benchmark_benchmarks_h
#define debond_benchmark_benchmarks_h

#include <debond/program/exit_code.h>

#include <string>

namespace Debond
{
  /// Measures what the file of prm/benchmarks/ asks for, and writes results as
  /// CSV and Markdown tables into its output directory. Throws BadInput.
  ExitCode
  run_benchmarks(const std::string &file);
} // namespace Debond

#endif
