// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <debond/contact/field_value.h>
#include <debond/elasticity/cell_nodes.h>
#include <debond/elasticity/temperature_load.h>

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
  mean_thermal_stresses(const dealii::Triangulation<dim> &triangulation,
                        const ByRegion<Material>         &materials,
                        const Loads<dim>                 &loads)
  {
    std::vector<double> stresses;
    if (!loads.temperature_change)
      return stresses;

    const dealii::QGaussSimplex<dim> rule(2);
    double                           reference_volume = 0.;
    for (unsigned int q = 0; q < rule.size(); ++q)
      reference_volume += rule.weight(q);
    for (const auto &cell : triangulation.active_cell_iterators())
      {
        double mean = 0.;
        for (unsigned int q = 0; q < rule.size(); ++q)
          {
            dealii::Point<dim> point = cell->vertex(0);
            for (unsigned int d = 0; d < dim; ++d)
              point +=
                rule.point(q)[d] * (cell->vertex(d + 1) - cell->vertex(0));
            mean +=
              rule.weight(q) / reference_volume * temperature_at(loads, point);
          }
        stresses.push_back(
          materials(cell->material_id()).template thermal_stress<dim>() * mean);
      }
    return stresses;
  }



  template <int dim>
  std::vector<double>
  thermal_stresses(const dealii::DoFHandler<dim> &dof_handler,
                   const ByRegion<Material>      &materials,
                   const Loads<dim>              &loads)
  {
    if (dof_handler.get_fe().degree == 1)
      return mean_thermal_stresses(dof_handler.get_triangulation(),
                                   materials,
                                   loads);
    std::vector<double> stresses;
    if (!loads.temperature_change)
      return stresses;

    for (const auto &cell : dof_handler.active_cell_iterators())
      {
        const double pressure_of_one =
          materials(cell->material_id()).template thermal_stress<dim>();
        const BernsteinSimplex<dim> simplex(cell, 2);
        for (unsigned int q = 0; q < simplex.n_points; ++q)
          {
            const auto         barycentric = simplex.point(q);
            dealii::Point<dim> point       = cell->vertex(0);
            for (unsigned int v = 1; v <= dim; ++v)
              point += barycentric[v] * (cell->vertex(v) - cell->vertex(0));
            stresses.push_back(pressure_of_one * temperature_at(loads, point));
          }
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
    for (const auto &cell : dof_handler.active_cell_iterators())
      {
        const BernsteinSimplex<dim> simplex(cell, cell->get_fe().degree);
        const CellNodes<dim>        nodes(cell);
        for (unsigned int q = 0; q < simplex.n_points; ++q)
          {
            const double stress =
              thermal_stresses[simplex.n_points * cell->active_cell_index() +
                               q];
            for (unsigned int n = 0; n < nodes.size; ++n)
              {
                const dealii::Tensor<1, dim> gradient =
                  simplex.gradient(n, simplex.point(q));
                for (unsigned int d = 0; d < dim; ++d)
                  forces[nodes.dofs[n][d]] +=
                    simplex.weight * stress * gradient[d];
              }
          }
      }
  }



  template decltype(mean_thermal_stresses<2>) mean_thermal_stresses<2>;
  template decltype(mean_thermal_stresses<3>) mean_thermal_stresses<3>;
  template decltype(thermal_stresses<2>)      thermal_stresses<2>;
  template decltype(thermal_stresses<3>)      thermal_stresses<3>;
  template decltype(add_thermal_forces<2>)    add_thermal_forces<2>;
  template decltype(add_thermal_forces<3>)    add_thermal_forces<3>;
} // namespace Debond
