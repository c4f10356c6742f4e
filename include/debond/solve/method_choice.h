// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_method_choice_h
#define debond_solve_method_choice_h

#include <debond/input/accuracy_parameters.h>
#include <debond/input/problem_parameters.h>
#include <debond/input/solver_parameters.h>

#include <string>

namespace Debond
{
  /// The methods that a scene may name.
  namespace SolverMethod
  {
    constexpr const char *automatic         = "automatic";
    constexpr const char *euclidean_bundle  = "euclidean bundle";
    constexpr const char *energy_bundle     = "energy bundle";
    constexpr const char *majorise_minimise = "majorise minimise";
  } // namespace SolverMethod

  /// What solves the linear systems of a method.
  namespace LinearSolver
  {
    constexpr const char *automatic = "automatic";
    constexpr const char *direct    = "direct";
    constexpr const char *multigrid = "multigrid";

    /// The method needs products with A only.
    constexpr const char *none = "none";
  } // namespace LinearSolver



  /// What solves a scene, and why it was chosen.
  struct MethodChoice
  {
    std::string method;
    std::string linear_solver;
    std::string reason; ///< empty if the scene leaves no choice

    /// Estimate of the program's peak, in bytes.
    double memory;

    /// Whether multigrid has the coarser meshes of the body, not only A.
    bool has_levels = false;
  };

  /// Chooses by the numbers of unknowns and contact nodes, the dimension and
  /// the memory, without building anything. Throws BadInput if the scene
  /// asks for a method and a linear solver that do not go together, or if the
  /// memory that is needed exceeds the limit.
  MethodChoice
  choose_method(const ProblemParameters  &problem,
                const SolverParameters   &solver,
                const AccuracyParameters &accuracy = {});



  /// What the program may still take of a memory limit, 0 for what is there, in
  /// bytes.
  double
  memory_left(const double limit);
} // namespace Debond

#endif
