// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_multigrid_method_h
#define debond_solve_multigrid_method_h

#include <debond/input/solver_parameters.h>
#include <debond/solve/contact_solver.h>
#include <debond/solve/method_choice.h>
#include <debond/solve/scene.h>
#include <debond/solve/solve_result.h>
#include <debond/solve/watch.h>

#include <memory>

namespace Debond
{
  /// Majorise-minimise on all unknowns by multigrid: of the coarser levels of
  /// the body or by smoothed aggregation, from @p start, or if it is null from
  /// the minimum on a coarser mesh if the body has one.
  template <int dim>
  void
  solve_by_multigrid(const MethodChoice     &choice,
                     const SolverParameters &parameters,
                     const Scene<dim>       &scene,
                     const DofVector        *start,
                     Watch                  &watch,
                     SolveResult            &result);

  /// The scene condensed onto its contact normals, by a solution for each.
  template <int dim>
  Condensation
  condense_by_multigrid(const Scene<dim> &scene, const bool has_levels);

  /// From the body at rest. Keeps a reference to the scene.
  template <int dim>
  std::unique_ptr<ContactSolver<dim>>
  make_multigrid_solver(const Scene<dim> &scene, const bool has_levels);
} // namespace Debond

#endif
