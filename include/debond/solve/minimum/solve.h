// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_solve_h
#define debond_solve_minimum_solve_h

#include <debond/solve/minimum/method_choice.h>
#include <debond/solve/minimum/progress.h>
#include <debond/solve/minimum/solution.h>

namespace Debond
{
  /// Minimises the functional of the scene, by the given method. It begins at
  /// @p start unless that is null: then the Euclidean bundle begins at
  /// scene.start(), the others at rest or at the minimum on coarser meshes or
  /// contact boundaries. Ranks that share a scene call it together, and all get
  /// the result.
  template <int dim>
  Solution
  solve(const MethodChoice     &choice,
        const SolverParameters &parameters,
        const Scene<dim>       &scene,
        const ProgressLog       log   = {},
        const DofVector        *start = nullptr);

  /// Throws BadInput if the method cannot do with a body that only its bonds
  /// and the foundation hold.
  template <int dim>
  void
  check_supports_of_method(const MethodChoice     &choice,
                           const SolverParameters &parameters,
                           const Scene<dim>       &scene);
} // namespace Debond

#endif
