// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_load_path_h
#define debond_output_load_path_h

#include <debond/output/verification.h>

#include <optional>
#include <string>
#include <vector>

namespace Debond
{
  /// A state under a multiple of the loads, in numbers.
  template <int dim>
  struct LoadPathState
  {
    /// What is known of it among the minima; empty if it is no solution.
    std::string minimum;

    double functional;      ///< J
    double elastic_energy;  ///< 1/2 <A u, u>
    double adhesion_energy; ///< int j_1(u_nu)

    /// <f, u>, f being the loads with factor 1: the displacement that belongs
    /// to the factor, since dJ/d(factor) = -<f, u> along a branch.
    double unit_load_work;

    /// Parts of the contact boundary by its nodes' measures. Open boundary
    /// counts as broken, if there is no adhesion.
    double contact_part;
    double bonded_part;
    double broken_part;

    double mean_gap;
    double largest_gap;

    /// Sum of the nodes' normal forces, positive where the foundation pushes.
    double normal_force;

    dealii::Tensor<1, dim> contact_reaction;
    dealii::Tensor<1, dim> clamped_reaction;

    double law_violation;
    double equilibrium_residual;
    double force_imbalance;
  };

  /// @p verification is that of @p u under @p factor times the loads.
  template <int dim>
  LoadPathState<dim>
  load_path_state(const ElasticProblem<dim>    &problem,
                  const AdhesionIntegral<dim>  &adhesion,
                  const double                  factor,
                  const dealii::Vector<double> &u,
                  const Verification<dim>      &verification);



  template <int dim>
  struct LoadPathStep
  {
    unsigned int step;   ///< from 1
    double       factor; ///< of the loads
    std::string  status; ///< a SolverStatus, or "not verified"

    LoadPathState<dim> state;
    unsigned int       iterations; ///< of majorise-minimise

    /// Where on the way from the last factor the first bond broke or closed,
    /// if one did: displacements are proportional to the factor as long as none
    /// does. Known with nodal quadrature, unless the step begins at zero.
    std::optional<double> change_factor;

    /// The global branch at this factor, if it was computed.
    std::optional<LoadPathState<dim>> global;
    std::optional<double>             relative_gap; ///< of its proof

    /// Of the first thing that went wrong, empty if nothing did.
    std::string message;
  };



  /// A step at which the broken part changed.
  struct BondChange
  {
    unsigned int          step;
    double                factor;
    std::optional<double> change_factor; ///< see LoadPathStep
    double                broken_before;
    double                broken_after;
  };



  struct LoadPathTotals
  {
    unsigned int factors; ///< that the scene has
    unsigned int steps;   ///< that were done
    double       last_factor;

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



  /// load_path.csv, a row for each step; what was not computed is left empty.
  template <int dim>
  void
  write_load_path(const std::vector<LoadPathStep<dim>> &steps,
                  const std::string                    &file_name);
} // namespace Debond

#endif
