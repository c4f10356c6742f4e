// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/interrupt.h>
#include <debond/base/run_watch.h>
#include <debond/base/text.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/elasticity/refinement.h>
#include <debond/optimization/stationary_path.h>
#include <debond/solve/condensed_methods.h>
#include <debond/solve/global_branch.h>
#include <debond/solve/load_path.h>
#include <debond/solve/multigrid_method.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <memory>
#include <sstream>

namespace Debond
{
  namespace
  {
    template <int dim>
    std::unique_ptr<ContactSolver<dim>>
    make_contact_solver(const MethodChoice &choice, const Scene<dim> &scene)
    {
      const Stage stage("factorisation");
      if (choice.is_condensed)
        return make_condensed_solver(choice, scene);
      return make_multigrid_solver(scene, choice.has_levels);
    }



    template <int dim>
    class PathFollower
    {
    public:
      PathFollower(const LoadPathParameters &parameters,
                   const SolveSettings      &settings,
                   const Scene<dim>         &scene,
                   std::ostream             *out)
        : parameters(parameters)
        , solver_parameters(settings.parameters)
        , tolerance(settings.tolerance)
        , scene(scene)
        , out(out)
        , bonds(std::make_unique<AdhesionIntegral<dim>>(scene.adhesion()))
        , solver(make_contact_solver(settings.choice, scene))
        , condensed(solver->condensed())
      {
        if (condensed != nullptr &&
            scene.problem().unknowns().held_by_contact().motions.empty())
          result.condition_estimate = condensed->condition_estimate();
        result.parts["condensation"] = timer.wall_time();
      }

      bool
      has_condensed() const
      {
        return condensed != nullptr;
      }

      void
      follow(const LoadPathObserver<dim> &observer)
      {
        timer.restart();
        print_titles("broken part");
        for (unsigned int k = 0; k < parameters.factors.size(); ++k)
          {
            if (!steps.empty() && guard.requested())
              {
                interrupt("the path is not complete");
                break;
              }
            if (!solve(parameters.at(k), observer))
              break;
            const LoadPathStep<dim> &step = steps.back();
            print(step.factors(),
                  step.state.functional,
                  step.state.broken_part,
                  step.state.minimum.empty() ? step.status :
                                               step.state.minimum);
            if (!step.message.empty())
              break;
          }
        result.parts["followed path"] = timer.wall_time();
      }

      /// Of a path without failures, condensed.
      void
      find_global_branch()
      {
        if (guard.requested())
          {
            if (result.status == SolverStatus::success)
              interrupt("there is no global branch");
            return;
          }
        const Stage stage("global branch");
        timer.restart();
        const CondensedScene<dim> condensed_scene = {scene, *condensed};
        Branch                    followed;
        for (unsigned int k = 0; k < steps.size(); ++k)
          {
            const double      factor = steps[k].factor;
            const BranchPoint point  = {
               points[k],
               condensed_functional(condensed_scene.at(factor),
                                   condensed_scene.bonds(factor),
                                   points[k]),
               {}};
            const auto [entry, is_new] = followed.emplace(factor, point);
            if (!is_new && point.functional < entry->second.functional)
              entry->second = point;
          }

        if (out != nullptr)
          *out << "  global branch\n";
        const bool proves = parameters.global_branch == GlobalBranch::prove;
        print_titles(proves ? "gap" : "states tried");
        const Branch branch = global_branch(
          parameters.global_branch,
          solver_parameters,
          condensed_scene,
          followed,
          may_go_on,
          [&](const double factor, const BranchPoint &point) {
            print(factor,
                  point.functional +
                    condensed_scene.at(factor).energy_at_zero(),
                  proves ?
                    std::stod(scientific_above(point.which.relative_gap, 2)) :
                    point.which.search_trials,
                  to_string(point.which.kind));
          });
        for (const auto &[factor, point] : branch)
          add_global(factor, point);
        if (guard.requested())
          interrupt("the global branch is not complete");
        result.parts["global branch"] = timer.wall_time();
      }

