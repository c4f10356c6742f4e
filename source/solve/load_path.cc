// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/interrupt.h>
#include <debond/base/run_watch.h>
#include <debond/base/text.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/elasticity/refinement.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/optimization/stationary_path.h>
#include <debond/solve/global_branch.h>
#include <debond/solve/load_path.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

namespace Debond
{
  namespace
  {
    template <int dim>
    class PathFollower
    {
    public:
      PathFollower(const LoadPathParameters       &parameters,
                   const SolverParameters         &solver,
                   const double                    tolerance,
                   const Scene<dim>               &scene,
                   std::ostream                   *out,
                   std::vector<LoadPathStep<dim>> &steps)
        : parameters(parameters)
        , solver_parameters(solver)
        , tolerance(tolerance)
        , scene(scene)
        , out(out)
        , steps(steps)
        , adhesion(scene.adhesion())
        , condensed(condense_to_contact(scene.problem(), adhesion))
        , free_motions(free_motions_of_contact(scene.problem().unknowns()))
        , s(scene.problem().unknowns().contact().at_rest())
      {
        if (free_motions.cols() == 0)
          result.condition_estimate = condensed.condition_estimate();
        result.parts["condensation"] = timer.wall_time();
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

      /// Of a path without failures.
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
        Branch followed;
        for (unsigned int k = 0; k < steps.size(); ++k)
          {
            const double factor = steps[k].factor;
            scale_load(factor);
            const BranchPoint point    = {points[k],
                                          condensed_functional(condensed,
                                                            adhesion,
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
          scene,
          followed,
          [this]() { return !guard.requested(); },
          [&](const double factor, const BranchPoint &point) {
            scale_load(factor);
            print(factor,
                  point.functional + condensed.energy_at_zero(),
                  proves ?
                    std::stod(scientific_above(point.which.relative_gap, 2)) :
                    point.which.search_trials,
                  to_string(point.which.kind));
          },
          adhesion,
          condensed);
        for (const auto &[factor, point] : branch)
          add_global(factor, point);
        if (guard.requested())
          interrupt("the global branch is not complete");
        result.parts["global branch"] = timer.wall_time();
      }

      /// From the state of the first factor.
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
        AdhesionIntegral<dim> bonds(scene.adhesion());
        const Eigen::VectorXd load = load_at(factors_at(varied[0]));
        const Eigen::VectorXd slope =
          (load_at(factors_at(*other)) - load) / std::abs(*other - varied[0]);
        StationaryPath path(condensed.schur_complement(),
                            load,
                            slope,
                            scene.law().branches(),
                            bonds_of_nodes(bonds),
                            parameters.bonds_heal,
                            points[0],
                            sign * varied[0]);
        const auto     add = [&](const bool is_stable) {
          const LoadFactors factors = factors_at(sign * path.t() + 0.); // no -0
          bonds.scale_load(factors.displacements);
          if (!parameters.bonds_heal)
            bonds.break_for_good(path.point_before_kinks());
          scale_load(factors);
          const DofVector         u = condensed.expand(path.point());
          const Verification<dim> verification =
            Debond::verify(scene.problem(), bonds, scene.law(), u, factors);
          LoadPathStep<dim> step = {};
          step.step   = static_cast<unsigned int>(arc.size() + 1);
          step.factor = factors.loads;
          step.displacement_factor = factors.displacements;
          step.status              = is_stable ? "stable" : "unstable";
          step.state               = load_path_state(scene.problem(),
                                       bonds,
                                       scene.means(),
                                       scene.probes(),
                                       factors,
                                       u,
                                       verification);
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
        const Eigen::Index most     = 100 + 20 * s.size();
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
        const LoadFactors factors = steps.back().factors();
        scale_load(factors);
        result.load_factor  = factors;
        result.u            = displacement(factors, points.back());
        result.functional   = steps.back().state.functional;
        result.minimum.kind = kinds.back();
        return result;
      }

    private:
      void
      scale_load(const LoadFactors factors)
      {
        adhesion.scale_load(factors.displacements);
        condensed.scale_load(factors.loads, factors.displacements);
      }

      /// Returns whether there is a next step: not if the body comes off.
      bool
      solve(const LoadFactors factors, const LoadPathObserver<dim> &observer)
      {
        const Stage           stage("load path, step " +
                          std::to_string(steps.size() + 1) + ", " +
                          parameters.name(factors));
        const Eigen::VectorXd last = s;

        scale_load(factors);
        const Eigen::VectorXd load =
          load_at_contact(scene.problem(), condensed, factors, free_motions);
        CondensedProblem             problem(condensed.schur_complement(),
                                 load,
                                 adhesion,
                                 s,
                                 free_motions,
                                 stiffness_at_contact(scene.problem()));
        const MajoriseMinimiseResult minimum =
          MajoriseMinimise(solver_parameters.majorise_minimise)
            .minimize(problem,
                      [this](const auto &) { return !guard.requested(); });
        if (minimum.status == SolverStatus::interrupted && !steps.empty())
          {
            s = last;
            interrupt("the path is not complete");
            return false;
          }
        result.status    = minimum.status;
        result.criterion = minimum.residual;
        for (MajoriseMinimiseIteration iteration : minimum.history)
          {
            iteration.iteration = ++result.iterations;
            iteration.functional += condensed.energy_at_zero();
            result.majorise_history.push_back(iteration);
          }

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
            change_factor(steps.back().factors(), last, factors);
        if (!parameters.bonds_heal)
          {
            adhesion.break_for_good(s);
            scale_load(factors);
          }
        const DofVector         u            = displacement(factors, s);
        const Verification<dim> verification = verify(factors, u);
        step.state                           = state(factors, u, verification);
        step.status                          = to_string(minimum.status);
        kinds.push_back(kind_without_search(scene.law(), adhesion, s));
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
        observer(step, u, verification, adhesion);
        return true;
      }

      /// Of all unknowns, refined where rounding has a say in it.
      DofVector
      displacement(const LoadFactors factors, const VectorView &point)
      {
        DofVector           u = condensed.expand(point);
        CondensedCorrection solver(condensed);
        const Refined       refined = refine_where_needed(
          scene.problem(),
          adhesion,
          factors,
          solver,
          [this]() { return !guard.requested(); },
          u);
        result.is_refined = refined.is_refined;
        if (!refined.note.empty() && result.notes.empty())
          result.notes.push_back(refined.note);
        return u;
      }

      Verification<dim>
      verify(const LoadFactors factors, const DofVector &u) const
      {
        return Debond::verify(
          scene.problem(), adhesion, scene.law(), u, factors);
      }

      LoadPathState<dim>
      state(const LoadFactors        factors,
            const DofVector         &u,
            const Verification<dim> &verification) const
      {
        return load_path_state(scene.problem(),
                               adhesion,
                               scene.means(),
                               scene.probes(),
                               factors,
                               u,
                               verification);
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
      load_at(const LoadFactors factors)
      {
        condensed.scale_load(factors.loads, factors.displacements);
        return condensed.load();
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
        if (!adhesion.is_separable())
          return change_between_nodes(is_proportional,
                                      last_factors,
                                      last,
                                      factors);
        if (is_proportional)
          return proportional_change(last_factors.loads, last, factors.loads);

        const Eigen::VectorXd load  = load_at(last_factors);
        const Eigen::VectorXd slope = load_at(factors) - load;
        StationaryPath        path(condensed.schur_complement(),
                            load,
                            slope,
                            branches,
                            bonds_of_nodes(adhesion),
                            parameters.bonds_heal,
                            last,
                            0.);
        // Contact that comes and goes. Changes at the end of the step count.
        using Event = StationaryPath::Event;
        Event event = Event::contact;
        for (unsigned int k = 0;
             event == Event::contact && k < 2 * s.size() && !guard.requested();
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
            const double          part = adhesion.first_change(start, way, 1.);
            if (part == 1.)
              return {};
            return factor_between(last_factors, factors, part);
          }

        const Eigen::VectorXd             load  = load_at(last_factors);
        const Eigen::VectorXd             slope = load_at(factors) - load;
        const Eigen::SparseMatrix<double> bonds = adhesion.curvature(start);
        Eigen::MatrixXd stiffness               = condensed.schur_complement();
        stiffness += bonds;
        const BranchMinimum   no_law({{0., 0., 0., ""}});
        const Eigen::VectorXd spring_load =
          load - adhesion.subgradient(start) + bonds * start;
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
             event == Event::contact && k < 2 * s.size() && !guard.requested();
             ++k)
          {
            const Eigen::VectorXd before = path.point();
            const double          t      = path.t();
            event                        = path.advance(0., 1.);
            if (event != Event::contact && event != Event::end)
              return {};
            const double part =
              adhesion.first_change(before, path.point() - before, 1.);
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
              const double       stretch = adhesion.bonds_at(i).stretch;
              const unsigned int k       = branches.index(last(i) / stretch);
              if (increases ? k + 1 == branches.size() :
                              k <= adhesion.least_piece(i))
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
        scale_load(factor);
        const DofVector         u            = displacement(factor, point.s);
        const Verification<dim> verification = verify(factor, u);
        LoadPathState<dim>      global       = state(factor, u, verification);
        const bool              verified     = is_verified(verification);
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

      const LoadPathParameters       &parameters;
      const SolverParameters         &solver_parameters;
      const double                    tolerance; ///< of the verification
      const Scene<dim>               &scene;
      std::ostream                   *out;
      std::vector<LoadPathStep<dim>> &steps;
      const InterruptGuard            guard;
      dealii::Timer                   timer;
      AdhesionIntegral<dim>           adhesion;
      Condensation                    condensed;
      const Eigen::MatrixXd           free_motions;
      Eigen::VectorXd                 s;
      SolveResult                     result;

      /// By step.
      std::vector<Eigen::VectorXd> points;
      std::vector<MinimumKind>     kinds;
    };
  } // namespace



  template <int dim>
  SolveResult
  follow_load_path(const LoadPathParameters       &parameters,
                   const SolverParameters         &solver,
                   const double                    verification_tolerance,
                   const Scene<dim>               &scene,
                   const LoadPathObserver<dim>    &observer,
                   std::ostream                   *out,
                   std::vector<LoadPathStep<dim>> &steps,
                   std::vector<LoadPathStep<dim>> &arc)
  {
    PathFollower<dim> path(
      parameters, solver, verification_tolerance, scene, out, steps);
    path.follow(observer);
    const bool is_wanted = parameters.global_branch != GlobalBranch::none;
    // Where only bonds hold the body J may fall without end.
    const bool has_branch =
      parameters.has_global_branch() &&
      scene.problem().unknowns().held_by_contact().motions.empty();
    if (is_wanted && has_branch && !steps.empty() &&
        steps.back().message.empty())
      path.find_global_branch();
    if (parameters.arc && !steps.empty() && steps.back().message.empty())
      path.find_arc(arc);
    SolveResult result = path.take_result();
    if (is_wanted && !has_branch)
      result.notes.push_back(
        "There is no global branch: it is for one factor, bonds that heal and "
        "bodies that not only bonds and the foundation hold.");
    return result;
  }



  template decltype(follow_load_path<2>) follow_load_path<2>;
  template decltype(follow_load_path<3>) follow_load_path<3>;
} // namespace Debond
