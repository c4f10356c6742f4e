// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_solver_parameters_h
#define debond_input_solver_parameters_h

#include <debond/base/infinity.h>
#include <debond/base/parameter_table.h>
#include <debond/optimization/bundle/proximal_bundle.h>
#include <debond/optimization/global/branch_search.h>

namespace Debond
{
  enum class SolverMethod
  {
    automatic,
    euclidean_bundle, ///< of the paper
    energy_bundle,
    majorise_minimise
  };

  /// The solver of a method's linear systems.
  enum class LinearSolver
  {
    none, ///< the method needs products with A only
    automatic,
    direct,
    multigrid
  };

  /// As scenes name it.
  std::string
  to_string(const SolverMethod method);

  std::string
  to_string(const LinearSolver solver);



  /// The effort with which a better minimum is searched for.
  enum class BondSearchChoice
  {
    automatic, ///< what it takes if the method is automatic, else none
    none,
    full
  };



  /// The proof's tolerance is relative to what the bonds can change in J.
  inline BranchAndBoundParameters
  proof_defaults()
  {
    BranchAndBoundParameters parameters;
    parameters.tolerance       = 1e-9;
    parameters.maximum_seconds = 600.;
    return parameters;
  }



  /// In the energy norm the method needs few iterations and little choice.
  inline ProximalBundleParameters
  energy_bundle_defaults()
  {
    ProximalBundleParameters parameters;
    parameters.epsilon_s          = 1e-13;
    parameters.bundle_size        = 50;
    parameters.maximum_iterations = 1000;
    return parameters;
  }



  struct SolverParameters
  {
    SolverMethod method        = SolverMethod::automatic;
    LinearSolver linear_solver = LinearSolver::automatic;
    double       memory_limit  = 0.; ///< bytes, 0: what is there

    ProximalBundleParameters bundle;

    /// File with the first iterate of the Euclidean bundle; empty for zero.
    std::string start;

    /// epsilon_s relative to the energy of the body without contact; u is
    /// not used.
    ProximalBundleParameters energy_bundle = energy_bundle_defaults();

    MajoriseMinimiseParameters majorise_minimise;
    BondSearchChoice           search = BondSearchChoice::automatic;

    /// Operations that a search that was not asked for may take
    /// (BoundQPResult::operations).
    double search_operations = infinity;

    bool                     prove = false;
    BranchAndBoundParameters proof = proof_defaults();

    /// Says whether something else is proved with these limits.
    bool has_other_proof = false;

    /// Returns whether a search for lower minima is asked for, by a method that
    /// ends at one of them.
    bool
    searches() const
    {
      return search == BondSearchChoice::automatic ?
               method == SolverMethod::automatic :
               search != BondSearchChoice::none;
    }
  };



  /// Binds the section Solver.
  void
  bind_solver(SolverParameters &solver, ParameterTable &table);

  /// Checks what the patterns of the entries leave to be checked.
  void
  check_solver(const SolverParameters &solver, ParameterTable &table);
} // namespace Debond

#endif