      /// From the state of the first factor, condensed.
      void
      find_arc(std::vector<LoadPathStep<dim>> &arc)
      {
        const Stage stage("arc");
        timer.restart();
        const auto [least, largest] =
          std::minmax_element(parameters.factors.begin(),
                              parameters.factors.end());
        const bool  is_of_loads = *least != *largest;
        const auto &varied =
          is_of_loads ? parameters.factors : parameters.displacement_factors;
        const auto other =
          std::find_if(varied.begin(), varied.end(), [&](const double factor) {
            return factor != varied[0];
          });
        if (other == varied.end())
          {
            result.notes.push_back("There is no arc: the factor stays the "
                                   "same.");
            return;
          }
        const auto factors_at = [&](const double factor) {
          LoadFactors factors = parameters.at(0);
          (is_of_loads ? factors.loads : factors.displacements) = factor;
          if (parameters.displacement_factors.empty())
            factors.displacements = factor;
          return factors;
        };

        // By t, which rises to begin with.
        const double sign  = *other > varied[0] ? 1. : -1.;
        const auto   ends  = std::minmax_element(varied.begin(), varied.end());
        const double lower = std::min(sign * *ends.first, sign * *ends.second),
                     upper = std::max(sign * *ends.first, sign * *ends.second);
        auto memory = std::make_unique<AdhesionIntegral<dim>>(scene.adhesion());
        const Eigen::VectorXd load = load_at(factors_at(varied[0]));
        const Eigen::VectorXd slope =
          (load_at(factors_at(*other)) - load) / std::abs(*other - varied[0]);
        StationaryPath path(condensed->schur_complement(),
                            load,
                            slope,
                            scene.law().branches(),
                            bonds_of_nodes(*memory),
                            parameters.bonds_heal,
                            points[0],
                            sign * varied[0]);
        const auto     add = [&](const bool is_stable) {
          const LoadFactors factors = factors_at(sign * path.t() + 0.); // no -0
          memory = std::make_unique<AdhesionIntegral<dim>>(
            memory->at(factors.displacements));
          const AdhesionIntegral<dim> &here = *memory;
          if (!parameters.bonds_heal)
            memory->break_for_good(path.point_before_kinks());
          const DofVector u =
            at_factors(*condensed, scene.problem(), here, factors)
              .expand(path.point());
          const Verification<dim> verification = verify(factors, here, u);
          LoadPathStep<dim>       step         = {};
          step.step   = static_cast<unsigned int>(arc.size() + 1);
          step.factor = factors.loads;
          step.displacement_factor = factors.displacements;
          step.status              = is_stable ? "stable" : "unstable";
          step.state               = state(factors, here, u, verification);
          if (!is_verified(verification))
            {
              step.status = "not verified";
              result.notes.push_back("The arc ends: " + location(step) +
                                     failure(verification));
            }
          arc.push_back(step);
          return step.status != "not verified";
        };

        using Event                 = StationaryPath::Event;
        Event              last     = Event::contact;
        const Eigen::Index most     = 100 + 20 * load.size();
        bool               is_going = add(true);
        for (unsigned int k = 0; is_going && last != Event::end; ++k)
          {
            if (guard.requested())
              {
                interrupt("the arc is not complete");
                break;
              }
            const double before = path.t();
            last                = path.advance(lower, upper);
            is_going            = false;
            if (last == Event::no_stiffness)
              result.notes.push_back(
                "The arc ends where the bonds that hold the body have "
                "broken.");
            else if (last == Event::degenerate)
              result.notes.push_back(
                "The arc ends where it branches, or rounding hides how it "
                "goes on.");
            else if (k == most)
              result.notes.push_back("The arc ends after " +
                                     std::to_string(most) +
                                     " changes of nodes.");
            else
              // Nodes of a body at rest change one after the other.
              is_going = path.t() == before || add(!path.was_at_kink());
          }
        result.parts["arc"] = timer.wall_time();
      }

