// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_multigrid_method_h
#define debond_solve_multigrid_method_h

#include <debond/base/interrupt.h>
#include <debond/input/solver_parameters.h>
#include <debond/optimization/majorise/majorise_minimise.h>
#include <debond/solve/scene.h>
#include <debond/solve/solve_result.h>
#include <debond/solve/watch.h>

namespace Debond
{
  /// On coarser meshes, where the time for a factorisation does not count.
  constexpr double largest_coarse_factorisation = 3e4;

  /// Majorise-minimise on all unknowns from result.u, which @p problem refers
  /// to. @p energy is that of what is prescribed, which the problem does not
  /// know.
  void
  minimise_on_all_unknowns(const SolverParameters &parameters,
                           const double            energy,
                           MajorantProblem        &problem,
                           Watch                  &watch,
                           SolveResult            &result);

  /// What an interruption on coarser meshes leaves.
  void
  end_at_start(SolveResult &result);

  /// Majorise-minimise by algebraic multigrid, from the solution on a coarser
  /// mesh if the body has one.
  template <int dim>
  void
  solve_by_multigrid(const SolverParameters &parameters,
                     const Scene<dim>       &scene,
                     const InterruptGuard   &guard,
                     Watch                  &watch,
                     SolveResult            &result);
} // namespace Debond

#endif
