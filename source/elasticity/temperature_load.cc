// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/fe/fe_simplex_p.h>

#include <debond/base/instantiate.h>
#include <debond/elasticity/fields.h>
#include <debond/elasticity/temperature_load.h>
#include <debond/mesh/field_value.h>
#include <debond/mesh/owned_cells.h>

#include <numeric>

namespace Debond
{
  namespace
  {
    template <int dim>
    double
    temperature_at(const Loads<dim> &loads, const dealii::Point<dim> &point)
    {
      try
        {
          return field_value(*loads.temperature_change, point);
        }
      catch (const std::invalid_argument &error)
        {
          throw EntryError("Loads/Temperature change", error.what());
        }
    }
  } // namespace



  template <int dim>
  std::vector<double>
  temperature_changes(const dealii::Triangulation<dim> &triangulation,
                      const Loads<dim>                 &loads,
                      const unsigned int                degree)
  {
    std::vector<double> changes;
    if (!loads.temperature_change)
      return changes;

    // Strains of degree 1 are constant in a cell, so that only the mean change
    // of temperature does work on them; it is taken by a rule of degree 2.
    // Strains of degree 2 are linear and see the change at the points where the
    // energy is integrated. All active cells are visited, ghosts included,
    // since the list is by active_cell_index(). The function is evaluated
    // without the factor 2 pi r, as the change is a field and no load.
    SimplexValues<dim>         values(dealii::FE_SimplexP<dim>(1),
                              degree == 1 ? dealii::QGaussSimplex<dim>(2) :
                                                    strain_rule<dim>(degree),
                              Symmetry::none);
    const std::vector<double> &weights = values.get_quadrature().get_weights();
    const double volume = std::accumulate(weights.begin(), weights.end(), 0.);
    for (const auto &cell : triangulation.active_cell_iterators())
      {
        values.reinit(*cell);
        double mean = 0.;
        for (const unsigned int q : values.quadrature_point_indices())
          {
            const double change =
              temperature_at(loads, values.quadrature_point(q));
            mean += weights[q] / volume * change;
            if (degree > 1)
              changes.push_back(change);
          }
        if (degree == 1)
          changes.push_back(mean);
      }
    return changes;
  }



  template <int dim>
  void
  add_thermal_forces(const dealii::DoFHandler<dim> &dof_handler,
                     const ByRegion<Material>      &materials,
                     const std::vector<double>     &temperature_changes,
                     const Symmetry                 symmetry,
                     DofVector                     &forces)
  {
    if (temperature_changes.empty())
      return;
    // The load of thermal strains is int theta C alpha : eps(phi_k), by the
    // same rule as the stiffness: a free body that is heated evenly has
    // displacements without stress to rounding.
    const auto stresses = materials.transformed(
      [](const Material &material) { return material.thermal_stress<dim>(); });
    const auto                                  &fe = dof_handler.get_fe();
    SimplexValues<dim>                           values(fe.base_element(0),
                              strain_rule<dim>(fe.degree),
                              symmetry);
    std::vector<dealii::types::global_dof_index> dofs(fe.dofs_per_cell);
    const unsigned int n_points = values.get_quadrature().size();
    for (const auto &cell : owned_cells(dof_handler))
      {
        values.reinit(*cell);
        cell->get_dof_indices(dofs);
        const dealii::SymmetricTensor<2, 3> &stress =
          stresses(cell->material_id());
        for (const unsigned int q : values.quadrature_point_indices())
          {
            const double change =
              temperature_changes[cell->active_cell_index() * n_points + q];
            for (unsigned int i = 0; i < dofs.size(); ++i)
              forces(dofs[i]) += values.JxW(q) * change *
                                 values.force(stress, i / dim, q)[i % dim];
          }
      }
  }



  DEBOND_INSTANTIATE(temperature_changes);
  DEBOND_INSTANTIATE(add_thermal_forces);
} // namespace Debond