      SolveResult
      take_result()
      {
        // Numbers of the last factor; the state's word may come from the global
        // branch.
        if (steps.empty())
          {
            result.u.reinit(scene.problem().unknowns().n_dofs());
            result.functional = std::numeric_limits<double>::quiet_NaN();
            return result;
          }
        result.load_factor  = steps.back().factors();
        result.functional   = steps.back().state.functional;
        result.minimum.kind = kinds.back();
        return result;
      }

      std::vector<LoadPathStep<dim>> steps;

    private:
      /// Returns whether there is a next step: not if the body comes off.
      bool
      solve(const LoadFactors factors, const LoadPathObserver<dim> &observer)
      {
        const Stage stage("load path, step " +
                          std::to_string(steps.size() + 1) + ", " +
                          parameters.name(factors));
        bonds = std::make_unique<AdhesionIntegral<dim>>(
          bonds->at(factors.displacements));
        const MajoriseMinimiseResult minimum = solver->minimise(
          factors,
          *bonds,
          solver_parameters,
          [this](const auto &) { return may_go_on(); },
          may_go_on);
        if (minimum.status == SolverStatus::interrupted && !steps.empty())
          {
            interrupt("the path is not complete");
            return false;
          }
        add_majorise_result(minimum, 0., result);
        result.message.clear();

        if (minimum.status == SolverStatus::comes_off)
          {
            result.comes_off_at = factors;
            result.message      = minimum.message;
            if (out != nullptr)
              {
                print_factors(factors.loads, factors.displacements);
                *out << std::setw(17) << "" << std::setw(14) << ""
                     << "  " << to_string(minimum.status) << std::endl;
              }
            return false;
          }

        LoadPathStep<dim> step;
        step.step                = static_cast<unsigned int>(steps.size() + 1);
        step.factor              = factors.loads;
        step.displacement_factor = factors.displacements;
        step.iterations = static_cast<unsigned int>(minimum.history.size());
        if (!steps.empty())
          step.change_factor =
            change_factor(steps.back().factors(), points.back(), factors);
        const Eigen::VectorXd s = solver->point();
        if (!parameters.bonds_heal)
          bonds->break_for_good(s);
        Refined refined;
        result.u = solver->displacement(factors, *bonds, may_go_on, refined);
        note(refined);
        const Verification<dim> verification =
          verify(factors, *bonds, result.u);
        step.state  = state(factors, *bonds, result.u, verification);
        step.status = to_string(minimum.status);
        kinds.push_back(kind_without_search(scene.law(), *bonds, s));
        if (!can_be_verified(minimum.status))
          step.message = result.message = location(step) + minimum.message;
        else if (!is_verified(verification))
          {
            step.message = location(step) + failure(verification);
            if (minimum.status == SolverStatus::success)
              step.status = "not verified";
            else
              result.message = location(step) + minimum.message;
          }
        else
          {
            step.state.minimum = to_string(kinds.back());
            if (minimum.status == SolverStatus::stagnated)
              {
                result.status = SolverStatus::success;
                step.status   = to_string(result.status);
                if (result.notes.empty())
                  result.notes.push_back(location(step) + minimum.message);
              }
          }
        points.push_back(s);
        steps.push_back(step);
        RunWatch::has_result = true;
        observer(step, result.u, verification, *bonds);
        return true;
      }

      void
      note(const Refined &refined)
      {
        result.is_refined = refined.is_refined;
        if (!refined.note.empty() && result.notes.empty())
          result.notes.push_back(refined.note);
      }

      Verification<dim>
      verify(const LoadFactors            factors,
             const AdhesionIntegral<dim> &bonds_there,
             const DofVector             &u) const
      {
        return Debond::verify(
          scene.problem(), bonds_there, scene.law(), u, factors);
      }

