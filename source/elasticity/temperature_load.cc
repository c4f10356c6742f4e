// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_simplex_p.h>

#include <debond/base/field_value.h>
#include <debond/base/owned_cells.h>
#include <debond/elasticity/fields.h>
#include <debond/elasticity/temperature_load.h>

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
          throw TemperatureError(error.what());
        }
    }
  } // namespace



  template <int dim>
  std::vector<double>
  thermal_stresses(const dealii::Triangulation<dim> &triangulation,
                   const ByRegion<Material>         &materials,
                   const Loads<dim>                 &loads,
                   const unsigned int                degree)
  {
    std::vector<double> stresses;
    if (!loads.temperature_change)
      return stresses;

    SimplexValues<dim>         values(dealii::FE_SimplexP<dim>(1),
                              degree == 1 ? dealii::QGaussSimplex<dim>(2) :
                                                    strain_rule<dim>(degree));
    const std::vector<double> &weights = values.get_quadrature().get_weights();
    const double volume = std::accumulate(weights.begin(), weights.end(), 0.);
    for (const auto &cell : triangulation.active_cell_iterators())
      {
        values.reinit(*cell);
        const double stress_of_one =
          materials(cell->material_id()).template thermal_stress<dim>();
        double mean = 0.;
        for (const unsigned int q : values.quadrature_point_indices())
          {
            const double stress =
              stress_of_one * temperature_at(loads, values.quadrature_point(q));
            mean += weights[q] / volume * stress;
            if (degree > 1)
              stresses.push_back(stress);
          }
        if (degree == 1)
          stresses.push_back(mean);
      }
    return stresses;
  }



  template <int dim>
  void
  add_thermal_forces(const dealii::DoFHandler<dim> &dof_handler,
                     const std::vector<double>     &thermal_stresses,
                     DofVector                     &forces)
  {
    if (thermal_stresses.empty())
      return;
    const auto        &fe = dof_handler.get_fe();
    SimplexValues<dim> values(fe.base_element(0), strain_rule<dim>(fe.degree));
    std::vector<dealii::types::global_dof_index> dofs(fe.dofs_per_cell);
    const unsigned int n_points = values.get_quadrature().size();
    for (const auto &cell : owned_cells(dof_handler))
      {
        values.reinit(*cell);
        cell->get_dof_indices(dofs);
        auto stress =
          thermal_stresses.begin() + cell->active_cell_index() * n_points;
        for (const unsigned int q : values.quadrature_point_indices())
          {
            for (unsigned int i = 0; i < dofs.size(); ++i)
              forces(dofs[i]) += values.JxW(q) * *stress *
                                 values.shape_grad(i / dim, q)[i % dim];
            ++stress;
          }
      }
  }



  template decltype(thermal_stresses<2>)   thermal_stresses<2>;
  template decltype(thermal_stresses<3>)   thermal_stresses<3>;
  template decltype(add_thermal_forces<2>) add_thermal_forces<2>;
  template decltype(add_thermal_forces<3>) add_thermal_forces<3>;
} // namespace Debond
