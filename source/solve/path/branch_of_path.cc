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



    /// Enters a point of the global branch at all steps with its factors.
    template <int dim>
    void
    enter_point(const CondensedScene<dim> &condensed,
                const SolveSettings       &settings,
                const Branch::value_type  &entry,
                CorrectionSolver          &correction,
                Answer<dim>               &answer)
    {
      // A point of the branch is refined and verified as a state of the path
      // is. Its bonds have no memory, as there is a branch only for bonds that
      // heal.
      const auto &[factors, point]      = entry;
      const AdhesionIntegral<dim> bonds = condensed.bonds(factors);
      DofVector                   u     = condensed.at(factors).expand(point.s);
      refine_state(
        condensed.scene, bonds, factors, correction, u, answer.solution);
      const VerifiedState<dim> state(condensed.scene, bonds, factors, u);
      LoadPathState<dim>       global = state.state;
      const bool is_verified = state.verification.error() <= settings.tolerance;
      if (is_verified)
        global.minimum = to_string(point.which.kind);
      std::vector<LoadPathStep<dim>> &steps = answer.path.steps;
      const double                    allowed =
        rounding_of_path(steps) +
        settings.parameters.proof.tolerance * std::abs(global.functional);
      for (unsigned int k = 0; k < steps.size(); ++k)
        if (steps[k].factors() == factors)
          {
            LoadPathStep<dim> &step = steps[k];
            step.global             = global;
            if (point.which.proof_attempted)
              step.relative_gap = point.which.relative_gap;
            if (!is_verified && step.message.empty())
              step.message =
                location(condensed.scene.parameters().load_path, step) +
                "global branch: " +
                state.verification.failure(settings.tolerance, false);
            // The followed state is this one, or as good: it gets the word of
            // the search or of the proof.
            if (step.message.empty() &&
                step.state.functional <= global.functional + allowed)
              {
                answer.path.kinds[k] = point.which.kind;
                step.state.minimum   = global.minimum;
              }
          }
    }
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
    const Interruption       &interruption = Interruption::by_signal();
    const LoadPathParameters &parameters =
      condensed.scene.parameters().load_path;
    Solution &result = answer.solution;

    table.section("global branch");
    const bool proves = parameters.global_branch == GlobalBranch::prove;
    table.titles(proves ? "gap" : "states tried");
    // A search that was not asked for takes no longer than the path. Its work
    // is counted in operations, so that its result does not depend on the
    // machine.
    SolverParameters limited = settings.parameters;
    if (parameters.global_branch == GlobalBranch::automatic)
      limited.search_operations = operations_of(answer);
    const Branch branch = global_branch(
      parameters.global_branch,
      limited,
      condensed,
      lowest_states(condensed, answer.path),
      interruption,
      [&](const LoadFactors factors, const BranchPoint &point) {
        table.row(factors,
                  point.functional + condensed.at(factors).energy_at_zero(),
                  proves ?
                    std::stod(scientific_above(point.which.relative_gap, 2)) :
                    point.which.search_trials,
                  to_string(point.which.kind));
      });
    // What limits of work have left undone is said once for all factors, and
    // what else a search or a proof notes once as well.
    unsigned int          n_cut = 0;
    std::set<std::string> others;
    for (const auto &[factors, point] : branch)
      if (point.which.is_cut)
        ++n_cut;
      else
        others.insert(point.which.notes.begin(), point.which.notes.end());
    result.notes.insert(result.notes.end(), others.begin(), others.end());
    if (n_cut > 0)
      table.section(words("the search had as much work as the path takes, "
                          "which was not enough at ",
                          n_cut,
                          " of ",
                          branch.size(),
                          " factors; Load path/Global branch = search has no "
                          "limit"));
    for (const auto &entry : branch)
      enter_point(condensed, settings, entry, correction, answer);
    if (interruption.requested())
      interrupt(parameters,
                answer.path.steps.back(),
                "the global branch is not complete",
                result);
    result.parts["global branch"] = timer.wall_time();
  }



  DEBOND_INSTANTIATE(enter_global_branch);
} // namespace Debond
