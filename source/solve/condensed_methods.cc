// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/dof_vector.h>
#include <debond/base/run_watch.h>
#include <debond/contact/boundary_coarsening.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/optimization/bundle/metric_direction.h>
#include <debond/optimization/majorise/coarse_start.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/solve/condensed_methods.h>
#include <debond/solve/multigrid_method.h>
#include <debond/solve/refine_result.h>
#include <debond/solve/refinement.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace Debond
{
  namespace
  {
    using Vector = DofVector;



    /// Contact boundaries with more nodes take their start from coarser ones.
    constexpr unsigned int coarsest_contact_nodes = 50;



    /// A search that was not asked for may take as many operations, some three
    /// seconds, and a fifth of what factorisations of S take.
    constexpr double least_search_operations = 2e10;



    /// From @p s, which becomes the result.
    template <int dim>
    ProximalBundleResult
    minimise_by_energy_bundle(ProximalBundleParameters       bundle,
                              const ContactSpace<dim>       &contact,
                              const Condensation            &condensed,
                              const AdhesionIntegral<dim>   &bonds,
                              const ProximalBundle::Monitor &monitor,
                              Eigen::VectorXd               &s)
    {
      // The condensed functional has the same form on the normals alone.
      const ContactSpace<dim>          normals = contact.condensed();
      const MatrixView                 S       = condensed.schur_complement();
      const dealii::FullMatrix<double> matrix(S.rows(), S.cols(), S.data());
      const Vector load(condensed.load().begin(), condensed.load().end());
      const Functional<dim> functional(
        [&matrix](Vector &dst, const Vector &src) { matrix.vmult(dst, src); },
        load,
        normals,
        bonds);

      // Without loads any tolerance will do.
      bundle.epsilon_s =
        std::max(bundle.epsilon_s * condensed.energy_without_contact(),
                 std::numeric_limits<double>::min());
      MetricDirection            direction(S, bonds, bundle.bundle_size);
      Vector                     x(s.begin(), s.end());
      const ProximalBundleResult result =
        ProximalBundle(bundle).minimize(functional, direction, x, monitor);
      s = eigen_view(x);
      return result;
    }



    /// From @p s, which becomes the result; where it is empty, from rest or
    /// from coarser contact boundaries.
    template <int dim>
    void
    solve_by_majorise_minimise(const MajoriseMinimise &method,
                               const Scene<dim>       &scene,
                               const Condensation     &condensed,
                               Watch                  &watch,
                               Eigen::VectorXd        &s,
                               SolveResult            &result)
    {
      // Coarser spaces do not know the gaps of bodies at rest, and what only
      // bonds hold has to start with all of them.
      const ElasticUnknowns<dim> &unknowns = scene.problem().unknowns();
      const bool                  is_loose =
        unknowns.has_gap() || !unknowns.held_by_contact().motions.empty();
      const MatrixView      S            = condensed.schur_complement();
      const Eigen::MatrixXd free_motions = free_motions_of_contact(unknowns);
      const Eigen::VectorXd g =
        load_at_contact(scene.problem(), condensed, 1., free_motions);
      const bool has_start = s.size() > 0;
      if (!has_start && is_loose)
        s = unknowns.contact().at_rest();
      else if (!has_start)
        s = coarse_start(
          {S, g, scene.adhesion(), [&watch]() { return watch.may_go_on(); }},
          coarsen(unknowns.contact().boundary(), coarsest_contact_nodes),
          method,
          result.notes);
      CondensedProblem problem(S,
                               g,
                               scene.adhesion(),
                               s,
                               free_motions,
                               stiffness_at_contact(scene.problem()));
      add_majorise_result(method.minimize(problem, std::ref(watch)),
                          condensed.energy_at_zero(),
                          result);
    }



    template <int dim>
    class CondensedSolver : public ContactSolver<dim>
    {
    public:
      using typename ContactSolver<dim>::MayGoOn;

      CondensedSolver(const MethodChoice &choice, const Scene<dim> &scene)
        : problem(scene.problem())
        , is_by_bundle(choice.method == SolverMethod::energy_bundle)
        , whole(condense(choice, scene))
        , free_motions(free_motions_of_contact(problem.unknowns()))
        , s(problem.unknowns().contact().at_rest())
      {}

      MajoriseMinimiseResult
      minimise(const LoadFactors                factors,
               const AdhesionIntegral<dim>     &bonds,
               const SolverParameters          &parameters,
               const MajoriseMinimise::Monitor &monitor,
               const MayGoOn                   &may_go_on) override
      {
        here = std::make_unique<const Condensation>(
          at_factors(whole, problem, bonds, factors));
        // Without loads the bundle's tolerance has nothing to be relative to.
        if (is_by_bundle && here->energy_without_contact() > 0.)
          return by_bundle(parameters.energy_bundle, bonds, may_go_on);
        const Eigen::VectorXd g =
          load_at_contact(problem, *here, factors, free_motions);
        CondensedProblem       condensed(whole.schur_complement(),
                                   g,
                                   bonds,
                                   s,
                                   free_motions,
                                   stiffness_at_contact(problem));
        MajoriseMinimiseResult result =
          MajoriseMinimise(parameters.majorise_minimise)
            .minimize(condensed, monitor);
        result.functional += here->energy_at_zero();
        for (MajoriseMinimiseIteration &iteration : result.history)
          iteration.functional += here->energy_at_zero();
        return result;
      }

      void
      start_from(const Eigen::VectorXd &point, const DofVector &) override
      {
        s = point;
      }

      Eigen::VectorXd
      point() const override
      {
        return s;
      }

      DofVector
      displacement(const LoadFactors            factors,
                   const AdhesionIntegral<dim> &bonds,
                   const MayGoOn               &may_go_on,
                   Refined                     &refined) override
      {
        DofVector           u = here->expand(s);
        CondensedCorrection correction(whole);
        refined = refine_where_needed(
          problem, bonds, factors, correction, may_go_on, u);
        return u;
      }

      const Condensation *
      condensed() const override
      {
        return &whole;
      }

    private:
      /// v_k stands for the residual.
      MajoriseMinimiseResult
      by_bundle(const ProximalBundleParameters &parameters,
                const AdhesionIntegral<dim>    &bonds,
                const MayGoOn                  &may_go_on)
      {
        const ProximalBundleResult bundle = minimise_by_energy_bundle<dim>(
          parameters,
          problem.unknowns().contact(),
          *here,
          bonds,
          [&may_go_on](const BundleIteration &) { return may_go_on(); },
          s);
        MajoriseMinimiseResult result;
        result.status     = bundle.status;
        result.functional = bundle.functional + here->energy_at_zero();
        result.residual   = bundle.v;
        result.message    = bundle.message;
        for (const BundleIteration &iteration : bundle.history)
          result.history.push_back(
            {iteration.iteration,
             iteration.functional + here->energy_at_zero(),
             iteration.v,
             iteration.qp_steps,
             0,
             0});
        return result;
      }

      const ElasticProblem<dim> &problem;
      const bool                 is_by_bundle;
      const Condensation         whole;
      const Eigen::MatrixXd      free_motions;
      Eigen::VectorXd            s;

      std::unique_ptr<const Condensation> here; ///< at the last factors
    };
  } // namespace



  template <int dim>
  Condensation
  condense(const MethodChoice &choice, const Scene<dim> &scene)
  {
    return choice.linear_solver == LinearSolver::multigrid ?
             condense_by_multigrid(scene, choice.has_levels) :
             condense_to_contact(scene.problem(), scene.adhesion());
  }



  template <int dim>
  void
  solve_condensed(const MethodChoice     &choice,
                  const SolverParameters &parameters,
                  const Scene<dim>       &scene,
                  const Vector           *start,
                  Watch                  &watch,
                  SolveResult            &result)
  {
    dealii::Timer              timer;
    const ElasticProblem<dim> &problem = scene.problem();
    watch.announce("factorisation", problem.unknowns().n_free_dofs());
    const Condensation condensed = condense(choice, scene);
    const bool is_held = problem.unknowns().held_by_contact().motions.empty();
    result.parts["condensation"] = timer.wall_time();

    if (!std::isfinite(condensed.energy_at_zero()))
      {
        result.status  = SolverStatus::not_finite;
        result.message = "condensation: the energy of the loads is not a "
                         "finite number. Check the data of the scene.";
        result.u.reinit(problem.unknowns().n_dofs());
        return;
      }
    watch.add_energy(condensed.energy_at_zero());
    timer.restart();
    const Eigen::Index n_nodes = problem.unknowns().contact().size();
    Eigen::VectorXd    s;
    if (start != nullptr)
      s = problem.unknowns().contact().trace(*start).cwiseMin(0.);
    // If no contact node is free, there is no metric either.
    if (choice.method == SolverMethod::energy_bundle && n_nodes > 0)
      {
        if (start == nullptr)
          s = Eigen::VectorXd::Zero(n_nodes);
        add_bundle_result(
          minimise_by_energy_bundle<dim>(parameters.energy_bundle,
                                         problem.unknowns().contact(),
                                         condensed,
                                         scene.adhesion(),
                                         std::ref(watch),
                                         s),
          result);
        // The functional differs from J by the energy at s = 0.
        for (BundleIteration &iteration : result.bundle_history)
          iteration.functional += condensed.energy_at_zero();
      }
    else
      solve_by_majorise_minimise(MajoriseMinimise(parameters.majorise_minimise),
                                 scene,
                                 condensed,
                                 watch,
                                 s,
                                 result);
    result.parts["contact"] = timer.wall_time();
    RunWatch::has_result    = true;

    // Where nothing else holds the body J may fall without end.
    if (can_be_verified(result.status) && !is_held)
      result.minimum.kind =
        kind_without_search(scene.adhesion(), s, &condensed);
    else if (can_be_verified(result.status))
      {
        SolverParameters limited = parameters;
        if (parameters.search == BondSearchChoice::automatic)
          limited.search_operations =
            least_search_operations + 0.2 * std::pow(double(n_nodes), 3.);
        timer.restart();
        const Eigen::VectorXd followed = s;
        result.minimum                 = find_better_minimum(
          limited,
          scene.adhesion(),
          condensed,
          [&]() { return watch.may_go_on(); },
          s);
        result.parts["search and proof"] = timer.wall_time();
        result.is_replaced               = s != followed;
        if (result.is_replaced)
          result.functional_from_start =
            functional_of(scene, condensed.expand(followed));
      }

    timer.restart();
    result.u                  = condensed.expand(s);
    result.parts["expansion"] = timer.wall_time();

    // On small meshes the estimate takes 2 % of the solve.
    CondensedCorrection solver(condensed);
    if (refine_result(scene, solver, watch, result) && is_held)
      result.condition_estimate = condensed.condition_estimate();
  }



  template <int dim>
  std::unique_ptr<ContactSolver<dim>>
  make_condensed_solver(const MethodChoice &choice, const Scene<dim> &scene)
  {
    return std::make_unique<CondensedSolver<dim>>(choice, scene);
  }



  template decltype(condense<2>)              condense<2>;
  template decltype(condense<3>)              condense<3>;
  template decltype(make_condensed_solver<2>) make_condensed_solver<2>;
  template decltype(make_condensed_solver<3>) make_condensed_solver<3>;
  template decltype(solve_condensed<2>)       solve_condensed<2>;
  template decltype(solve_condensed<3>)       solve_condensed<3>;
} // namespace Debond
