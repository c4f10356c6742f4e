// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/instantiate.h>
#include <debond/contact/boundary_coarsening.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/elasticity/mesh_transfer.h>
#include <debond/input/bad_input.h>
#include <debond/optimization/majorise/condensed_problem.h>
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

    /// Contact boundaries with more nodes take their start from coarser ones.
    constexpr unsigned int coarsest_contact_nodes = 50;

    /// The number of unknowns up to which a coarser mesh is factorised for the
    /// start: there a factorisation takes a small part of the time of the
    /// finest mesh, even in 3D.
    constexpr double largest_coarse_factorisation = 3e4;



    template <int dim>
    Solution
    solve_by_euclidean_bundle(const ProximalBundleParameters &parameters,
                              const Scene<dim>               &scene,
                              const DofVector                *start,
                              Progress                       &progress)
    {
      // The method of the paper's Section 4 works on J_n itself, with all
      // unknowns w of the lifting u = w + G. Its functional has no constant, so
      // the energy of what is prescribed, 1/2 <A G, G> - <f, G> and that of the
      // bonds at w = 0, is added to all values afterwards.
      const double energy =
        prescribed_energy(scene.problem(), scene.adhesion());
      DofVector            u = start != nullptr ? *start : scene.start();
      ProximalBundleResult bundle =
        ProximalBundle(parameters)
          .minimize(scene.functional(),
                    scene.problem().unknowns().contact().bounds(),
                    u,
                    progress.monitor<BundleIteration>(energy));
      add_energy(energy, bundle);
      Solution result = solution_of(bundle);
      result.u        = u;
      result.minimum.kind =
        kind_without_search(scene.adhesion(), scene.contact_trace(u));
      const double strain_energy =
        scene.problem().fields().strain_energy(result.u);
      // The stop tolerance epsilon_s is an energy, so v_k is judged relative to
      // the strain energy. What foundation and supports bear without any
      // displacement leaves a v_k of rounding, for which there is no scale.
      if (strain_energy > 0.)
        result.relative_descent = std::abs(result.criterion) / strain_energy;
      return result;
    }



    /// The search and the proof from the minimum that the solver has found,
    /// which is replaced by the displacement of a better one.
    template <int dim>
    void
    search_and_prove(SolverParameters          parameters,
                     const Scene<dim>         &scene,
                     const Interruption       &interruption,
                     const ContactSolver<dim> &solver,
                     Solution                 &result)
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
      result.is_searched = true;
      result.is_replaced = s != followed;
      // The energies of both states are wanted: adaptive refinement must not
      // take what a search has found for what a finer mesh has gained.
      if (result.is_replaced)
        {
          result.functional_from_start = functional_of(scene, result.u);
          result.u                     = solver.condensed()->expand(s);
        }
      result.parts["search and proof"] = timer.wall_time();
    }



    template <int dim>
    Solution
    solve_contact(const MethodChoice     &choice,
                  const SolverParameters &parameters,
                  const Scene<dim>       &scene,
                  const DofVector        *start,
                  Progress               &progress);



    /// Starts from the minimum on the coarser contact boundaries, if there are
    /// any, of which @p notes tells failures.
    template <int dim>
    void
    start_from_coarser_boundaries(const MethodChoice       &choice,
                                  const SolverParameters   &parameters,
                                  const Scene<dim>         &scene,
                                  ContactSolver<dim>       &solver,
                                  std::vector<std::string> &notes)
    {
      const ElasticUnknowns<dim> &unknowns = scene.problem().unknowns();
      // Coarser spaces do not know the gaps of bodies at rest, and what only
      // bonds hold has to start with all of them. They have no tangents either.
      if (choice.method == SolverMethod::energy_bundle || unknowns.has_gap() ||
          !unknowns.is_held_by_supports() || scene.adhesion().shears())
        return;
      // Active sets and fronts of bonds move by few nodes a step. From
      // subspaces with half as many nodes each the finest one needs one or two
      // systems; the minimum that is found may be another one than that of slow
      // loading from rest.
      DofVector u(unknowns.n_dofs());
      unknowns.contact().add(
        coarse_start(condensed_problem(*solver.condensed(), scene.adhesion()),
                     coarsen(scene.contact_boundary(), coarsest_contact_nodes),
                     MajoriseMinimise(parameters.majorise_minimise),
                     notes),
        u);
      solver.start_from(u);
    }



    /// Starts from the minimum on the first coarser mesh that is factorised, if
    /// there is one, with the search of the scene. @p result gets what that has
    /// found, and notes. Each rank does the same.
    template <int dim>
    void
    start_from_coarser_mesh(const SolverParameters &parameters,
                            const Scene<dim>       &scene,
                            ContactSolver<dim>     &solver,
                            Solution               &result)
    {
      // This mesh decides which of the minima is found, so it is the finest one
      // that can have the whole search. Its proof would say nothing about the
      // finest mesh.
      std::shared_ptr<const Body<dim>> body = scene.body().coarser();
      while (body && dim * body->n_vertices() > largest_coarse_factorisation)
        body = body->coarser();
      if (body == nullptr)
        return;
      // The coarse mesh is a scene of its own, on which loads, supports and
      // bonds are evaluated anew. What its search found is told with the
      // result.
      const Scene<dim> coarse_scene(scene.parameters(), body);
      SolverParameters coarse = parameters;
      coarse.prove            = false;
      MethodChoice choice;
      choice.method        = SolverMethod::majorise_minimise;
      choice.linear_solver = LinearSolver::direct;
      choice.is_condensed  = true;
      Progress       silent;
      const Solution start =
        solve_contact(choice, coarse, coarse_scene, nullptr, silent);
      result.notes                   = start.notes;
      result.minimum                 = start.minimum;
      result.minimum.proof_attempted = false;
      // Even a failure leaves a displacement that is nearer to the minimum than
      // rest, so it is used, and a note says so.
      if (!can_be_verified(start.status))
        result.notes.push_back(
          "start on the mesh of " + std::to_string(coarse_scene.n_cells()) +
          (dim == 2 ? " triangles: " : " tetrahedra: ") + start.message);
      solver.start_from(interpolate_displacement(coarse_scene.problem(),
                                                 start.u,
                                                 scene.problem()));
    }



    /// Solves by a ContactSolver. A method that does not come to its end says
    /// so by a status.
    template <int dim>
    Solution
    solve_contact(const MethodChoice     &choice,
                  const SolverParameters &parameters,
                  const Scene<dim>       &scene,
                  const DofVector        *start,
                  Progress               &progress)
    {
      dealii::Timer               timer;
      Solution                    result;
      const ElasticUnknowns<dim> &unknowns = scene.problem().unknowns();
      progress.announce(choice.is_condensed ? "factorisation" : "multigrid",
                        unknowns.n_free_dofs());
      // Either J = c_0 + 1/2 s'S s - g's + Phi(s) on the contact normals alone,
      // which takes a factorisation of A or a multigrid solution for each of
      // them, or J on all unknowns by truncated multigrid. The second has
      // neither S nor g, and so no search and no proof.
      const auto solver = make_contact_solver(choice, parameters, scene);
      result.parts[choice.is_condensed ? "condensation" : "multigrid setup"] =
        timer.wall_time();
      // Data that overflow in double precision show in c_0 first. Comparisons
      // with a NaN are all false, so that the iteration would end with a
      // message about something else.
      if (choice.is_condensed &&
          !std::isfinite(solver->condensed()->energy_at_zero()))
        {
          result.status  = SolverStatus::not_finite;
          result.message = "condensation: the energy of the loads is not a "
                           "finite number. Check the data of the scene.";
          result.u.reinit(unknowns.n_dofs());
          return result;
        }

      // The start and the minimum that it leads to.
      timer.restart();
      if (start != nullptr)
        solver->start_from(*start);
      else if (choice.is_condensed)
        start_from_coarser_boundaries(
          choice, parameters, scene, *solver, result.notes);
      else
        start_from_coarser_mesh(parameters, scene, *solver, result);
      if (!choice.is_condensed)
        {
          result.parts["coarser meshes"] = timer.wall_time();
          timer.restart();
        }
      // The whole load is the factor 1; load paths call the same solver with
      // others.
      result.add(solver->minimise(1., scene.adhesion(), progress));
      result.parts["contact"] = timer.wall_time();

      // The other unknowns follow from s at equilibrium, u_i = A_ii^{-1} (f_i -
      // A_ic s).
      timer.restart();
      result.u                  = solver->displacement();
      result.parts["expansion"] = timer.wall_time();

      // The search starts from a minimum only. If bonds alone hold the body
      // there is none, since J may fall without end; without S and g it was
      // done on the coarser mesh that gave the start, and a note says what that
      // leaves open.
      const Condensation *const condensed  = solver->condensed();
      const bool                is_minimum = can_be_verified(result.status);
      const bool                is_held    = unknowns.is_held_by_supports();
      if (is_minimum && condensed != nullptr && is_held)
        search_and_prove(
          parameters, scene, progress.interruption, *solver, result);
      else if (condensed == nullptr && choice.has_levels && start == nullptr &&
               parameters.searches() && scene.law().pieces().size() > 1)
        result.notes.push_back(
          "fronts of bonds are as the search on coarser meshes left them; with "
          "Solver/Linear solver = direct it is done on the finest one");

      // What rounding has done to u is repaired if it matters; only then is the
      // condition of S of interest as well, and of a semidefinite S there is
      // none. On small meshes the estimate takes 2 % of the solve.
      const RefinedResult refined = refine_result(scene,
                                                  *solver->correction(),
                                                  progress.interruption,
                                                  result);
      if (refined.is_needed && condensed != nullptr && is_held)
        result.condition_estimate = condensed->condition_estimate();

      // The word of a search is about the pieces of Phi that bonds were on.
      if (!result.is_searched || refined.is_on_other_pieces)
        result.minimum.kind =
          kind_without_search(scene.adhesion(),
                              scene.contact_trace(result.u),
                              is_minimum && !refined.is_on_other_pieces ?
                                condensed :
                                nullptr);
      return result;
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
    // method would continue without end, and a search or a proof of a global
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
  Solution
  solve(const MethodChoice     &choice,
        const SolverParameters &parameters,
        const Scene<dim>       &scene,
        const ProgressLog       log,
        const DofVector        *start)
  {
    // The terminal's line of progress ends before anything else is printed.
    Progress progress(log);
    Solution result =
      choice.method == SolverMethod::euclidean_bundle ?
        solve_by_euclidean_bundle(parameters.bundle, scene, start, progress) :
        solve_contact(choice, parameters, scene, start, progress);
    progress.finish();
    // J is summed up from the strains and not from A u, whose rows nearly
    // cancel; this keeps some three digits more. A body that detaches has no J.
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
    // If nothing lower was found, the state of the start is the result, and its
    // J needs no second integral over the cells.
    if (result.is_searched && !result.is_replaced &&
        (result.minimum.search_trials > 0 || result.minimum.proof_attempted))
      result.functional_from_start = result.functional;
    return result;
  }



  DEBOND_INSTANTIATE(check_supports_of_method);
  DEBOND_INSTANTIATE(solve);
} // namespace Debond
