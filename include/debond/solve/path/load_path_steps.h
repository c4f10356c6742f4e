// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_path_load_path_steps_h
#define debond_solve_path_load_path_steps_h

#include <debond/solve/minimum/refinement.h>
#include <debond/solve/minimum/solution.h>
#include <debond/solve/path/load_path_state.h>
#include <debond/solve/scene/scene.h>

namespace Debond
{
  template <int dim>
  struct LoadPathStep
  {
    unsigned int step;   ///< from 1
    double       factor; ///< of the loads
    double       displacement_factor;
    std::string  status; ///< a SolverStatus, or "not verified"

    LoadPathState<dim> state;
    unsigned int       iterations; ///< of majorise-minimise

    /// The global branch at this factor, if it was computed.
    std::optional<LoadPathState<dim>> global;
    std::optional<double>             relative_gap; ///< of its proof

    LoadFactors
    factors() const
    {
      return {factor, displacement_factor};
    }

    /// The message of the first thing that went wrong, empty if nothing did.
    std::string message;
  };



  /// "load path, step 3, factor 0.5: ", for messages.
  template <int dim>
  std::string
  location(const LoadPathParameters &parameters, const LoadPathStep<dim> &step);

  /// Makes @p result that of a run that a signal has ended at this step, with
  /// @p what is missing.
  template <int dim>
  void
  interrupt(const LoadPathParameters &parameters,
            const LoadPathStep<dim>  &step,
            const std::string        &what,
            Solution                 &result);

  /// A state of the load path in numbers, with the vectors that the scene asks
  /// for, and its verification. To be made by all ranks.
  template <int dim>
  struct VerifiedState
  {
    /// @p bonds are as the path has left them at these @p factors.
    VerifiedState(const Scene<dim>            &scene,
                  const AdhesionIntegral<dim> &bonds,
                  const LoadFactors            factors,
                  const DofVector             &u);

    Verification<dim>  verification;
    LoadPathState<dim> state;
  };

  /// The step number @p k, from 1, to this state.
  template <int dim>
  LoadPathStep<dim>
  step_of(const VerifiedState<dim> &state,
          const unsigned int        k,
          const LoadFactors         factors);


  /// What bonds that do not heal remember of the body at rest, where over a gap
  /// they may be stretched beyond what they return from.
  template <int dim>
  BondMemory
  memory_at_rest(const Scene<dim> &scene);

  /// Enters in @p breaks, as many as @p nodes or none before the first step,
  /// which bonds have broken in a step to @p factor. Broken are those that have
  /// lost 0.99 of their stiffness; what has healed has not.
  void
  note_breaks(const double                         factor,
              const std::vector<ContactNodeState> &nodes,
              std::vector<BondBreak>              &breaks);

  /// Refines a state of a path if needed, with one note for all of them.
  template <int dim>
  void
  refine_state(const Scene<dim>            &scene,
               const AdhesionIntegral<dim> &bonds,
               const LoadFactors            factors,
               CorrectionSolver            &correction,
               DofVector                   &u,
               Solution                    &result);



  /// A step at which the broken part changed.
  struct BondChange
  {
    unsigned int step;
    double       factor;
    double       displacement_factor;
    double       broken_before;
    double       broken_after;
  };



  struct LoadPathTotals
  {
    unsigned int factors; ///< that the scene has
    unsigned int steps;   ///< that were done
    LoadFactors  last;

    /// The steps at which the broken part grew and shrank most, if it did.
    std::optional<BondChange> largest_break;
    std::optional<BondChange> largest_closing;

    /// Steps with a global branch, and those where J is above it.
    unsigned int compared     = 0;
    unsigned int above_global = 0;

    /// The largest difference, relative to |J| of the global branch.
    double largest_excess = 0.;
  };

  /// @p n_factors: of the scene. There has to be one step at least.
  template <int dim>
  LoadPathTotals
  load_path_totals(const std::vector<LoadPathStep<dim>> &steps,
                   const unsigned int                    n_factors);
} // namespace Debond

#endif
