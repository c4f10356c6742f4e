// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/multithread_info.h>

#include <debond/benchmark/benchmarks.h>
#include <debond/linear_algebra/blas_threads.h>
#include <debond/program/report_errors.h>

#include <iostream>
#include <string>

int
main(int argc, char *argv[])
{
  using Debond::ExitCode;
  const std::string name = "debond-benchmark";
  if (argc < 3 || argv[1][0] == '-')
    {
      std::cerr
        << "Usage: debond-benchmark DIRECTORY STUDY.prm...\n\n"
           "Measures the cases of the studies, see prm/benchmarks/, and "
           "writes tables into\nthe directory.\n";
      return static_cast<int>(ExitCode::bad_input);
    }

  // Scenes are solved on one core, as by debond.
  dealii::MultithreadInfo::set_thread_limit(1);
  Debond::use_one_blas_thread_by_default();
  return static_cast<int>(Debond::report_errors(name, [&]() {
    return Debond::run_benchmarks(argv[1], {argv + 2, argv + argc});
  }));
}
