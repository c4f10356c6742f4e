// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/instantiate.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/solve/path/branch_of_path.h>
#include <debond/solve/path/global_branch.h>

#include <set>

namespace Debond
{
  namespace
  {
    /// What a step takes beside the minimisation, mostly for its verification:
    /// at least, and for each unknown, in the time of a factorisation's
    /// operations.
    constexpr double least_of_step = 1e7, of_step = 4000.;



    /// As a factorisation, a factor of S for each majorant, and what steps
    /// take besides. It is the same if the path was cut in two runs.
    template <int dim>
    double
    operations_of(const Answer<dim> &answer)
    {
      const std::vector<LoadPathStep<dim>> &steps       = answer.path.steps;
      double                                n_majorants = 0.;
      for (const LoadPathStep<dim> &step : steps)
        n_majorants += step.iterations;
      return answer.choice.operations +
             n_majorants / 3. *
               std::pow(double(answer.path.points[0].size()), 3.) +
             double(steps.size()) *
               (least_of_step +
                of_step * double(answer.scene->problem().unknowns().n_dofs()));
    }



    /// The followed states are where the branch starts from. A path may come to
    /// a factor several times, when it unloads, and then the lowest of its
    /// states is taken.
    template <int dim>
    Branch
    lowest_states(const CondensedScene<dim> &condensed,
                  const PathProgress<dim>   &path)
    {
      Branch followed;
      for (unsigned int k = 0; k < path.steps.size(); ++k)
        {
          const LoadFactors factors = path.steps[k].factors();
          const BranchPoint point   = {
              path.points[k],
              condensed_functional(condensed_problem(condensed.at(factors),
                                                   condensed.bonds(factors)),
                                 path.points[k]),
              {}};
          const auto [entry, is_new] = followed.emplace(factors, point);
          if (!is_new && point.functional < entry->second.functional)
            entry->second = point;
        }
      return followed;
    }



    /// Both energies of a step are sums that are rounded relative to J at the
    /// largest factor: without loads J is nothing but that rounding.
    template <int dim>
    double
    rounding_of_path(const std::vector<LoadPathStep<dim>> &steps)
    {
      double largest = 0.;
      for (const LoadPathStep<dim> &step : steps)
        largest = std::max(largest, std::abs(step.state.functional));
      return Tolerance::epsilon * largest;
    }



    /// The states of the branch of one path, which it enters at the steps.
    template <int dim>
    class BranchStates
    {
    public:
      BranchStates(const CondensedScene<dim> &condensed,
                   const SolveSettings       &settings,
                   const PathTable           &table,
                   CorrectionSolver          &correction,
                   Answer<dim>               &answer)
        : condensed(condensed)
        , parameters(condensed.scene.parameters().load_path)
        , settings(settings)
        , table(table)
        , correction(correction)
        , answer(answer)
      {}

      /// The lowest minima, of bonds that heal.
      void
      find_branch(const SolverParameters &limited)
      {
        const Branch branch = global_branch(
          parameters.global_branch,
          limited,
          condensed,
          lowest_states(condensed, answer.path),
          Interruption::by_signal(),
          [this](const LoadFactors factors, const BranchPoint &point) {
            tell(factors,
                 point.functional + condensed.at(factors).energy_at_zero(),
                 point.which);
          });
        for (const auto &[unused, point] : branch)
          note(point.which);
        for (const auto &[factors, point] : branch)
          enter_point(factors, point);
      }

      /// The energetic path, of bonds that do not. Its words stay its own,
      /// since states of the followed path are minima with another memory.
      void
      find_energetic_path(const SolverParameters &limited)
      {
        std::vector<std::pair<LoadFactors, Eigen::VectorXd>> starts;
        for (unsigned int k = 0; k < steps.size(); ++k)
          starts.emplace_back(steps[k].factors(), answer.path.points[k]);
        energetic_path<dim>(limited,
                            condensed,
                            starts,
                            Interruption::by_signal(),
                            [this](const unsigned int     k,
                                   const BranchPoint     &point,
                                   AdhesionIntegral<dim> &bonds) {
                              const VerifiedState<dim> state =
                                state_at(steps[k].factors(), point.s, bonds);
                              tell(steps[k].factors(),
                                   state.state.functional,
                                   point.which);
                              note(point.which);
                              enter(state, point.which, steps[k]);
                              return steps[k].message.empty();
                            });
        // The words of later steps depend on the first one without a proof.
        const auto unproved =
          std::find_if(steps.begin(), steps.end(), [](const auto &step) {
            return step.global &&
                   step.global->minimum != to_string(MinimumKind::global);
          });
        if (parameters.global_branch == GlobalBranch::prove &&
            unproved != steps.end())
          answer.solution.notes.push_back(
            location(parameters, *unproved) +
            "the energetic path is not proved here, and later states of it are "
            "called best known at most, as they depend on this one");
      }

