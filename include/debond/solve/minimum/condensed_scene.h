// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_condensed_scene_h
#define debond_solve_minimum_condensed_scene_h

#include <debond/elasticity/contact_condensation.h>
#include <debond/optimization/stationary_path.h>
#include <debond/solve/scene/scene.h>

namespace Debond
{
  /// A scene condensed onto its contact normals, under multiples of its loads.
  template <int dim>
  struct CondensedScene
  {
    const Scene<dim>   &scene;
    const Condensation &condensed; ///< under the whole load

    AdhesionIntegral<dim>
    bonds(const LoadFactors factors) const
    {
      return scene.adhesion().at(factors.displacements);
    }

    Condensation
    at(const LoadFactors factors) const
    {
      return at_factors(condensed, scene.problem(), bonds(factors), factors);
    }

    /// g of the condensed problem, an entry for each contact node.
    Eigen::VectorXd
    load(const LoadFactors factors) const
    {
      return condensed.with_load(scene.problem().load(factors)).load();
    }

    /// Its stationary points between the factors @p first, where t = 0, and
    /// @p last, where t = @p length, with nodal bonds that are as @p integral
    /// has them.
    StationaryPath::Problem
    between(const LoadFactors            first,
            const LoadFactors            last,
            const double                 length,
            const AdhesionIntegral<dim> &integral) const;
  };
} // namespace Debond

#endif
