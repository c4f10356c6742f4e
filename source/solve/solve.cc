// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/text.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/input/bad_input.h>
#include <debond/solve/contact_solver.h>
#include <debond/solve/refine_result.h>
#include <debond/solve/solve.h>

#include <cmath>
#include <limits>

namespace Debond
{
  namespace
  {
    using Vector = DofVector;



    /// A search that was not asked for may take as many operations, some three
    /// seconds, and a fifth of what factorisations of S take.
    constexpr double least_search_operations = 2e10;



    template <int dim>
    void
    solve_by_euclidean_bundle(const ProximalBundleParameters &parameters,
                              const Scene<dim>               &scene,
                              const DofVector                *start,
                              Progress                       &progress,
                              SolveResult                    &result)
    {
      const double energy =
        prescribed_energy(scene.problem(), scene.adhesion());
      result.u = start != nullptr ? *start : scene.start();
      ProximalBundleResult bundle =
        ProximalBundle(parameters)
          .minimize(scene.functional(),
                    scene.problem().unknowns().contact().bounds(),
                    result.u,
                    progress.monitor<BundleIteration>(energy));
      add_energy(energy, bundle);
      add_bundle_result(bundle, result);
      const double strain_energy =
        scene.problem().fields().strain_energy(result.u);
      // What foundation and supports bear without any displacement leaves a v_k
      // of rounding.
      if (strain_energy > 0.)
        result.relative_descent = std::abs(result.criterion) / strain_energy;
    }



    /// The search and the proof from the minimum that the solver has found,
    /// which moves if there is a better one.
    template <int dim>
    void
    search_and_prove(SolverParameters    parameters,
                     const Scene<dim>   &scene,
                     const Interruption &interruption,
                     ContactSolver<dim> &solver,
                     SolveResult        &result)
    {
      const dealii::Timer   timer;
      const Eigen::VectorXd followed = solver.point();
      if (parameters.search == BondSearchChoice::automatic)
        parameters.search_operations =
          least_search_operations + 0.2 * std::pow(double(followed.size()), 3.);
      Eigen::VectorXd s = followed;
      result.minimum    = find_better_minimum(
        parameters, scene.adhesion(), *solver.condensed(), interruption, s);
      result.parts["search and proof"] = timer.wall_time();
      result.is_replaced               = s != followed;
      if (!result.is_replaced)
        return;
      result.functional_from_start =
        functional_of(scene, solver.displacement());
      solver.start_from(s, {});
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
  void
  solve_contact(const MethodChoice     &choice,
                const SolverParameters &parameters,
                const Scene<dim>       &scene,
                const DofVector        *start,
                Progress               &progress,
                SolveResult            &result)
  {
    dealii::Timer               timer;
    const ElasticUnknowns<dim> &unknowns = scene.problem().unknowns();
    const bool is_held = unknowns.held_by_contact().motions.empty();
    progress.announce(choice.is_condensed ? "factorisation" : "multigrid",
                      unknowns.n_free_dofs());
    const auto                solver    = make_contact_solver(choice, scene);
    const Condensation *const condensed = solver->condensed();
    result.parts[condensed != nullptr ? "condensation" : "multigrid setup"] =
      timer.wall_time();
    if (condensed != nullptr && !std::isfinite(condensed->energy_at_zero()))
      {
        result.status  = SolverStatus::not_finite;
        result.message = "condensation: the energy of the loads is not a "
                         "finite number. Check the data of the scene.";
        result.u.reinit(unknowns.n_dofs());
        return;
      }

    // The start and the minimum that it leads to.
    timer.restart();
    if (start != nullptr)
      solver->start_from(unknowns.contact().trace(*start), *start);
    else
      solver->start_from_coarser(parameters, result);
    if (condensed == nullptr)
      result.parts["coarser meshes"] = timer.wall_time();
    const ContactMinimum minimum =
      solver->minimise(1., scene.adhesion(), parameters, progress);
    if (minimum.bundle)
      add_bundle_result(*minimum.bundle, result);
    else
      add_majorise_result(minimum, result);
    result.parts["contact"] = timer.wall_time();

    // Where nothing else holds the body J may fall without end, and there is no
    // search; without S and g it was done on a coarser mesh.
    const bool is_minimum = can_be_verified(result.status);
    if (is_minimum && condensed != nullptr && !is_held)
      result.minimum.kind =
        kind_without_search(scene.adhesion(), solver->point(), condensed);
    else if (is_minimum && condensed != nullptr)
      search_and_prove(
        parameters, scene, progress.interruption, *solver, result);
    else if (condensed == nullptr && choice.has_levels && start == nullptr &&
             wants_search(parameters) && scene.law().branches().size() > 1)
      result.notes.push_back(
        "fronts of bonds are as the search on coarser meshes left them; with "
        "Solver/Linear solver = direct it is done on the finest one");

    timer.restart();
    result.u                  = solver->displacement();
    result.parts["expansion"] = timer.wall_time();
    // On small meshes the estimate takes 2 % of the solve.
    if (refine_result(
          scene, *solver->correction(), progress.interruption, result) &&
        condensed != nullptr && is_held)
      result.condition_estimate = condensed->condition_estimate();
  }



  template <int dim>
  SolveResult
  solve(const MethodChoice     &choice,
        const SolverParameters &parameters,
        const Scene<dim>       &scene,
        std::ostream           *out,
        const bool              terminal,
        const DofVector        *start)
  {
    SolveResult result;
    {
      Progress progress(out, terminal);
      if (choice.method == SolverMethod::euclidean_bundle)
        solve_by_euclidean_bundle(
          parameters.bundle, scene, start, progress, result);
      else
        solve_contact(choice, parameters, scene, start, progress, result);
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
  template decltype(solve_contact<2>)            solve_contact<2>;
  template decltype(solve_contact<3>)            solve_contact<3>;
  template decltype(solve<2>)                    solve<2>;
  template decltype(solve<3>)                    solve<3>;
} // namespace Debond
