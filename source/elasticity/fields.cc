// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/elasticity/fields.h>
#include <debond/mesh/owned_cells.h>

#include <boost/accumulators/accumulators.hpp>
#include <boost/accumulators/statistics/stats.hpp>
#include <boost/accumulators/statistics/sum_kahan.hpp>

namespace Debond
{
  namespace
  {
    /// Calls @p action with the stresses of each own cell and each point of
    /// strain_rule() there, for a displacement in Cartesian components.
    template <int dim, typename Action>
    void
    for_each_point(const ElasticFields<dim> &fields,
                   const DofVector          &cartesian_displacement,
                   const Action             &action)
    {
      const ElasticUnknowns<dim> &unknowns = fields.unknowns();
      CellStresses<dim>           of_cell(fields,
                                cartesian_displacement,
                                1.,
                                strain_rule<dim>(unknowns.degree()));
      for (const auto &cell : owned_cells(unknowns.dof_handler()))
        {
          of_cell.reinit(cell);
          for (const unsigned int q :
               of_cell.values().quadrature_point_indices())
            action(of_cell, q);
        }
    }
  } // namespace



  template <int dim>
  ElasticFields<dim>::ElasticFields(const ElasticUnknowns<dim> &unknowns,
                                    const ByRegion<Material>   &materials,
                                    const DofVector            &applied_forces,
                                    const std::vector<double>  &changes,
                                    const DofVector            &dead_forces,
                                    const bool                  heat_is_dead)
    : elastic_unknowns(unknowns)
    , materials(materials)
    , stiffness(materials.transformed(
        [](const Material &material) { return material.solid_tensor<dim>(); }))
    , stiffness_norms(
        stiffness.transformed([](const auto &tensor) { return tensor.norm(); }))
    , thermal_stresses(materials.transformed([](const Material &material) {
      return material.thermal_stress<dim>();
    }))
    , live_forces(applied_forces)
    , dead_forces(dead_forces)
    , temperature_changes(changes)
    , heat_is_dead(heat_is_dead)
  {
    if (dead_forces.size() > 0)
      live_forces -= dead_forces;
  }



  template <int dim>
  DofVector
  ElasticFields<dim>::applied_nodal_forces(const LoadFactors factors) const
  {
    DofVector forces = live_forces;
    forces *= factors.loads;
    if (dead_forces.size() > 0)
      forces += dead_forces;
    return forces;
  }



  template <int dim>
  DofVector
  ElasticFields<dim>::residual(const DofVector  &u,
                               const LoadFactors factors) const
  {
    DofVector forces(elastic_unknowns.n_dofs());
    for_each_point(*this,
                   elastic_unknowns.cartesian_displacement(u, factors),
                   [&forces](const CellStresses<dim> &cell,
                             const unsigned int       q) {
                     const dealii::SymmetricTensor<2, 3> sigma =
                       cell.values().JxW(q) * cell.elastic_stress(q);
                     for (unsigned int i = 0; i < cell.dofs().size(); i += dim)
                       {
                         const dealii::Tensor<1, dim> force =
                           cell.values().force(sigma, i / dim, q);
                         for (unsigned int d = 0; d < dim; ++d)
                           forces(cell.dofs()[i + d]) += force[d];
                       }
                   });
    add_over_ranks(forces, elastic_unknowns.communicator());
    forces -= applied_nodal_forces(factors);
    return elastic_unknowns.basis().forces_to_unknowns(forces);
  }



  template <int dim>
  DofVector
  ElasticFields<dim>::residual_rounding(const DofVector  &u,
                                        const LoadFactors factors) const
  {
    const DofVector displacement =
      elastic_unknowns.cartesian_displacement(u, factors);
    DofVector sizes = displacement;
    for (double &size : sizes)
      size = std::abs(size);
    sizes = elastic_unknowns.basis().sizes_of_terms(sizes);

    DofVector rounding(elastic_unknowns.n_dofs());
    for_each_point(*this,
                   displacement,
                   [&](const CellStresses<dim> &cell, const unsigned int q) {
                     const auto &dofs           = cell.dofs();
                     const auto  size_of_strain = [&](const unsigned int node) {
                       return cell.values().shape_grad(node, q).norm() +
                              std::abs(cell.values().hoop_strain(node, q));
                     };
                     double size_gradient = 0.;
                     for (unsigned int i = 0; i < dofs.size(); ++i)
                       size_gradient +=
                         sizes(dofs[i]) * size_of_strain(i / dim);
                     const double size_stress = cell.values().JxW(q) *
                                                cell.stiffness_norm() *
                                                size_gradient;
                     for (unsigned int i = 0; i < dofs.size(); ++i)
                       rounding(dofs[i]) +=
                         size_stress * size_of_strain(i / dim);
                   });
    add_over_ranks(rounding, elastic_unknowns.communicator());
    const DofVector forces = applied_nodal_forces(factors);
    for (unsigned int i = 0; i < rounding.size(); ++i)
      rounding[i] = std::numeric_limits<double>::epsilon() *
                    (rounding[i] + std::abs(forces[i]));
    return elastic_unknowns.basis().rounding_of_forces(rounding);
  }



