// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_benchmark_benchmark_suite_h
#define debond_benchmark_benchmark_suite_h

#include <debond/input/parameters.h>

#include <string>
#include <vector>

namespace Debond
{
  /// A scene with some parameters set, as on the command line.
  struct BenchmarkScene
  {
    std::string              name;
    std::string              scene; ///< path
    std::vector<std::string> settings;

    /// Throws BadInput.
    Parameters
    parameters() const;
  };



  /// What the benchmarks measure, as a JSON file in prm/benchmarks/ says.
  struct BenchmarkSuite
  {
    /// A contact solve beside linear solves with the same matrix.
    struct ContactSolve
    {
      BenchmarkScene scene;

      /// "cholesky" and "multigrid".
      std::vector<std::string> linear_solvers;

      unsigned int repetitions;
    };

    /// A mesh of the speed-against-error report and its methods.
    struct Mesh
    {
      BenchmarkScene           scene;
      std::vector<std::string> methods;
      unsigned int             repetitions;
    };

    std::string    output; ///< directory
    BenchmarkScene start_up;
    unsigned int   start_up_repetitions;

    std::vector<ContactSolve> contact_solves;

    /// Of one body, each twice as fine as the one before. The last one is the
    /// reference.
    std::vector<Mesh> meshes;
  };

  /// Paths of scenes are relative to the file. Throws BadInput if the file
  /// cannot be used.
  BenchmarkSuite
  read_benchmark_suite(const std::string &file);

  /// The same from a stream; @p file is used in messages and for the paths.
  BenchmarkSuite
  read_benchmark_suite(std::istream &stream, const std::string &file);
} // namespace Debond

#endif
