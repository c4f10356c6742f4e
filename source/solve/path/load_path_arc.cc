// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/optimization/stationary_path.h>
#include <debond/solve/path/load_path_arc.h>

namespace Debond
{
  namespace
  {
    /// The line of factors on which an arc is, by the one of them that varies.
    class VariedFactor
    {
    public:
      explicit VariedFactor(const LoadPathParameters &path)
        : path(path)
        , is_of_loads(!are_equal(path.factors))
        , values(is_of_loads ? path.factors : path.displacement_factors)
      {}

      /// Returns whether there is no line.
      bool
      is_constant() const
      {
        return are_equal(values);
      }

      double
      first() const
      {
        return values.front();
      }

      /// The next one that differs from the first.
      double
      other() const
      {
        return *std::find_if(values.begin(),
                             values.end(),
                             [this](const double value) {
                               return value != first();
                             });
      }

      /// Returns the least and the largest one times @p sign.
      std::pair<double, double>
      interval(const double sign) const
      {
        const auto [least, largest] =
          std::minmax_element(values.begin(), values.end());
        return std::minmax(sign * *least, sign * *largest);
      }

      LoadFactors
      at(const double value) const
      {
        // Without displacement factors of their own, prescribed displacements
        // follow the loads.
        LoadFactors factors                                   = path.at(0);
        (is_of_loads ? factors.loads : factors.displacements) = value;
        if (path.displacement_factors.empty())
          factors.displacements = value;
        return factors;
      }

    private:
      static bool
      are_equal(const std::vector<double> &numbers)
      {
        return std::all_of(numbers.begin(),
                           numbers.end(),
                           [&numbers](const double number) {
                             return number == numbers[0];
                           });
      }

      const LoadPathParameters  &path;
      const bool                 is_of_loads;
      const std::vector<double> &values;
    };



    /// The stationary points between the factors @p first, where t = 0, and
    /// @p last, where t = @p length.
    template <int dim>
    StationaryPath::Problem
    problem_between(const CondensedScene<dim> &scene,
                    const LoadFactors          first,
                    const LoadFactors          last,
                    const double               length)
    {
      // With nodal bonds each s_i has the law w_i f(s_i / l_i), and g is affine
      // in the factor, as StationaryPath needs it: its slope is the difference
      // of g over the length of the interval of t.
      const Eigen::VectorXd             g = scene.load(first);
      std::vector<StationaryPath::Bond> bonds;
      const auto &nodes = scene.scene.contact_boundary().nodes;
      for (unsigned int i = 0; i < nodes.size(); ++i)
        {
          const BondScale scale = scene.scene.adhesion().points().bonds_at(i);
          bonds.push_back({nodes[i].measure * scale.energy, scale.length});
        }
      return {scene.condensed.schur_complement(),
              g,
              (scene.load(last) - g) / length,
              scene.scene.law().pieces(),
              bonds,
              scene.scene.parameters().load_path.bonds_heal};
    }
  } // namespace



  template <int dim>
  LoadPathArc<dim>
  follow_arc(const CondensedScene<dim> &scene,
             const Eigen::VectorXd     &s,
             const double               tolerance,
             const Interruption        &interruption)
  {
    // The arc is the curve of stationary points of J in s and the factor,
    // stable or not, of which a load path sees the stable parts and jumps over
    // the rest. For bonds at nodes with quadratic pieces it is straight between
    // breakpoints, so that it is followed exactly, one breakpoint after the
    // other, without a step size. Each breakpoint becomes a state with all its
    // numbers.
    const Stage               stage("arc");
    LoadPathArc<dim>          arc;
    const LoadPathParameters &parameters = scene.scene.parameters().load_path;
    const VariedFactor        varied(parameters);
    if (varied.is_constant())
      {
        arc.note = "There is no arc: the factor stays the same.";
        return arc;
      }

    // The path of stationary points starts with rising t, so t is the factor or
    // its negative, whichever rises towards the next factor.
    const double                    first    = varied.first();
    const double                    length   = varied.other() - first;
    const double                    sign     = length > 0. ? 1. : -1.;
    const std::pair<double, double> interval = varied.interval(sign);
    BondMemory                      memory;
    StationaryPath                  path(problem_between(scene,
                                        varied.at(first),
                                        varied.at(varied.other()),
                                        std::abs(length)),
                        s,
                        sign * first);
    const auto                      add = [&](const bool is_stable) {
      const LoadFactors factors = varied.at(sign * path.t() + 0.); // no -0
      // Bonds that do not heal remember the largest opening of the way, but a
      // bond that sits at its kink, from which the arc continues with a smaller
      // pull, has not broken yet.
      AdhesionIntegral<dim> here = scene.bonds(factors);
      here.set_memory(memory);
      if (!parameters.bonds_heal)
        here.break_for_good(path.point_before_kinks());
      memory = here.memory();
      // The other unknowns follow from s at equilibrium, whether or not the
      // point is a minimum.
      const DofVector u =
        at_factors(scene.condensed, scene.scene.problem(), here, factors)
          .expand(path.point());
      const VerifiedState<dim> state(scene.scene, here, factors, u);
      LoadPathStep<dim>        step =
        step_of(state,
                static_cast<unsigned int>(arc.steps.size() + 1),
                factors);
      step.status = is_stable ? "stable" : "unstable";
      // Each state is verified like a result. One that fails is still listed,
      // so that the user sees where the arc was lost.
      if (!(state.verification.error() <= tolerance))
        {
          step.status = "not verified";
          arc.note = "The arc ends: " + location(parameters, step) +
                     state.verification.failure(tolerance);
        }
      arc.steps.push_back(step);
      return step.status != "not verified";
    };

    using Event = StationaryPath::Event;
    Event last  = Event::change;
    // The limit of breakpoints is a few for each node and each piece of the
    // law, as nodes touch and go through the pieces there and back. More of
    // them mean that rounding leads the path in a circle.
    const std::size_t most =
      100 + 10 * (1 + scene.scene.law().pieces().size()) * s.size();
    bool is_going = add(true);
    for (unsigned int k = 0; is_going && last != Event::end; ++k)
      {
        if (interruption.requested())
          {
            arc.interrupted = true;
            break;
          }
        const double before = path.t();
        // One breakpoint a pass, at which a node goes to its next segment of
        // the law and t may turn.
        last     = path.advance(interval.first, interval.second);
        is_going = false;
        if (last == Event::no_stiffness)
          arc.note =
            "The arc ends where the bonds that hold the body have broken.";
        else if (last == Event::degenerate)
          arc.note = "The arc ends where it branches, or rounding hides how it "
                     "goes on.";
        else if (k == most)
          arc.note =
            "The arc ends after " + std::to_string(most) + " changes of nodes.";
        else
          // Nodes that change at one factor, as those of a body at rest, do so
          // one after the other, and rounding is all that is between them.
          is_going =
            std::abs(path.t() - before) <=
              Tolerance::same_breakpoint * (interval.second - interval.first) ||
            add(!path.was_unstable());
      }
    return arc;
  }



  DEBOND_INSTANTIATE(follow_arc);
} // namespace Debond
