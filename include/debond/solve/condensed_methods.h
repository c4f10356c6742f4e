// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_condensed_methods_h
#define debond_solve_condensed_methods_h

#include <debond/input/solver_parameters.h>
#include <debond/solve/contact_solver.h>
#include <debond/solve/method_choice.h>
#include <debond/solve/scene.h>
#include <debond/solve/solve_result.h>
#include <debond/solve/watch.h>

#include <memory>

namespace Debond
{
  /// The scene condensed onto its contact normals by the linear solver that was
  /// chosen.
  template <int dim>
  Condensation
  condense(const MethodChoice &choice, const Scene<dim> &scene);

  /// Condenses the problem onto the contact normals and minimises there, with
  /// search and proof: by the energy bundle or by
  /// majorise-minimise, from @p start unless it is null.
  template <int dim>
  void
  solve_condensed(const MethodChoice     &choice,
                  const SolverParameters &parameters,
                  const Scene<dim>       &scene,
                  const DofVector        *start,
                  Watch                  &watch,
                  SolveResult            &result);

  /// From the body at rest, by condense(). Keeps a reference to the scene.
  template <int dim>
  std::unique_ptr<ContactSolver<dim>>
  make_condensed_solver(const MethodChoice &choice, const Scene<dim> &scene);
} // namespace Debond

#endif
