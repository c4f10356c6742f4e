// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_benchmark_benchmark_study_h
#define debond_benchmark_benchmark_study_h

#include <debond/input/parameters.h>
#include <debond/study/study_parameters.h>

#include <set>
#include <string>
#include <vector>

namespace Debond
{
  /// A case of a study whose solve is measured.
  struct BenchmarkScene
  {
    std::string              name;
    std::string              scene;    ///< path
    std::vector<std::string> settings; ///< as for --set

    /// Throws BadInput.
    Parameters
    parameters() const;
  };



  /// A study whose cases are measured beside linear solves with the same
  /// matrix.
  struct BenchmarkStudy
  {
    std::vector<BenchmarkScene> scenes;

    /// Of "levels", "ml", "hypre" and "cholesky".
    std::set<std::string> linear_solvers = {"levels",
                                            "ml",
                                            "hypre",
                                            "cholesky"};

    unsigned int repetitions = 5; ///< at most

    /// A case is not repeated once this time is over.
    double seconds = 60.;

    /// Whether its cases are one scene on finer and finer meshes.
    bool is_refined = false;
  };



  /// The entries of a study, and those of a benchmark.
  class BenchmarkTable : public StudyTable
  {
  public:
    BenchmarkTable();

    /// The values of what has been read, @p file being its path. Throws
    /// BadInput as StudyTable::parameters() and make_cases() do.
    BenchmarkStudy
    benchmark(const std::string &file);

  private:
    BenchmarkStudy result;
  };
} // namespace Debond

#endif
