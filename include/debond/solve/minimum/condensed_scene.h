// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_condensed_scene_h
#define debond_solve_minimum_condensed_scene_h

#include <debond/elasticity/contact_condensation.h>
#include <debond/solve/scene/scene.h>

namespace Debond
{
  /// A scene condensed onto its contact normals, under multiples of its loads.
  template <int dim>
  struct CondensedScene
  {
    const Scene<dim>   &scene;
    const Condensation &condensed; ///< under the whole load

    /// What its bonds remember.
    BondMemory memory = {};

    AdhesionIntegral<dim>
    bonds(const LoadFactors factors) const
    {
      AdhesionIntegral<dim> result = scene.adhesion().at(factors.displacements);
      result.set_memory(memory);
      return result;
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
  };
} // namespace Debond

#endif
