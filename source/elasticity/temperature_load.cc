// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <debond/contact/field_value.h>
#include <debond/elasticity/linear_simplex.h>
#include <debond/elasticity/temperature_load.h>

namespace Debond
{
  template <int dim>
  std::vector<double>
  thermal_stresses(const dealii::DoFHandler<dim> &dof_handler,
                   const ByRegion<Material>      &materials,
                   const Loads<dim>              &loads)
  {
    std::vector<double> stresses;
    if (!loads.temperature_change)
      return stresses;

    const auto temperature_at = [&loads](const dealii::Point<dim> &point) {
      try
        {
          return field_value(*loads.temperature_change, point);
        }
      catch (const std::invalid_argument &error)
        {
          throw TemperatureError(error.what());
        }
    };
    const dealii::QGaussSimplex<dim> rule(2);
    double                           reference_volume = 0.;
    for (unsigned int q = 0; q < rule.size(); ++q)
      reference_volume += rule.weight(q);
    for (const auto &cell : dof_handler.active_cell_iterators())
      {
        double mean = 0.;
        for (unsigned int q = 0; q < rule.size(); ++q)
          {
            dealii::Point<dim> point = cell->vertex(0);
            for (unsigned int d = 0; d < dim; ++d)
              point +=
                rule.point(q)[d] * (cell->vertex(d + 1) - cell->vertex(0));
            mean += rule.weight(q) / reference_volume * temperature_at(point);
          }
        stresses.push_back(
          materials(cell->material_id()).template thermal_stress<dim>() * mean);
      }
    return stresses;
  }



  template <int dim>
  void
  add_thermal_forces(const dealii::DoFHandler<dim> &dof_handler,
                     const std::vector<double>     &thermal_stresses,
                     dealii::Vector<double>        &forces)
  {
    if (thermal_stresses.empty())
      return;
    for (const auto &cell : dof_handler.active_cell_iterators())
      {
        const LinearSimplex<dim> simplex(cell);
        for (unsigned int v = 0; v <= dim; ++v)
          for (unsigned int d = 0; d < dim; ++d)
            forces[cell->vertex_dof_index(v, d)] +=
              simplex.volume * thermal_stresses[cell->active_cell_index()] *
              simplex.gradients[v][d];
      }
  }



  template std::vector<double>
  thermal_stresses(const dealii::DoFHandler<2> &,
                   const ByRegion<Material> &,
                   const Loads<2> &);
  template std::vector<double>
  thermal_stresses(const dealii::DoFHandler<3> &,
                   const ByRegion<Material> &,
                   const Loads<3> &);
  template void
  add_thermal_forces(const dealii::DoFHandler<2> &,
                     const std::vector<double> &,
                     dealii::Vector<double> &);
  template void
  add_thermal_forces(const dealii::DoFHandler<3> &,
                     const std::vector<double> &,
                     dealii::Vector<double> &);
} // namespace Debond
