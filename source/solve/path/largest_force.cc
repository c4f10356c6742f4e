// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/solve/path/largest_force.h>

#include <algorithm>

namespace Debond
{
  namespace
  {
    /// A step is halved so often at most.
    constexpr unsigned int most_halvings = 16;

    /// The part of a step that tells the slope of the force at its beginning.
    constexpr double part_for_slope = 1e-5;



    /// Forces to what all bonds could bear: less is rounding, or of no
    /// interest.
    constexpr double negligible_force = 1e-9;



    /// What all bonds could bear at once.
    template <int dim>
    double
    capacity(const AdhesionIntegral<dim> &adhesion)
    {
      double      sum   = 0.;
      const auto &nodes = adhesion.contact_boundary().nodes;
      for (unsigned int i = 0; i < nodes.size(); ++i)
        if (const BondScale bonds = adhesion.points().bonds_at(i);
            bonds.energy > 0.)
          sum += bonds.law->bond_strength() * bonds.energy / bonds.length *
                 nodes[i].measure;
      return sum;
    }



    LoadFactors
    between(const LoadFactors first, const LoadFactors last, const double part)
    {
      return {first.loads + part * (last.loads - first.loads),
              first.displacements +
                part * (last.displacements - first.displacements)};
    }



    /// A body is not as stiff when pushed as when pulled, so that no slope
    /// holds beyond 0.
    bool
    crosses_zero(const LoadFactors first, const LoadFactors last)
    {
      return first.displacements * last.displacements < 0.;
    }



    /// Enters the @p bound of the force inside of a part of a step.
    template <int dim>
    void
    extend(const double bound, LoadPathPeak<dim> &peak)
    {
      if (peak.bound)
        *peak.bound = std::max(*peak.bound, bound);
    }



    template <int dim>
    void
    compare(const LoadPathStep<dim> &step, LoadPathPeak<dim> &peak)
    {
      if (std::abs(step.state.unit_displacement_work) > peak.force())
        peak.step = step;
      extend(std::abs(step.state.unit_displacement_work), peak);
    }
  } // namespace



  template <int dim>
  LargestForce<dim>::LargestForce(const Scene<dim> &scene, const GoTo &go_to)
    : scene(scene)
    , go_to(go_to)
    , is_homogeneous(
        !scene.problem().unknowns().has_gap() &&
        scene.adhesion().friction().empty() &&
        scene.problem().fields().applied_nodal_forces().linfty_norm() == 0.)
    , is_bounded(is_homogeneous && !scene.parameters().load_path.bonds_heal &&
                 !scene.adhesion().points().depends_on_mode())
    , noise(negligible_force * capacity(scene.adhesion()) *
            scene.problem().unknowns().lifting(1.).linfty_norm())
  {}



  template <int dim>
  void
  LargestForce<dim>::look_into(const PathEnd<dim>               &begun,
                               const LoadFactors                 last,
                               const LoadPathStep<dim> *const    step,
                               std::optional<LoadPathPeak<dim>> &peak) const
  {
    // A path begins at rest, where there is no force.
    if (!peak)
      peak = {begun.step, is_bounded ? std::make_optional(0.) : std::nullopt};
    if (step != nullptr)
      compare(*step, *peak);
    // With other loads rest is no state of the path, and the whole length of
    // it is no place to look into. With friction forces fall in each reversal.
    const bool is_suspect =
      is_homogeneous || step == nullptr ||
      (scene.adhesion().friction().empty() &&
       std::abs(step->state.unit_displacement_work) <
         std::abs(begun.step.state.unit_displacement_work) - noise) ||
      step->state.broken_part > begun.step.state.broken_part;
    if (!is_suspect || (!is_homogeneous && begun.step.step == 0) ||
        last.displacements == begun.step.displacement_factor)
      return;
    const Start  from  = start(begun, last, *peak);
    const double limit = bound(from, last);
    if (!crosses_zero(begun.step.factors(), last) && is_resolved(limit, *peak))
      extend(limit, *peak);
    else
      walk_halves(from, last, most_halvings, *peak);
  }



  template <int dim>
  typename LargestForce<dim>::Start
  LargestForce<dim>::start(const PathEnd<dim> &state,
                           const LoadFactors   last,
                           Peak               &peak) const
  {
    const double d = state.step.displacement_factor;
    const double F = state.step.state.unit_displacement_work;
    if (is_homogeneous && d != 0.)
      return {state, F / d};
    const std::optional<PathEnd<dim>> near =
      go_to(state, between(state.step.factors(), last, part_for_slope));
    if (!near)
      {
        peak.bound.reset();
        return {state, 0.};
      }
    return {state,
            (near->step.state.unit_displacement_work - F) /
              (near->step.displacement_factor - d)};
  }



  template <int dim>
  double
  LargestForce<dim>::bound(const Start &start, const LoadFactors last)
  {
    const double F = start.state.step.state.unit_displacement_work;
    return std::max(std::abs(F),
                    std::abs(F + start.slope *
                                   (last.displacements -
                                    start.state.step.displacement_factor)));
  }



  template <int dim>
  bool
  LargestForce<dim>::is_resolved(const double bound, const Peak &peak) const
  {
    return bound <=
           (1. + scene.parameters().load_path.resolve) * peak.force() + noise;
  }



  template <int dim>
  std::optional<PathEnd<dim>>
  LargestForce<dim>::walk(const Start       &start,
                          const LoadFactors  last,
                          const unsigned int halvings,
                          Peak              &peak) const
  {
    const double limit = bound(start, last);
    // The whole way tells most as long as no force is known that comes near to
    // the bound. If it does not lead to the end of the search, its halves do.
    if (halvings == 0 || is_resolved(limit, peak) || limit > 2. * peak.force())
      {
        const std::optional<PathEnd<dim>> end = go_to(start.state, last);
        if (end)
          compare(end->step, peak);
        if (halvings == 0 || is_resolved(limit, peak) ||
            Interruption::by_signal().requested())
          {
            extend(limit, peak);
            return end;
          }
      }
    return walk_halves(start, last, halvings, peak);
  }



  template <int dim>
  std::optional<PathEnd<dim>>
  LargestForce<dim>::walk_halves(const Start       &start,
                                 const LoadFactors  last,
                                 const unsigned int halvings,
                                 Peak              &peak) const
  {
    LoadFactors middle = between(start.state.step.factors(), last, 0.5);
    if (crosses_zero(start.state.step.factors(), last))
      middle.displacements = 0.;
    const std::optional<PathEnd<dim>> half =
      walk(start, middle, halvings - 1, peak);
    if (half)
      return walk(this->start(*half, last, peak), last, halvings - 1, peak);
    // Nothing is known beyond a state that was not found.
    peak.bound.reset();
    return {};
  }



  template <int dim>
  LoadPathPeak<dim>
  peak_of_steps(const std::vector<LoadPathStep<dim>> &steps)
  {
    return {*std::max_element(
              steps.begin(),
              steps.end(),
              [](const LoadPathStep<dim> &one, const LoadPathStep<dim> &other) {
                return std::abs(one.state.unit_displacement_work) <
                       std::abs(other.state.unit_displacement_work);
              }),
            std::nullopt};
  }



  DEBOND_INSTANTIATE_CLASS(LargestForce);
  DEBOND_INSTANTIATE(peak_of_steps);
} // namespace Debond
