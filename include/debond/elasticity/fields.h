// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_fields_h
#define debond_elasticity_fields_h

#include <debond/elasticity/material.h>
#include <debond/elasticity/simplex_values.h>
#include <debond/elasticity/unknowns.h>
#include <debond/mesh/by_region.h>

namespace Debond
{
  /// Stresses, energies and forces of a displacement, by loops over the cells
  /// that use no matrix. Vectors are those of ElasticUnknowns; the displacement
  /// that belongs to one is with its lifting.
  template <int dim>
  class ElasticFields
  {
  public:
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

    /// Keeps a reference to the unknowns. @p applied_forces: the Cartesian
    /// nodal forces of all loads, at every degree of freedom; @p dead_forces:
    /// those of them that do not grow with the load factor, empty for none.
    /// @p temperature_changes: of each point of strain_rule() in each active
    /// cell, none if empty; @p heat_is_dead: they stay as they are, too.
    ElasticFields(const ElasticUnknowns<dim> &unknowns,
                  const ByRegion<Material>   &materials,
                  const DofVector            &applied_forces,
                  const std::vector<double>  &temperature_changes = {},
                  const DofVector            &dead_forces         = {},
                  const bool                  heat_is_dead        = false);

    const Material &
    material(const Cell &cell) const
    {
      return materials(cell->material_id());
    }

    /// The Cartesian nodal forces of all loads, at every degree of freedom, the
    /// constrained ones included.
    DofVector
    applied_nodal_forces(const LoadFactors factors = 1.) const;

    /**
     * A u - f with @p factors times the load and prescribed displacements, at
     * every degree of freedom, the constrained ones included: internal forces,
     * from the cells' stresses, minus the applied nodal forces, in the
     * unknowns' frames. At constrained degrees of freedom this is the reaction
     * of the support, at u_nu of a contact node minus the normal force of the
     * foundation.
     */
    DofVector
    residual(const DofVector &u, const LoadFactors factors = 1.) const;

    /**
     * What the rounding of u to double precision can make of residual(u,
     * factors) at each degree of freedom: epsilon (|A| |u| + |f|), with
     * norms of each cell's entries. No u can be expected to have a smaller
     * residual.
     */
    DofVector
    residual_rounding(const DofVector &u, const LoadFactors factors = 1.) const;

    /// Material::solid_tensor().
    const dealii::SymmetricTensor<4, 3> &
    solid_tensor(const Cell &cell) const
    {
      return stiffness(cell->material_id());
    }

    double
    stiffness_norm(const Cell &cell) const
    {
      return stiffness_norms(cell->material_id());
    }

    /// Material::thermal_stress().
    const dealii::SymmetricTensor<2, 3> &
    thermal_stress(const Cell &cell) const
    {
      return thermal_stresses(cell->material_id());
    }

    /// The whole change of temperature at a point of the reference cell; linear
    /// in each cell of degree 2, else constant.
    double
    temperature_change(const Cell               &cell,
                       const dealii::Point<dim> &unit_point) const;

    /// What multiplies it.
    double
    heat_factor(const LoadFactors factors) const
    {
      return heat_is_dead ? 1. : factors.loads;
    }

    const ElasticUnknowns<dim> &
    unknowns() const
    {
      return elastic_unknowns;
    }

    /**
     * 1/2 <A u, u> - <f, u>, f with @p factors, from the strains of the cells,
     * with compensated sums: in a product with A, whose rows nearly cancel,
     * rounding grows with the condition of A, in the strains it does not.
     */
    double
    elastic_functional(const DofVector  &u,
                       const LoadFactors factors = 1.) const;

    /// The strain energy 1/2 <A u, u>, likewise.
    double
    strain_energy(const DofVector &u, const LoadFactors factors = 1.) const;

    /// <f, u>, the work of the whole load that grows with its factor.
    double
    load_work(const DofVector &u, const LoadFactors factors = 1.) const;

  private:
    /// 1/2 <A u, u> - <load, u> with a load on the unknowns.
    double
    functional(const DofVector  &u,
               const LoadFactors factors,
               const DofVector  &load) const;

    const ElasticUnknowns<dim>             &elastic_unknowns;
    ByRegion<Material>                      materials;
    ByRegion<dealii::SymmetricTensor<4, 3>> stiffness;
    ByRegion<double>                        stiffness_norms;
    ByRegion<dealii::SymmetricTensor<2, 3>> thermal_stresses;
    DofVector                               live_forces;
    DofVector                               dead_forces; ///< or empty
    std::vector<double>                     temperature_changes;
    bool                                    heat_is_dead;
  };



  /// Gradients and stresses of a displacement in one cell after the other, at
  /// the points of a rule. Where that is one point they are means, of degree 1
  /// too where thermal stresses are.
  template <int dim>
  class CellStresses
  {
  public:
    using Cell = typename ElasticFields<dim>::Cell;

    /// Keeps references. @p cartesian_displacement: with @p factors times the
    /// load.
    CellStresses(
      const ElasticFields<dim>      &fields,
      const DofVector               &cartesian_displacement,
      const LoadFactors              factors = 1.,
      const dealii::Quadrature<dim> &rule    = dealii::QGaussSimplex<dim>(1));

    void
    reinit(const Cell &cell);

    const dealii::SymmetricTensor<4, 3> &
    solid_tensor() const
    {
      return fields.solid_tensor(cell);
    }

    double
    stiffness_norm() const
    {
      return fields.stiffness_norm(cell);
    }

    /// The shape functions in the cell, of each component.
    const SimplexValues<dim> &
    values() const
    {
      return shape;
    }

    /// The degrees of freedom of the cell.
    const std::vector<dealii::types::global_dof_index> &
    dofs() const
    {
      return cell_dofs;
    }

    dealii::Tensor<1, dim>
    displacement(const unsigned int q) const;

    /// Its row d is that of component d.
    dealii::Tensor<2, dim>
    gradient(const unsigned int q) const;

    /// The strain of the solid, whose components across a plane body are zero;
    /// u_r / r is the one across the mesh of a body of revolution.
    dealii::SymmetricTensor<2, 3>
    strain(const unsigned int q) const;

    /// C eps: without thermal stresses, as are those of the solid that the
    /// hypothesis implies across a plane body.
    dealii::SymmetricTensor<2, 3>
    elastic_stress(const unsigned int q) const;

    /// The stress with that of the temperature, in the units of E.
    dealii::SymmetricTensor<2, 3>
    stress(const unsigned int q) const;

  private:
    double
    temperature_change(const unsigned int q) const;

    const ElasticFields<dim> &fields;
    const DofVector          &cartesian_displacement;
    const double              heat_factor;
    SimplexValues<dim>        shape;

    // Of the cell.
    Cell                                         cell;
    std::vector<dealii::types::global_dof_index> cell_dofs;
    std::vector<double>                          cell_values;
  };
} // namespace Debond

#endif
