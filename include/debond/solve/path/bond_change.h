// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_path_bond_change_h
#define debond_solve_path_bond_change_h

#include <debond/solve/minimum/condensed_scene.h>

namespace Debond
{
  /// A state that a load path has reached.
  struct PathPoint
  {
    LoadFactors     factors;
    Eigen::VectorXd s; ///< normal displacements of the contact nodes
  };

  /// The factor at which the first bond breaks or closes on the way from
  /// @p last to the factors @p next, if one does: on straight pieces of the way
  /// displacements are linear in the factor. It is that of prescribed
  /// displacements if the loads' factor stays the same. @p bonds are as they
  /// were at @p last. Nothing if that is not known, or if @p interruption is
  /// requested.
  template <int dim>
  std::optional<double>
  first_bond_change(const CondensedScene<dim>   &scene,
                    const AdhesionIntegral<dim> &bonds,
                    const PathPoint             &last,
                    const LoadFactors            next,
                    const Interruption          &interruption);
} // namespace Debond

#endif
