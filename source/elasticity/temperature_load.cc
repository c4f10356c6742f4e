// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <debond/elasticity/linear_simplex.h>
#include <debond/elasticity/temperature_load.h>

#include <cmath>
#include <limits>
#include <sstream>

namespace Debond
{
  namespace
  {
    template <int dim>
    double
    temperature_at(const dealii::Point<dim>    &point,
                   const dealii::Function<dim> &change)
    {
      double value = std::numeric_limits<double>::quiet_NaN();
      try
        {
          value = change.value(point);
        }
      catch (const std::exception &)
        {
          // muParser's functions throw outside of their domains.
        }
      if (!std::isfinite(value))
        {
          std::ostringstream message;
          message << "the change of temperature is not finite at (" << point
                  << ")";
          throw TemperatureError(message.str());
        }
      return value;
    }
  } // namespace



  template <int dim>
  std::vector<double>
  thermal_stresses(const dealii::DoFHandler<dim> &dof_handler,
                   const ByRegion<Material>      &materials,
                   const Loads<dim>              &loads)
  {
    std::vector<double> stresses;
    if (!loads.temperature_change)
      return stresses;

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
            mean += rule.weight(q) / reference_volume *
                    temperature_at(point, *loads.temperature_change);
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
