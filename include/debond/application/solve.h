// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_application_solve_h
#define debond_application_solve_h

#include <debond/application/parameters.h>
#include <debond/application/scene.h>
#include <debond/optimization/majorise_minimise.h>
#include <debond/optimization/proximal_bundle.h>

#include <map>
#include <ostream>
#include <string>
#include <vector>

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



  /// Which method solves the scene, and why it was chosen.
  struct MethodChoice
  {
    std::string method;
    std::string reason; ///< empty if the scene names the method
  };

  MethodChoice
  choose_method(const Parameters &parameters);



  /// What every method reports.
  struct SolveResult
  {
    SolverStatus status = SolverStatus::success;
    std::string  message;

    dealii::Vector<double> u;          ///< of all degrees of freedom
    double                 functional; ///< J(u), from u, A and f

    unsigned int iterations  = 0;
    unsigned int long_steps  = 0;
    unsigned int short_steps = 0;
    unsigned int null_steps  = 0;

    /// Of the stop criterion: v_k of a bundle method, the relative residual of
    /// majorise-minimise.
    double criterion = 0.;

    double largest_qp_residual = 0.; ///< of bundle methods

    /// Wall seconds by part.
    std::map<std::string, double> parts;

    /// One of them is filled.
    std::vector<BundleIteration>           bundle_history;
    std::vector<MajoriseMinimiseIteration> majorise_history;
  };

  /// Minimises the functional of the scene by the given method. Iterations are
  /// printed to @p out unless the scene wants no machine details.
  template <int dim>
  SolveResult
  solve(const std::string &method,
        const Parameters  &parameters,
        const Scene<dim>  &scene,
        std::ostream      &out,
        const bool         terminal);
} // namespace Debond

#endif
