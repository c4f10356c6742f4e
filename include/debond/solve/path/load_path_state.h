// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_path_load_path_state_h
#define debond_solve_path_load_path_state_h

#include <debond/check/verification.h>
#include <debond/elasticity/probes.h>

namespace Debond
{
  /// A state under a multiple of the loads, in numbers.
  template <int dim>
  struct LoadPathState
  {
    /// The word for it among the minima (to_string()); empty if it is no
    /// solution.
    std::string minimum;

    double functional;      ///< J
    double elastic_energy;  ///< 1/2 <A u, u>
    double adhesion_energy; ///< int j_1(u_nu)

    /// <f, u>, f being the loads with factor 1: the displacement that belongs
    /// to the factor, since dJ/d(factor) = -<f, u> along a branch.
    double unit_load_work;

    /// The work of the supports' forces on what they prescribe with factor 1,
    /// the derivative of J by the factor of prescribed displacements. If that
    /// is one displacement of 1, its reaction.
    double unit_displacement_work;

    /// Parts of the contact boundary by its nodes' measures. Open boundary
    /// counts as broken if the law has no adhesion.
    double contact_part;
    double bonded_part;
    double broken_part;

    /// Open and without bonds where others have some, and of the law's other
    /// branches, by their names in words with underscores.
    std::vector<std::pair<std::string, double>> other_parts;

    double mean_gap;
    double largest_gap;

    /// Sum of the nodes' normal forces, positive where the foundation pushes.
    double normal_force;

    dealii::Tensor<1, dim> contact_reaction;
    dealii::Tensor<1, dim> clamped_reaction;

    double law_violation;
    double equilibrium_residual;
    double force_imbalance;

    double broken_zone; ///< see Verification

    std::vector<dealii::Point<dim>> fronts; ///< see fronts()

    /// The largest size over E* / a of the contact faces where bonds that hold
    /// meet bonds that do not, or none; 0 if there are no such faces, or bonds
    /// soften. E* is E / (1 - nu^2), a the stiffness of the bonds.
    double cell_size_at_edge;

    double dissipated_energy; ///< by bonds that do not heal, and by friction

    /// By the titles of their columns, without the axis.
    ProbeValues<dim> vectors;

    /// Calls @p action with the title of the column and the number for all of
    /// the above, in the order of columns. Files of a path and of its restart
    /// have what is listed here. The titles of lists are in them.
    template <typename State, typename Action>
    static void
    for_each_number(State &state, const Action &action)
    {
      action("minimum", state.minimum);
      action("J", state.functional);
      action("elastic_energy", state.elastic_energy);
      action("adhesion_energy", state.adhesion_energy);
      action("unit_load_work", state.unit_load_work);
      action("unit_displacement_work", state.unit_displacement_work);
      action("contact_part", state.contact_part);
      action("bonded_part", state.bonded_part);
      action("broken_part", state.broken_part);
      action("mean_gap", state.mean_gap);
      action("largest_gap", state.largest_gap);
      action("normal_force", state.normal_force);
      action("contact_reaction", state.contact_reaction);
      action("clamped_reaction", state.clamped_reaction);
      action("law_violation", state.law_violation);
      action("equilibrium_residual", state.equilibrium_residual);
      action("force_imbalance", state.force_imbalance);
      action("_part", state.other_parts);
      action("broken_zone", state.broken_zone);
      action("fronts", state.fronts);
      action("cell_size_at_edge", state.cell_size_at_edge);
      action("dissipated_energy", state.dissipated_energy);
      action("", state.vectors);
    }
  };

  /// @p verification is that of @p u under @p factors times the loads. The
  /// vectors are the reactions of the supports.
  template <int dim>
  LoadPathState<dim>
  load_path_state(const ElasticProblem<dim>   &problem,
                  const AdhesionIntegral<dim> &adhesion,
                  const LoadFactors            factors,
                  const DofVector             &u,
                  const Verification<dim>     &verification);
} // namespace Debond

#endif
