// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/instantiate.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/input/bad_input.h>
#include <debond/solve/minimum/contact_solver.h>
#include <debond/solve/minimum/refine_result.h>
#include <debond/solve/minimum/solve.h>

namespace Debond
{
  namespace
  {
    /// The least limit of operations of a search that was not asked for, some
    /// three seconds, and what it may take more with many contact nodes: a part
    /// of n_c^3, as a factorisation of S does.
    constexpr double least_search_operations = 2e10;



    template <int dim>
    void
    solve_by_euclidean_bundle(const ProximalBundleParameters &parameters,
                              const Scene<dim>               &scene,
                              const DofVector                *start,
                              Progress                       &progress,
                              SolveResult                    &result)
    {
      // The method of the paper's Section 4 works on J_n itself, with all
      // unknowns w of the lifting u = w + G. Its functional has no constant, so
      // the energy of what is prescribed, 1/2 <A G, G> - <f, G> and that of the
      // bonds at w = 0, is added to all values afterwards.
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
      // The stop tolerance epsilon_s is an energy, so v_k is judged relative to
      // the strain energy. What foundation and supports bear without any
      // displacement leaves a v_k of rounding, for which there is no scale.
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
      // Operations are counted instead of seconds, so that the result does not
      // depend on how busy the machine is. The term with n^3 lets the limit
      // grow with the cost of a factorisation of S, which each trial needs.
      if (parameters.search == BondSearchChoice::automatic)
        parameters.search_operations =
          least_search_operations + 0.2 * std::pow(double(followed.size()), 3.);
      Eigen::VectorXd s = followed;
      result.minimum    = find_better_minimum(
        parameters, scene.adhesion(), *solver.condensed(), interruption, s);
      result.parts["search and proof"] = timer.wall_time();
      // The energies of both states are wanted, that of the start before the
      // solver moves on from it: adaptive refinement must not take what a
      // search has found for what a finer mesh has gained.
      result.is_replaced = s != followed;
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
    // Rigid motions that only bonds hold make A singular, and J may fall
    // without end once these bonds have broken. Only majorise-minimise can tell
    // that (its proximal steps come to repeat one rigid motion); a bundle
    // method would go on without end, and a search or a proof of a global
    // minimum would look for what need not exist.
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
    const bool                  is_held  = unknowns.is_held_by_supports();
    progress.announce(choice.is_condensed ? "factorisation" : "multigrid",
                      unknowns.n_free_dofs());
    // Either J = c_0 + 1/2 s'S s - g's + Phi(s) on the contact normals alone,
    // which takes a factorisation of A or a multigrid solution for each of
    // them, or J on all unknowns by truncated multigrid. The second has neither
    // S nor g, and so no search and no proof.
    const auto                solver    = make_contact_solver(choice, scene);
    const Condensation *const condensed = solver->condensed();
    result.parts[condensed != nullptr ? "condensation" : "multigrid setup"] =
      timer.wall_time();
    // Data that overflow in double precision show in c_0 first. Comparisons
    // with a NaN are all false, so that the iteration would end with a message
    // about something else.
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
      {
        result.parts["coarser meshes"] = timer.wall_time();
        timer.restart();
      }
    // The whole load is the factor 1; load paths call the same solver with
    // others.
    const ContactMinimum minimum =
      solver->minimise(1., scene.adhesion(), parameters, progress);
    if (minimum.bundle)
      add_bundle_result(*minimum.bundle, result);
    else
      add_majorise_result(minimum, result);
    result.parts["contact"] = timer.wall_time();

    // The search starts from a minimum only. Where bonds alone hold the body
    // there is none, since J may fall without end; without S and g it was done
    // on the coarser mesh that gave the start, and a note says what that leaves
    // open.
    const bool is_minimum = can_be_verified(result.status);
    if (is_minimum && condensed != nullptr && !is_held)
      result.minimum.kind =
        kind_without_search(scene.adhesion(), solver->point(), condensed);
    else if (is_minimum && condensed != nullptr)
      search_and_prove(
        parameters, scene, progress.interruption, *solver, result);
    else if (condensed == nullptr && choice.has_levels && start == nullptr &&
             parameters.searches() && scene.law().pieces().size() > 1)
      result.notes.push_back(
        "fronts of bonds are as the search on coarser meshes left them; with "
        "Solver/Linear solver = direct it is done on the finest one");

    timer.restart();
    // The other unknowns follow from s at equilibrium, u_i = A_ii^{-1} (f_i -
    // A_ic s). What rounding has done to them is repaired where it matters;
    // only then is the condition of S of interest as well, and of a
    // semidefinite S there is none.
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
    // The terminal's line of progress ends with the braces, before anything
    // else is printed.
    SolveResult result;
    {
      Progress progress(out, terminal);
      if (choice.method == SolverMethod::euclidean_bundle)
        solve_by_euclidean_bundle(
          parameters.bundle, scene, start, progress, result);
      else
        solve_contact(choice, parameters, scene, start, progress, result);
    }
    // Multigrid that stagnates says nothing about the scene, since materials or
    // cells may be too much for its smoother. So a factorisation begins anew,
    // from the given start and not from where multigrid was left, and the
    // reader is told.
    if (const auto direct =
          factorisation_instead(scene, parameters, choice, result.status))
      {
        const std::string note = multigrid_has_failed + result.message;
        result = solve(*direct, parameters, scene, out, terminal, start);
        result.notes.push_back(note);
        return result;
      }
    // Without a search the word follows from the state of the bonds alone.
    if (!choice.is_condensed)
      result.minimum.kind =
        kind_without_search(scene.adhesion(), scene.contact_trace(result.u));
    // J is summed up from the strains and not from A u, whose rows nearly
    // cancel; this keeps some three digits more. A body that comes off has no
    // J.
    result.functional = result.status == SolverStatus::comes_off ?
                          std::numeric_limits<double>::quiet_NaN() :
                          functional_of(scene, result.u);
    // The bounds are those of the condensed problem in double precision. They
    // are moved by what separates that from the J above, so that they hold for
    // it.
    if (result.minimum.proof_attempted)
      round_outwards(result.functional,
                     rounding_of_energy(scene.problem(), 1., result.u),
                     result.minimum);
    // Where nothing lower was found, the state of the start is the result, and
    // its J needs no second integral over the cells.
    if (choice.is_condensed && !result.is_replaced &&
        (result.minimum.search_trials > 0 || result.minimum.proof_attempted))
      result.functional_from_start = result.functional;
    return result;
  }



  DEBOND_INSTANTIATE(check_supports_of_method);
  DEBOND_INSTANTIATE(solve_contact);
  DEBOND_INSTANTIATE(solve);
} // namespace Debond
