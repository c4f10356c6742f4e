// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/application/interrupt.h>
#include <debond/application/solve.h>
#include <debond/elasticity/condensation.h>
#include <debond/optimization/metric_direction.h>
#include <debond/output/progress.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>

namespace Debond
{
  namespace
  {
    using Vector = dealii::Vector<double>;



    /// Prints iterations, unless the log is to be compared, and ends the
    /// method on a signal.
    class Watch
    {
    public:
      Watch(const Parameters &parameters,
            std::ostream     &out,
            const bool        terminal)
      {
        if (parameters.output.machine_details)
          progress = std::make_unique<Progress>(out, terminal);
      }

      ~Watch()
      {
        if (progress)
          progress->finish();
      }

      Watch(const Watch &) = delete;

      /// The difference between J and the functional that the method sees.
      void
      add_energy(const double energy)
      {
        offset = energy;
      }

      template <typename Iteration>
      bool
      operator()(Iteration iteration)
      {
        iteration.functional += offset;
        if (progress)
          progress->report(iteration);
        return !guard.requested();
      }

    private:
      double                    offset = 0.;
      const InterruptGuard      guard;
      std::unique_ptr<Progress> progress;
    };



    void
    add_bundle_result(const ProximalBundleResult &bundle, SolveResult &result)
    {
      result.status                     = bundle.status;
      result.message                    = bundle.message;
      result.iterations                 = bundle.iterations();
      result.long_steps                 = bundle.long_steps;
      result.short_steps                = bundle.short_steps;
      result.null_steps                 = bundle.null_steps;
      result.criterion                  = bundle.v;
      result.largest_qp_residual        = bundle.largest_qp_residual;
      result.bundle_history             = bundle.history;
      result.parts["quadratic program"] = bundle.qp_seconds;
      result.parts["functional"]        = bundle.objective_seconds;
      result.parts["linear algebra"]    = bundle.linear_algebra_seconds;
    }



    template <int dim>
    void
    solve_by_euclidean_bundle(const Parameters &parameters,
                              const Scene<dim> &scene,
                              Watch            &watch,
                              SolveResult      &result)
    {
      result.u.reinit(scene.problem().n_dofs());
      add_bundle_result(ProximalBundle<Vector>(parameters.bundle)
                          .minimize(scene.functional(),
                                    scene.functional().unilateral_constraint(),
                                    result.u,
                                    std::ref(watch)),
                        result);
    }



    template <int dim>
    void
    solve_by_energy_bundle(const Parameters   &parameters,
                           const Scene<dim>   &scene,
                           const Condensation &condensed,
                           Watch              &watch,
                           Vector             &s,
                           SolveResult        &result)
    {
      // The condensed functional has the same form on the normals alone.
      ContactBoundary<dim> normals = scene.problem().contact_boundary();
      for (unsigned int i = 0; i < normals.nodes.size(); ++i)
        normals.nodes[i].dof = i;
      const Functional<dim, dealii::FullMatrix<double>, Vector> functional(
        condensed.schur_complement(),
        condensed.load(),
        normals,
        scene.adhesion());

      ProximalBundleParameters bundle = parameters.energy_bundle;
      // Without loads any tolerance will do.
      bundle.epsilon_s =
        std::max(bundle.epsilon_s * condensed.energy_without_contact(),
                 std::numeric_limits<double>::min());
      MetricDirection direction(condensed.schur_complement(),
                                scene.adhesion(),
                                bundle.bundle_size);
      add_bundle_result(ProximalBundle<Vector>(bundle).minimize(
                          functional, direction, s, std::ref(watch)),
                        result);
      // The functional differs from J by the energy at s = 0.
      for (BundleIteration &iteration : result.bundle_history)
        iteration.functional += condensed.energy_at_zero();
    }



    template <int dim>
    void
    solve_by_majorise_minimise(const Parameters   &parameters,
                               const Scene<dim>   &scene,
                               const Condensation &condensed,
                               Watch              &watch,
                               Vector             &s,
                               SolveResult        &result)
    {
      const MajoriseMinimiseResult minimum =
        MajoriseMinimise(parameters.majorise_minimise)
          .minimize(condensed.schur_complement(),
                    condensed.load(),
                    scene.adhesion(),
                    s,
                    std::ref(watch));
      result.status           = minimum.status;
      result.message          = minimum.message;
      result.iterations       = minimum.history.size();
      result.criterion        = minimum.residual;
      result.majorise_history = minimum.history;
      for (MajoriseMinimiseIteration &iteration : result.majorise_history)
        iteration.functional += condensed.energy_at_zero();
    }
  } // namespace



  MethodChoice
  choose_method(const Parameters &parameters)
  {
    if (parameters.method != SolverMethod::automatic)
      return {parameters.method, ""};
    return {SolverMethod::majorise_minimise,
            "it is exact after finitely many steps, at the price of about one "
            "factorisation"};
  }



  template <int dim>
  SolveResult
  solve(const std::string &method,
        const Parameters  &parameters,
        const Scene<dim>  &scene,
        std::ostream      &out,
        const bool         terminal)
  {
    SolveResult result;
    {
      Watch watch(parameters, out, terminal);
      if (method == SolverMethod::euclidean_bundle)
        solve_by_euclidean_bundle(parameters, scene, watch, result);
      else
        {
          dealii::Timer              timer;
          const ElasticProblem<dim> &problem = scene.problem();
          std::vector<unsigned int>  normals;
          for (const auto &node : problem.contact_boundary().nodes)
            normals.push_back(node.dof);
          const Condensation condensed(problem.matrix(),
                                       problem.load(),
                                       normals,
                                       [&](const unsigned int i) {
                                         return problem.is_constrained(i);
                                       });
          result.parts["condensation"] = timer.wall_time();

          watch.add_energy(condensed.energy_at_zero());
          timer.restart();
          Vector s(normals.size());
          if (method == SolverMethod::energy_bundle)
            solve_by_energy_bundle(
              parameters, scene, condensed, watch, s, result);
          else
            solve_by_majorise_minimise(
              parameters, scene, condensed, watch, s, result);
          result.parts["contact"] = timer.wall_time();

          timer.restart();
          result.u                  = condensed.expand(s);
          result.parts["expansion"] = timer.wall_time();
        }
    }
    result.functional = scene.functional().value(result.u);
    return result;
  }



  template SolveResult
  solve(const std::string &,
        const Parameters &,
        const Scene<2> &,
        std::ostream &,
        const bool);
  template SolveResult
  solve(const std::string &,
        const Parameters &,
        const Scene<3> &,
        std::ostream &,
        const bool);
} // namespace Debond
