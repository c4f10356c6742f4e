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
      // The displacement has its lifting already, and no load factor enters:
      // elastic stresses do not depend on it. A rank visits its own cells, each
      // of which belongs to one rank, so that sums over ranks count every cell
      // once.
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
    // What grows with the load factor is what remains of all forces without the
    // dead ones.
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
    // The residual A u - f is summed up from stresses: the force on node k is
    // int C eps(u) grad phi_k, by the rule that integrates products of two
    // strains exactly. The matrix A is not used, so that this also checks it,
    // and the rounding is that of strains. Forces are Cartesian until the loads
    // are subtracted; the change of basis then takes them to the unknowns,
    // where constrained entries keep the reactions.
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
    // A bound for what the rounding of the entries of u makes of the residual:
    // products of absolute values in place of the terms of A u, cell by cell.
    // |eps| is at most the sum of |u_i| |grad phi_i|, the stress at most |C|
    // |eps| in the norm of tensors, and the force on a node that times |grad
    // phi_k|. Displacements of glued nodes are sums of unknowns that may be
    // larger than them, which sizes_of_terms() takes into account.
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
    // Loads have a rounding of their own, relative to themselves.
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
    // The values at the points of strain_rule() are those of a function on the
    // cell, one that is constant for degree 1 and linear for degree 2. Cells
    // are numbered as in temperature_changes().
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
    // The work includes that on prescribed displacements and gaps: u is with
    // its lifting, and the dead loads are not in the live ones.
    return elastic_unknowns.basis().forces_to_unknowns(live_forces) *
           elastic_unknowns.lifted(u, factors);
  }



  template <int dim>
  double
  ElasticFields<dim>::functional(const DofVector  &u,
                                 const LoadFactors factors,
                                 const DofVector  &load) const
  {
    // The energy is a sum of positive terms of each point of each cell, 1/2 eps
    // : C eps, from which the work of the load is subtracted entry by entry.
    // Kahan's compensated sum loses no digits to the number of terms. In <A u,
    // u> rows of A nearly cancel, and the rounding would grow with the
    // condition of A. Each degree of freedom counts on the rank that owns it,
    // and only the sums of the ranks are added at last.
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
    // The base element is the scalar one. The unknowns of a cell come node by
    // node, component d of node k having the number dim k + d.
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
    // Unknown i of the cell belongs to the node i / dim and the component i %
    // dim.
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
    // The basis sums to one, so that its gradients sum to zero: the value at
    // vertex 0 can be subtracted from all others. What remains are differences
    // of neighbours' displacements, and a translation of the whole body, which
    // is often much larger, rounds no digit of the strain away.
    for (unsigned int i = dim; i < cell_values.size(); ++i)
      result[i % dim] +=
        (cell_values[i] - cell_values[i % dim]) * shape.shape_grad(i / dim, q);
    return result;
  }



  template <int dim>
  dealii::SymmetricTensor<2, 3>
  CellStresses<dim>::strain(const unsigned int q) const
  {
    // The strain is that of the solid, a tensor with three rows in 2D as well,
    // whose shear components are halves of the angles. Across a plane body it
    // is zero, and what plane stress strains the body there is not needed, as
    // the tensor C has been condensed. Around an axis it is u_r / r.
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
    // The stress is C (eps - theta alpha): thermal strains make no stress by
    // themselves.
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
