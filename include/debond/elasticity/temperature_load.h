// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_temperature_load_h
#define debond_elasticity_temperature_load_h

#include <debond/elasticity/load_vector.h>
#include <debond/elasticity/material.h>
#include <debond/mesh/by_region.h>

namespace Debond
{
  /// The change of temperature of each active cell, as displacements of this
  /// @p degree see it: of degree 1 the mean, of degree 2 the values at the
  /// points of strain_rule(). Empty if there is none. Throws EntryError
  /// with the place if the change is not finite somewhere.
  template <int dim>
  std::vector<double>
  temperature_changes(const dealii::Triangulation<dim> &triangulation,
                      const Loads<dim>                 &loads,
                      const unsigned int                degree = 1);

  /// Adds the nodal forces that they are as a load, by
  /// Material::thermal_stress(), to the Cartesian ones at every degree of
  /// freedom.
  template <int dim>
  void
  add_thermal_forces(const dealii::DoFHandler<dim> &dof_handler,
                     const ByRegion<Material>      &materials,
                     const std::vector<double>     &temperature_changes,
                     const Symmetry                 symmetry,
                     DofVector                     &forces);
} // namespace Debond

#endif
