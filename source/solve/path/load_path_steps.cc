// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/solve/path/load_path_steps.h>

namespace Debond
{
  template <int dim>
  std::string
  location(const LoadPathParameters &parameters, const LoadPathStep<dim> &step)
  {
    return "load path, step " + std::to_string(step.step) + ", " +
           parameters.name(step.factors()) + ": ";
  }



  template <int dim>
  void
  interrupt(const LoadPathParameters &parameters,
            const LoadPathStep<dim>  &step,
            const std::string        &what,
            Solution                 &result)
  {
    result.status  = SolverStatus::interrupted;
    result.message = location(parameters, step) + "interrupted, " + what;
  }



  template <int dim>
  VerifiedState<dim>::VerifiedState(const Scene<dim>            &scene,
                                    const AdhesionIntegral<dim> &bonds,
                                    const LoadFactors            factors,
                                    const DofVector             &u)
    : verification(
        verify(scene.problem(), bonds, u, factors, scene.least_force()))
    , state(load_path_state(scene.problem(), bonds, factors, u, verification))
  {
    // A state is verified before it is turned into numbers, since these are of
    // the branches that the verification finds. Means over named pieces and
    // probes follow the reactions in the list of vectors, whose titles are
    // columns of the table.
    const auto add = [&](const std::string &kind, const Probes<dim> &probes) {
      for (const auto &[name, vector] :
           probes.values(scene.problem(), u, factors))
        state.vectors.emplace_back(kind + as_title(name), vector);
    };
    add("mean_", scene.means());
    add("probe_", scene.probes());
  }



  template <int dim>
  LoadPathStep<dim>
  step_of(const VerifiedState<dim> &state,
          const unsigned int        k,
          const LoadFactors         factors)
  {
    LoadPathStep<dim> step   = {};
    step.step                = k;
    step.factor              = factors.loads;
    step.displacement_factor = factors.displacements;
    step.state               = state.state;
    return step;
  }



  template <int dim>
  BondMemory
  memory_at_rest(const Scene<dim> &scene)
  {
    const ElasticUnknowns<dim> &unknowns = scene.problem().unknowns();
    if (!unknowns.has_gap())
      return {};
    AdhesionIntegral<dim> bonds = scene.adhesion().at(0.);
    bonds.break_for_good(unknowns.contact().at_rest());
    return bonds.memory();
  }



  void
  note_breaks(const double                         factor,
              const std::vector<ContactNodeState> &nodes,
              std::vector<BondBreak>              &breaks)
  {
    breaks.resize(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (const ContactNodeState &node = nodes[i];
          std::max(node.damage, node.shear_damage) < AdhesiveLaw::broken_damage)
        breaks[i] = {};
      else if (!breaks[i].factor)
        breaks[i] = {factor, node.mode_mixity};
  }



  template <int dim>
  void
  refine_state(const Scene<dim>            &scene,
               const AdhesionIntegral<dim> &bonds,
               const LoadFactors            factors,
               CorrectionSolver            &correction,
               DofVector                   &u,
               Solution                    &result)
  {
    const Refined refined = refine_where_needed(
      scene, bonds, factors, correction, Interruption::by_signal(), u);
    result.is_refined = refined.is_refined;
    if (!refined.note.empty() && result.notes.empty())
      result.notes.push_back(refined.note);
  }



  template <int dim>
  LoadPathTotals
  load_path_totals(const std::vector<LoadPathStep<dim>> &steps,
                   const unsigned int                    n_factors)
  {
    LoadPathTotals totals;
    totals.factors = n_factors;
    totals.steps   = static_cast<unsigned int>(steps.size());
    totals.last    = steps.back().factors();

    // The broken part of a step is compared with that of the step before, and
    // that of the first one with zero. The largest growth and the largest fall
    // are those of the jumps of a path; what differs by the rounding of
    // decimals is no change.
    double broken = 0.;
    for (const LoadPathStep<dim> &step : steps)
      {
        const BondChange change = {step.step,
                                   step.factor,
                                   step.displacement_factor,
                                   broken,
                                   step.state.broken_part};
        const double     growth = change.broken_after - change.broken_before;
        const auto       size   = [](const std::optional<BondChange> &other) {
          return other ? std::abs(other->broken_after - other->broken_before) :
                                 Tolerance::decimals;
        };
        if (growth > size(totals.largest_break))
          totals.largest_break = change;
        if (-growth > size(totals.largest_closing))
          totals.largest_closing = change;
        broken = change.broken_after;

        // The followed state may be above the lowest one known at its factor,
        // beyond rounding: there the path has stayed in a minimum that is not
        // global.
        if (step.global)
          {
            const double excess =
              step.state.functional - step.global->functional;
            const double scale = std::abs(step.global->functional);
            ++totals.compared;
            if (excess > Tolerance::decimals * scale)
              {
                ++totals.above_global;
                totals.largest_excess =
                  std::max(totals.largest_excess, excess / scale);
              }
          }
      }
    return totals;
  }


  DEBOND_INSTANTIATE(location);
  DEBOND_INSTANTIATE(interrupt);
  DEBOND_INSTANTIATE(refine_state);
  DEBOND_INSTANTIATE(step_of);
  DEBOND_INSTANTIATE(memory_at_rest);
  DEBOND_INSTANTIATE_CLASS(VerifiedState);
  DEBOND_INSTANTIATE(load_path_totals);
} // namespace Debond
