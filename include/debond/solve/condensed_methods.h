// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_condensed_methods_h
#define debond_solve_condensed_methods_h

#include <debond/input/solver_parameters.h>
#include <debond/linear_algebra/dof_vector.h>
#include <debond/solve/scene.h>
#include <debond/solve/solve_result.h>
#include <debond/solve/watch.h>

#include <string>

namespace Debond
{
  /// Condenses the problem onto the contact normals and minimises there, with
  /// search and proof: by the energy bundle or by
  /// majorise-minimise, from @p start unless it is null.
  template <int dim>
  void
  solve_condensed(const std::string      &method,
                  const SolverParameters &parameters,
                  const Scene<dim>       &scene,
                  const DofVector        *start,
                  Watch                  &watch,
                  SolveResult            &result);
} // namespace Debond

#endif
