// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/interrupt.h>
#include <debond/base/text.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/input/bad_input.h>
#include <debond/solve/condensed_methods.h>
#include <debond/solve/multigrid_method.h>
#include <debond/solve/refinement.h>
#include <debond/solve/solve.h>
#include <debond/solve/watch.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>

namespace Debond
{
  namespace
  {
    using Vector = DofVector;



    template <int dim>
    void
    solve_by_euclidean_bundle(const ProximalBundleParameters &parameters,
                              const Scene<dim>               &scene,
                              const Vector                   *start,
                              Watch                          &watch,
                              SolveResult                    &result)
    {
      const double energy =
        prescribed_energy(scene.problem(), scene.adhesion());
      watch.add_energy(energy);
      result.u = start != nullptr ? *start : scene.start();
      add_bundle_result(
        ProximalBundle(parameters)
          .minimize(scene.functional(),
                    scene.problem().unknowns().contact().bounds(),
                    result.u,
                    std::ref(watch)),
        result);
      for (BundleIteration &iteration : result.bundle_history)
        iteration.functional += energy;
      const double strain_energy =
        scene.problem().fields().strain_energy(result.u);
      // What foundation and supports bear without any displacement leaves a v_k
      // of rounding.
      if (strain_energy > 0.)
        result.relative_descent = std::abs(result.criterion) / strain_energy;
    }
  } // namespace



  template <int dim>
  void
  check_supports_of_method(const MethodChoice     &choice,
                           const SolverParameters &parameters,
                           const Scene<dim>       &scene)
  {
    const std::vector<std::string> &motions =
      scene.problem().unknowns().held_by_contact().names;
    if (motions.empty())
      return;
    const ProblemParameters &problem = scene.parameters();
    const auto               refuse  = [&](const std::string &entry,
                            const std::string &wanted) {
      throw BadInput({problem.scene + ": Solver/" + entry +
                      ": only bonds and the foundation hold the body (" +
                      join(motions, ", ") + "), which needs " + wanted});
    };
    if (choice.method != SolverMethod::majorise_minimise)
      refuse("Method", "majorise minimise or automatic");
    if (parameters.prove)
      refuse("Prove",
             "false: J may fall without end, and then there is no global "
             "minimum");
    if (parameters.search == BondSearchChoice::full)
      refuse("Search", "none: J may fall without end");
    if (!problem.load_path.factors.empty() &&
        problem.load_path.global_branch == GlobalBranch::prove)
      throw BadInput({problem.scene +
                      ": Load path/Global branch: only bonds and the "
                      "foundation hold the body (" +
                      join(motions, ", ") +
                      "): J may fall without end, and then there is no "
                      "global minimum"});
  }



  template <int dim>
  SolveResult
  solve(const MethodChoice     &choice,
        const SolverParameters &parameters,
        const Scene<dim>       &scene,
        std::ostream           *out,
        const bool              terminal,
        const Vector           *start)
  {
    SolveResult result;
    {
      const InterruptGuard guard;
      const auto           watch = out != nullptr ?
                                     std::make_unique<Watch>(guard, *out, terminal) :
                                     std::make_unique<Watch>(guard);
      if (choice.method == SolverMethod::euclidean_bundle)
        solve_by_euclidean_bundle(
          parameters.bundle, scene, start, *watch, result);
      else if (choice.is_condensed)
        solve_condensed(choice, parameters, scene, start, *watch, result);
      else
        solve_by_multigrid(choice, parameters, scene, start, *watch, result);
    }
    if (const auto direct =
          factorisation_instead(scene, parameters, choice, result.status))
      {
        const std::string note = multigrid_has_failed + result.message;
        result = solve(*direct, parameters, scene, out, terminal, start);
        result.notes.push_back(note);
        return result;
      }
    if (!choice.is_condensed)
      result.minimum.kind =
        kind_without_search(scene.adhesion(), scene.contact_trace(result.u));
    result.functional = result.status == SolverStatus::comes_off ?
                          std::numeric_limits<double>::quiet_NaN() :
                          functional_of(scene, result.u);
    if (result.minimum.proof_attempted)
      round_outwards(result.functional,
                     rounding_of_energy(scene.problem(), 1., result.u),
                     result.minimum);
    // Where nothing lower was found one integral over the cells does.
    if (choice.is_condensed && !result.is_replaced &&
        (result.minimum.search_trials > 0 || result.minimum.proof_attempted))
      result.functional_from_start = result.functional;
    return result;
  }



  template decltype(check_supports_of_method<2>) check_supports_of_method<2>;
  template decltype(check_supports_of_method<3>) check_supports_of_method<3>;
  template decltype(solve<2>)                    solve<2>;
  template decltype(solve<3>)                    solve<3>;
} // namespace Debond