      LoadPathState<dim>
      state(const LoadFactors            factors,
            const AdhesionIntegral<dim> &bonds_there,
            const DofVector             &u,
            const Verification<dim>     &verification) const
      {
        return load_path_state<dim>(scene.problem(),
                                    bonds_there,
                                    factors,
                                    u,
                                    verification,
                                    {{"mean_", &scene.means()},
                                     {"probe_", &scene.probes()}});
      }

      bool
      is_verified(const Verification<dim> &verification) const
      {
        return verification.error() <= tolerance;
      }

      std::string
      failure(const Verification<dim> &verification) const
      {
        return verification.failure(tolerance);
      }

      std::string
      location(const LoadPathStep<dim> &step) const
      {
        return "load path, step " + std::to_string(step.step) + ", " +
               parameters.name(step.factors()) + ": ";
      }

      /// g of the condensed problem.
      Eigen::VectorXd
      load_at(const LoadFactors factors) const
      {
        return condensed->with_load(scene.problem().load(factors)).load();
      }

      std::vector<StationaryPath::Bond>
      bonds_of_nodes(const AdhesionIntegral<dim> &integral) const
      {
        std::vector<StationaryPath::Bond> bonds;
        const auto                       &nodes =
          scene.problem().unknowns().contact().boundary().nodes;
        for (unsigned int i = 0; i < nodes.size(); ++i)
          {
            const BondScale scale = integral.bonds_at(i);
            bonds.push_back({nodes[i].measure * scale.energy,
                             scale.stretch,
                             integral.least_piece(i)});
          }
        return bonds;
      }

      /// See LoadPathStep::change_factor.
      std::optional<double>
      change_factor(const LoadFactors last_factors,
                    const VectorView &last,
                    const LoadFactors factors)
      {
        if (condensed == nullptr)
          return {};
        const BranchMinimum &branches  = scene.law().branches();
        bool                 has_slope = false;
        for (unsigned int k = 0; k < branches.size(); ++k)
          has_slope = has_slope || branches[k].slope != 0.;
        if (branches.size() == 1)
          return {};
        // Without a slope, gaps and other factors displacements are
        // proportional to the factor.
        const bool is_proportional = last_factors.loads != 0. && !has_slope &&
                                     !scene.problem().unknowns().has_gap() &&
                                     parameters.displacement_factors.empty() &&
                                     parameters.dead_loads.empty();
        if (!bonds->is_separable())
          return change_between_nodes(is_proportional,
                                      last_factors,
                                      last,
                                      factors);
        if (is_proportional)
          return proportional_change(last_factors.loads, last, factors.loads);

        const Eigen::VectorXd load  = load_at(last_factors);
        const Eigen::VectorXd slope = load_at(factors) - load;
        StationaryPath        path(condensed->schur_complement(),
                            load,
                            slope,
                            branches,
                            bonds_of_nodes(*bonds),
                            parameters.bonds_heal,
                            last,
                            0.);
        // Contact that comes and goes. Changes at the end of the step count.
        using Event = StationaryPath::Event;
        Event event = Event::contact;
        for (unsigned int k = 0;
             event == Event::contact && k < 2 * load.size() && may_go_on();
             ++k)
          event = path.advance(0., 1. + 1e-10);
        if (event != Event::bond)
          return {};
        return factor_between(last_factors, factors, std::min(1., path.t()));
      }

      /// That which changes.
      static double
      factor_between(const LoadFactors first,
                     const LoadFactors last,
                     const double      part)
      {
        return first.loads != last.loads ?
                 first.loads + part * (last.loads - first.loads) :
                 first.displacements +
                   part * (last.displacements - first.displacements);
      }

