// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_lumped_bonds_h
#define debond_solve_minimum_lumped_bonds_h

#include <debond/contact/adhesion_integral.h>
#include <debond/optimization/global/moves.h>
#include <debond/optimization/global/separable_energy.h>

namespace Debond
{
  /// The lengths that the law's openings are multiples of at the nodes, or on
  /// coarser spaces their means; empty if all bonds are the same.
  template <int dim>
  std::vector<double>
  scales_of_bonds(
    const AdhesionIntegral<dim>                    &adhesion,
    const std::vector<Eigen::SparseMatrix<double>> &prolongations = {});

  /// The energy with a law of its own for each node, and if bonds shear for the
  /// unknowns of each: what Phi is with bonds at nodes. Bonds of shear alone
  /// follow those of the nodes, and are added to @p graph.
  template <int dim>
  SeparableEnergy
  lumped_bonds(const AdhesionIntegral<dim> &adhesion, NeighbourGraph &graph);

  /// Returns whether a sum over nodes of the law at their unknowns is Phi.
  template <int dim>
  bool
  is_sum_over_nodes(const AdhesionIntegral<dim> &adhesion);
} // namespace Debond

#endif
