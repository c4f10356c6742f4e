// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_multigrid_method_h
#define debond_solve_multigrid_method_h

#include <debond/base/interrupt.h>
#include <debond/input/solver_parameters.h>
#include <debond/solve/method_choice.h>
#include <debond/solve/scene.h>
#include <debond/solve/solve_result.h>
#include <debond/solve/watch.h>

namespace Debond
{
  /// Majorise-minimise on all unknowns by multigrid: of the coarser levels of
  /// the body, with minima on them as starts, or by smoothed aggregation, from
  /// the minimum on a coarser mesh if the body has one.
  template <int dim>
  void
  solve_by_multigrid(const MethodChoice     &choice,
                     const SolverParameters &parameters,
                     const Scene<dim>       &scene,
                     const InterruptGuard   &guard,
                     Watch                  &watch,
                     SolveResult            &result);
} // namespace Debond

#endif