  template <int dim>
  double
  ElasticFields<dim>::temperature_change(
    const Cell               &cell,
    const dealii::Point<dim> &unit_point) const
  {
    if (temperature_changes.empty())
      return 0.;
    const std::vector<double> functions =
      strain_functions<dim>(elastic_unknowns.degree(), unit_point);
    double sum = 0.;
    for (unsigned int q = 0; q < functions.size(); ++q)
      sum +=
        functions[q] *
        temperature_changes[functions.size() * cell->active_cell_index() + q];
    return sum;
  }



  template <int dim>
  double
  ElasticFields<dim>::elastic_functional(const DofVector  &u,
                                         const LoadFactors factors) const
  {
    return functional(u,
                      factors,
                      elastic_unknowns.basis().forces_to_unknowns(
                        applied_nodal_forces(factors)));
  }



  template <int dim>
  double
  ElasticFields<dim>::strain_energy(const DofVector  &u,
                                    const LoadFactors factors) const
  {
    return functional(u, factors, DofVector(u.size()));
  }



  template <int dim>
  double
  ElasticFields<dim>::load_work(const DofVector  &u,
                                const LoadFactors factors) const
  {
    return elastic_unknowns.basis().forces_to_unknowns(live_forces) *
           elastic_unknowns.lifted(u, factors);
  }



  template <int dim>
  double
  ElasticFields<dim>::functional(const DofVector  &u,
                                 const LoadFactors factors,
                                 const DofVector  &load) const
  {
    namespace accumulators = boost::accumulators;
    accumulators::
      accumulator_set<double, accumulators::stats<accumulators::tag::sum_kahan>>
                    result;
    const DofVector displacement = elastic_unknowns.lifted(u, factors);
    for_each_point(*this,
                   elastic_unknowns.basis().to_nodal(displacement),
                   [&result](const CellStresses<dim> &cell,
                             const unsigned int       q) {
                     result(0.5 * cell.values().JxW(q) *
                            (cell.strain(q) * cell.elastic_stress(q)));
                   });
    for (const auto i : elastic_unknowns.dof_handler().locally_owned_dofs())
      result(-load(i) * displacement(i));
    return dealii::Utilities::MPI::sum(accumulators::sum_kahan(result),
                                       elastic_unknowns.communicator());
  }



  template <int dim>
  CellStresses<dim>::CellStresses(const ElasticFields<dim> &fields,
                                  const DofVector  &cartesian_displacement,
                                  const LoadFactors factors,
                                  const dealii::Quadrature<dim> &rule)
    : fields(fields)
    , cartesian_displacement(cartesian_displacement)
    , heat_factor(fields.heat_factor(factors))
    , shape(fields.unknowns().dof_handler().get_fe().base_element(0),
            rule,
            fields.unknowns().symmetry())
    , cell_dofs(dim * shape.n_nodes())
    , cell_values(cell_dofs.size())
  {}



  template <int dim>
  void
  CellStresses<dim>::reinit(const Cell &new_cell)
  {
    cell = new_cell;
    shape.reinit(*cell);
    cell->get_dof_indices(cell_dofs);
    for (unsigned int i = 0; i < cell_dofs.size(); ++i)
      cell_values[i] = cartesian_displacement(cell_dofs[i]);
  }



  template <int dim>
  dealii::Tensor<1, dim>
  CellStresses<dim>::displacement(const unsigned int q) const
  {
    dealii::Tensor<1, dim> result;
    for (unsigned int i = 0; i < cell_values.size(); ++i)
      result[i % dim] += cell_values[i] * shape.shape_value(i / dim, q);
    return result;
  }



  template <int dim>
  dealii::Tensor<2, dim>
  CellStresses<dim>::gradient(const unsigned int q) const
  {
    dealii::Tensor<2, dim> result;
    // The basis sums to one: without vertex 0 there are only differences of
    // neighbours' displacements, and a translation rounds nothing away.
    for (unsigned int i = dim; i < cell_values.size(); ++i)
      result[i % dim] +=
        (cell_values[i] - cell_values[i % dim]) * shape.shape_grad(i / dim, q);
    return result;
  }



  template <int dim>
  dealii::SymmetricTensor<2, 3>
  CellStresses<dim>::strain(const unsigned int q) const
  {
    dealii::SymmetricTensor<2, 3> result =
      resized<3>(dealii::symmetrize(gradient(q)));
    for (unsigned int i = 0; i < cell_values.size(); i += dim)
      result[2][2] += cell_values[i] * shape.hoop_strain(i / dim, q);
    return result;
  }



  template <int dim>
  dealii::SymmetricTensor<2, 3>
  CellStresses<dim>::elastic_stress(const unsigned int q) const
  {
    return solid_tensor() * strain(q);
  }



  template <int dim>
  dealii::SymmetricTensor<2, 3>
  CellStresses<dim>::stress(const unsigned int q) const
  {
    return elastic_stress(q) -
           temperature_change(q) * fields.thermal_stress(cell);
  }



  template <int dim>
  double
  CellStresses<dim>::temperature_change(const unsigned int q) const
  {
    return heat_factor *
           fields.temperature_change(cell, shape.get_quadrature().point(q));
  }



  DEBOND_INSTANTIATE_CLASS(ElasticFields);
  DEBOND_INSTANTIATE_CLASS(CellStresses);
} // namespace Debond