      /// The same where bonds are not at nodes. On the way to their first
      /// change they are linear springs.
      std::optional<double>
      change_between_nodes(const bool        is_proportional,
                           const LoadFactors last_factors,
                           const VectorView &start,
                           const LoadFactors factors)
      {
        // What is prescribed on the contact boundary changes the springs'
        // forces.
        if (!scene.problem()
               .unknowns()
               .contact()
               .boundary()
               .held_vertices.empty())
          return {};
        if (is_proportional)
          {
            const double whole        = factors.loads / last_factors.loads - 1.;
            const Eigen::VectorXd way = whole * start;
            const double          part = bonds->first_change(start, way, 1.);
            if (part == 1.)
              return {};
            return factor_between(last_factors, factors, part);
          }

        const Eigen::VectorXd             load    = load_at(last_factors);
        const Eigen::VectorXd             slope   = load_at(factors) - load;
        const Eigen::SparseMatrix<double> springs = bonds->curvature(start);
        Eigen::MatrixXd stiffness = condensed->schur_complement();
        stiffness += springs;
        const BranchMinimum   no_law({{0., 0., 0., ""}});
        const Eigen::VectorXd spring_load =
          load - bonds->subgradient(start) + springs * start;
        StationaryPath path(stiffness,
                            spring_load,
                            slope,
                            no_law,
                            std::vector<StationaryPath::Bond>(start.size(),
                                                              {0., 1., 0}),
                            true,
                            start,
                            0.);
        using Event = StationaryPath::Event;
        Event event = Event::contact;
        for (unsigned int k = 0;
             event == Event::contact && k < 2 * load.size() && may_go_on();
             ++k)
          {
            const Eigen::VectorXd before = path.point();
            const double          t      = path.t();
            event                        = path.advance(0., 1.);
            if (event != Event::contact && event != Event::end)
              return {};
            const double part =
              bonds->first_change(before, path.point() - before, 1.);
            if (part < 1.)
              return factor_between(last_factors,
                                    factors,
                                    t + part * (path.t() - t));
          }
        return {};
      }

      /// The same if displacements are proportional to the factor.
      std::optional<double>
      proportional_change(const double      last_factor,
                          const VectorView &last,
                          const double      factor) const
      {
        const BranchMinimum &branches  = scene.law().branches();
        double               first     = factor / last_factor;
        const bool           increases = first > 1.;
        bool                 changes   = false;
        for (unsigned int i = 0; i < last.size(); ++i)
          if (last(i) < 0.)
            {
              const double       stretch = bonds->bonds_at(i).stretch;
              const unsigned int k       = branches.index(last(i) / stretch);
              if (increases ? k + 1 == branches.size() :
                              k <= bonds->least_piece(i))
                continue;
              const double reached =
                stretch * (increases ? branches[k].lower : branches[k].upper) /
                last(i);
              if (increases ? reached < first : reached > first)
                {
                  changes = true;
                  first   = reached;
                }
            }
        return changes ? std::optional<double>(first * last_factor) :
                         std::nullopt;
      }

      /// Enters a point of the global branch at all steps with its factor.
      void
      add_global(const double factor, const BranchPoint &point)
      {
        const CondensedScene<dim>   condensed_scene = {scene, *condensed};
        const AdhesionIntegral<dim> bonds_there = condensed_scene.bonds(factor);
        DofVector           u = condensed_scene.at(factor).expand(point.s);
        CondensedCorrection correction(*condensed);
        note(refine_where_needed(
          scene.problem(), bonds_there, factor, correction, may_go_on, u));
        const Verification<dim> verification = verify(factor, bonds_there, u);
        LoadPathState<dim> global = state(factor, bonds_there, u, verification);
        const bool         verified = is_verified(verification);
        if (verified)
          global.minimum = to_string(point.which.kind);
        for (unsigned int k = 0; k < steps.size(); ++k)
          if (steps[k].factor == factor)
            {
              LoadPathStep<dim> &step = steps[k];
              step.global             = global;
              if (point.which.proof_attempted)
                step.relative_gap = point.which.relative_gap;
              if (!verified && step.message.empty())
                step.message =
                  location(step) + "global branch: " + failure(verification);
              // The followed state is this one, or as good.
              if (step.message.empty() &&
                  step.state.functional <=
                    global.functional + solver_parameters.proof.tolerance *
                                          std::abs(global.functional))
                {
                  kinds[k]           = point.which.kind;
                  step.state.minimum = global.minimum;
                }
            }
      }

