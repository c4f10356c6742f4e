// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_benchmark_speed_against_error_h
#define debond_benchmark_speed_against_error_h

#include <debond/benchmark/benchmark_suite.h>
#include <debond/benchmark/benchmark_table.h>

#include <vector>

namespace Debond
{
  /**
   * What a method still has to gain by iterating on, beside what its mesh
   * costs.
   *
   * J_min of a mesh is the result of majorise-minimise, which is exact but for
   * rounding. J of the continuous problem is extrapolated from J_min of the
   * last three meshes, of which each halves h: if their differences are d_1
   * and d_2, the ones to come are taken as d_2 q, d_2 q^2, ... with q = d_2 /
   * d_1.
   *
   * In the energy norm the reference is the last mesh, so that the
   * discretisation errors are too small by its own part.
   */
  struct SpeedAgainstError
  {
    /// By mesh: unknowns, J_min and discretisation errors.
    std::vector<BenchmarkRow> meshes;

    /// By mesh and method: time, iterations, errors, and the iterate from
    /// which on J(x_k) - J_min is less than a tenth of the discretisation
    /// error of J.
    std::vector<BenchmarkRow> methods;

    /// By mesh, method and iterate: seconds and J(x_k) - J_min.
    std::vector<BenchmarkRow> convergence;
  };

  /// Throws std::runtime_error if the last three meshes do not allow the
  /// extrapolation.
  template <int dim>
  SpeedAgainstError
  measure_speed_against_error(const std::vector<BenchmarkSuite::Mesh> &meshes);
} // namespace Debond

#endif
