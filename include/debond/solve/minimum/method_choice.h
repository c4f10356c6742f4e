// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_method_choice_h
#define debond_solve_minimum_method_choice_h

#include <debond/input/accuracy_parameters.h>
#include <debond/input/solver_parameters.h>
#include <debond/solve/scene/scene.h>

namespace Debond
{
  /// The method that solves a scene, and why it was chosen.
  struct MethodChoice
  {
    SolverMethod method;
    LinearSolver linear_solver;
    std::string  reason; ///< of the method; empty if the scene leaves no choice
    std::string  reason_for_multigrid; ///< empty if it was not chosen

    /// Estimate of the program's peak, in bytes.
    double memory = 0.;

    /// Floating point, of the factorisation; 0 if there is none.
    double operations = 0.;

    /// True if multigrid has the coarser meshes of the body, not only A.
    bool has_levels = false;

    /// True if the method sees the problem condensed onto the contact normals,
    /// which multigrid does only where the method needs it.
    bool is_condensed = false;
  };

  /// How states are found, and verified.
  struct SolveSettings
  {
    const SolverParameters &parameters;
    double                  tolerance; ///< of the verification
  };

  /// Estimate in bytes of what mesh, A and its factors take for @p n unknowns.
  double
  memory_of_factorisation(const unsigned int dim, const double n);

  /// Returns this estimate with the @p wanted linear solver, if it is automatic
  /// with the one that takes less.
  double
  least_memory(const LinearSolver wanted,
               const unsigned int dim,
               const double       n);

  /// Returns the method that the scene asks for, or the one that follows from
  /// its entries; the linear solver may stay automatic. Throws BadInput if the
  /// scene asks for a method and a linear solver that do not go together.
  MethodChoice
  choose_method(const ProblemParameters &problem,
                const SolverParameters  &solver);

  /// Completes the choice by the linear solver for this mesh, which depends on
  /// what a factorisation of A would take. Throws BadInput if the memory that
  /// is needed exceeds the limit.
  template <int dim>
  void
  choose_linear_solver(const Scene<dim>       &scene,
                       const SolverParameters &solver,
                       MethodChoice           &choice);

  /// Returns @p choice with a factorisation, where multigrid has ended with
  /// this @p status, which is no solution; none if that does not fit into
  /// memory.
  template <int dim>
  std::optional<MethodChoice>
  factorisation_instead(const Scene<dim>       &scene,
                        const SolverParameters &solver,
                        const MethodChoice     &choice,
                        const SolverStatus      status);
} // namespace Debond

#endif
