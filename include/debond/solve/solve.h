// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_solve_h
#define debond_solve_solve_h

#include <debond/input/solver_parameters.h>
#include <debond/optimization/bundle/proximal_bundle.h>
#include <debond/optimization/majorise/majorise_minimise.h>
#include <debond/solve/method_choice.h>
#include <debond/solve/scene.h>
#include <debond/solve/which_minimum.h>

#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace Debond
{
  /// What every method reports.
  struct SolveResult
  {
    SolverStatus status = SolverStatus::success;
    std::string  message;

    dealii::Vector<double> u;                ///< of all degrees of freedom
    LoadFactors            load_factor = 1.; ///< of the loads that u belongs to
    double                 functional;       ///< J(u), from the strains of u

    /// The first factor of a load path at which the body comes off; the rest is
    /// of the one before.
    std::optional<double> comes_off_at = {};

    unsigned int iterations  = 0;
    unsigned int long_steps  = 0;
    unsigned int short_steps = 0;
    unsigned int null_steps  = 0;

    /// Of the stop criterion: v_k of a bundle method, the relative residual of
    /// majorise-minimise.
    double criterion = 0.;

    double largest_qp_residual = 0.; ///< of bundle methods

    unsigned int linear_iterations = 0; ///< of conjugate gradients

    /// Of the elastic problem on the contact normals, if there is one.
    std::optional<double> condition_estimate;

    /// Of a success.
    WhichMinimum minimum;

    /// J of the state that the method led to, if search and proof could replace
    /// it by a lower one, and whether they did.
    std::optional<double> functional_from_start;
    bool                  is_replaced = false;

    /// What did not go as it should without keeping the method from its end.
    std::vector<std::string> notes;

    /// Wall seconds by part.
    std::map<std::string, double> parts;

    /// One of them is filled.
    std::vector<BundleIteration>           bundle_history;
    std::vector<MajoriseMinimiseIteration> majorise_history;
  };

  /// Minimises the functional of the scene, whose matrix must be stored as
  /// matrix_storage() says, by the given method, the bundle methods with
  /// @p checkpoints if there are any. Iterations are printed to @p out unless
  /// it is null. Methods with a factorisation begin at @p start, if there is
  /// one. Ranks that share a scene call it together, with a method that has
  /// levels; the first one has J and the notes.
  template <int dim>
  SolveResult
  solve(const MethodChoice           &choice,
        const SolverParameters       &parameters,
        const Scene<dim>             &scene,
        std::ostream                 *out         = nullptr,
        const bool                    terminal    = false,
        Checkpoints                  *checkpoints = nullptr,
        const dealii::Vector<double> *start       = nullptr);

  /// Throws BadInput if the method cannot do with a body that only its bonds
  /// and the foundation hold.
  template <int dim>
  void
  check_supports_of_method(const MethodChoice     &choice,
                           const SolverParameters &parameters,
                           const Scene<dim>       &scene);

  /// How a method needs A.
  MatrixStorage
  matrix_storage(const MethodChoice &choice);
} // namespace Debond

#endif