      /// What limits of work have left undone is said once for all factors, and
      /// what else a search or a proof notes once as well.
      void
      tell_notes() const
      {
        std::vector<std::string> &notes = answer.solution.notes;
        notes.insert(notes.end(), others.begin(), others.end());
        if (n_cut > 0)
          table.section(words("the search had as much work as the path takes, "
                              "which was not enough at ",
                              n_cut,
                              " of ",
                              n_states,
                              " factors; Load path/Global branch = search has "
                              "no limit"));
      }

    private:
      const CondensedScene<dim>      &condensed;
      const LoadPathParameters       &parameters;
      const SolveSettings            &settings;
      const PathTable                &table;
      CorrectionSolver               &correction;
      Answer<dim>                    &answer;
      std::vector<LoadPathStep<dim>> &steps = answer.path.steps;

      unsigned int          n_states = 0, n_cut = 0;
      std::set<std::string> others;

      void
      tell(const LoadFactors   factors,
           const double        functional,
           const WhichMinimum &which) const
      {
        table.row(factors,
                  functional,
                  parameters.global_branch == GlobalBranch::prove ?
                    std::stod(scientific_above(which.relative_gap, 2)) :
                    which.search_trials,
                  to_string(which.kind));
      }

      void
      note(const WhichMinimum &which)
      {
        ++n_states;
        if (which.is_cut)
          ++n_cut;
        else
          others.insert(which.notes.begin(), which.notes.end());
      }

      /// The state at @p s, refined and verified as one of the path is. What
      /// does not heal breaks for good there.
      VerifiedState<dim>
      state_at(const LoadFactors      factors,
               const Eigen::VectorXd &s,
               AdhesionIntegral<dim> &bonds)
      {
        const Scene<dim> &scene = condensed.scene;
        DofVector         u     = condensed.at(factors).expand(s);
        refine_state(scene, bonds, factors, correction, u, answer.solution);
        if (!parameters.bonds_heal)
          bonds.break_for_good(scene.contact_trace(u));
        return {scene, bonds, factors, u};
      }

      void
      enter(const VerifiedState<dim> &state,
            const WhichMinimum       &which,
            LoadPathStep<dim>        &step) const
      {
        const bool is_verified =
          state.verification.error() <= settings.tolerance;
        step.global = state.state;
        if (is_verified)
          step.global->minimum = to_string(which.kind);
        if (which.proof_attempted)
          step.relative_gap = which.relative_gap;
        if (!is_verified && step.message.empty())
          step.message = location(parameters, step) + "global branch: " +
                         state.verification.failure(settings.tolerance, false);
      }

      /// At all steps with its factors.
      void
      enter_point(const LoadFactors factors, const BranchPoint &point)
      {
        AdhesionIntegral<dim>    bonds = condensed.bonds(factors);
        const VerifiedState<dim> state = state_at(factors, point.s, bonds);
        const double             least = state.state.functional;
        const double             allowed =
          rounding_of_path(steps) +
          settings.parameters.proof.tolerance * std::abs(least);
        for (unsigned int k = 0; k < steps.size(); ++k)
          if (steps[k].factors() == factors)
            {
              LoadPathStep<dim> &step = steps[k];
              enter(state, point.which, step);
              // The followed state is this one, or as good: it gets the word of
              // the search or of the proof.
              if (step.message.empty() &&
                  step.state.functional <= least + allowed)
                {
                  answer.path.kinds[k] = point.which.kind;
                  step.state.minimum   = step.global->minimum;
                }
            }
      }
    };
  } // namespace



  template <int dim>
  void
  enter_global_branch(const CondensedScene<dim> &condensed,
                      const SolveSettings       &settings,
                      const PathTable           &table,
                      CorrectionSolver          &correction,
                      Answer<dim>               &answer)
  {
    const Stage               stage("global branch");
    const dealii::Timer       timer;
    const LoadPathParameters &parameters =
      condensed.scene.parameters().load_path;

    table.section(parameters.bonds_heal ? "global branch" : "energetic path");
    table.titles(
      parameters.global_branch == GlobalBranch::prove ? "gap" : "states tried");
    // A search that was not asked for takes no longer than the path. Its work
    // is counted in operations, so that its result does not depend on the
    // machine.
    SolverParameters limited = settings.parameters;
    if (parameters.global_branch == GlobalBranch::automatic)
      limited.search_operations = operations_of(answer);
    BranchStates<dim> states(condensed, settings, table, correction, answer);
    if (parameters.bonds_heal)
      states.find_branch(limited);
    else
      states.find_energetic_path(limited);
    states.tell_notes();
    if (Interruption::by_signal().requested())
      interrupt(parameters,
                answer.path.steps.back(),
                "the global branch is not complete",
                answer.solution);
    answer.solution.parts["global branch"] = timer.wall_time();
  }



  DEBOND_INSTANTIATE(enter_global_branch);
} // namespace Debond