      void
      interrupt(const std::string &what)
      {
        result.status  = SolverStatus::interrupted;
        result.message = location(steps.back()) + "interrupted, " + what;
      }

      void
      print_titles(const std::string &third) const
      {
        if (out == nullptr)
          return;
        print_factors<const char *>("factor", "displacement factor");
        *out << std::setw(17) << "J" << std::setw(14) << third << "  state"
             << std::endl;
      }

      /// Those that vary, or their titles.
      template <typename Entry>
      void
      print_factors(const Entry &of_loads, const Entry &of_displacements) const
      {
        if (!parameters.moves_only())
          *out << std::setw(11) << of_loads;
        if (!parameters.displacement_factors.empty())
          *out << std::setw(21) << of_displacements;
      }

      void
      print(const LoadFactors &factors,
            const double       functional,
            const double       number,
            const std::string &word) const
      {
        if (out == nullptr)
          return;
        print_factors(factors.loads, factors.displacements);
        *out << std::scientific << std::setprecision(8) << std::setw(17)
             << functional << std::defaultfloat << std::setprecision(3)
             << std::setw(14) << number << std::setprecision(6) << "  " << word
             << std::endl;
      }

      const LoadPathParameters &parameters;
      const SolverParameters   &solver_parameters;
      const double              tolerance; ///< of the verification
      const Scene<dim>         &scene;
      std::ostream             *out;
      const InterruptGuard      guard;
      dealii::Timer             timer;
      SolveResult               result;

      const std::function<bool()> may_go_on = [this]() {
        return !guard.requested();
      };

      /// At the last factors, with what broke for good.
      std::unique_ptr<AdhesionIntegral<dim>> bonds;

      const std::unique_ptr<ContactSolver<dim>> solver;
      const Condensation *const condensed; ///< null with multigrid

      /// By step.
      std::vector<Eigen::VectorXd> points;
      std::vector<MinimumKind>     kinds;
    };
  } // namespace



  template <int dim>
  FollowedPath<dim>
  follow_load_path(const LoadPathParameters    &parameters,
                   const SolveSettings         &settings,
                   const Scene<dim>            &scene,
                   const LoadPathObserver<dim> &observer,
                   std::ostream                *out)
  {
    FollowedPath<dim> followed;
    PathFollower<dim> path(parameters, settings, scene, out);
    path.follow([&](const LoadPathStep<dim>     &step,
                    const DofVector             &u,
                    const Verification<dim>     &verification,
                    const AdhesionIntegral<dim> &bonds) {
      followed.bonds = std::make_shared<const AdhesionIntegral<dim>>(bonds);
      observer(step, u, verification, bonds);
    });
    // Where only bonds hold the body J may fall without end.
    const bool has_branch =
      path.has_condensed() && parameters.has_global_branch() &&
      scene.problem().unknowns().held_by_contact().motions.empty();
    const bool is_whole =
      !path.steps.empty() && path.steps.back().message.empty();
    const bool wants_branch = parameters.global_branch != GlobalBranch::none;
    if (wants_branch && has_branch && is_whole)
      path.find_global_branch();
    if (parameters.arc && is_whole)
      path.find_arc(followed.arc);
    followed.result = path.take_result();
    if (wants_branch && !has_branch)
      followed.result.notes.push_back(
        "There is no global branch: it is for one factor, bonds that heal, a "
        "direct linear solver and bodies that not only bonds and the "
        "foundation hold.");
    followed.steps = std::move(path.steps);
    return followed;
  }



  template decltype(follow_load_path<2>) follow_load_path<2>;
  template decltype(follow_load_path<3>) follow_load_path<3>;
} // namespace Debond
