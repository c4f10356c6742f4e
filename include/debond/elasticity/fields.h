// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_fields_h
#define debond_elasticity_fields_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <debond/elasticity/cell_nodes.h>
#include <debond/elasticity/material.h>
#include <debond/elasticity/unknowns.h>
#include <debond/linear_algebra/dof_vector.h>
#include <debond/mesh/by_region.h>

#include <vector>

namespace Debond
{
  /// Stresses, energies and forces of a displacement, by loops over the cells
  /// that use no matrix. Vectors are those of ElasticUnknowns; the displacement
  /// that belongs to one is with its lifting.
  template <int dim>
  class ElasticFields
  {
  public:
    using Cell        = typename dealii::DoFHandler<dim>::active_cell_iterator;
    using Barycentric = typename BernsteinSimplex<dim>::Barycentric;

    /// Keeps a reference to the unknowns. @p applied_forces: the Cartesian
    /// nodal forces of all loads, at every degree of freedom; @p dead_forces:
    /// those of them that do not grow with the load factor, empty for none.
    /// @p thermal_stresses: of each point of BernsteinSimplex in each active
    /// cell the pressure that the change of temperature makes if the body
    /// cannot expand; none if empty.
    ElasticFields(const ElasticUnknowns<dim> &unknowns,
                  const ByRegion<Material>   &materials,
                  const DofVector            &applied_forces,
                  const std::vector<double>  &thermal_stresses = {},
                  const DofVector            &dead_forces      = {});

    const Material &
    material(const Cell &cell) const;

    /// The Cartesian nodal forces of all loads, at every degree of freedom, the
    /// constrained ones included.
    DofVector
    applied_nodal_forces(const LoadFactors factors = 1.) const;

    /// The resultant of all applied loads, in Cartesian components.
    dealii::Tensor<1, dim>
    total_load(const LoadFactors factors = 1.) const;

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

    /// Stress and displacement gradient are constant on each cell, linear of
    /// degree 2: the stress at a point of the active cell, by default its mean,
    /// in the units of E, with @p factors times the change of temperature.
    dealii::SymmetricTensor<2, dim>
    stress(const Cell        &cell,
           const DofVector   &cartesian_displacement,
           const LoadFactors  factors,
           const Barycentric &point = middle()) const;

    /// The same of a cell whose gradients and nodes are known.
    dealii::SymmetricTensor<2, dim>
    stress(const Cell                  &cell,
           const BernsteinSimplex<dim> &simplex,
           const CellNodes<dim>        &nodes,
           const DofVector             &cartesian_displacement,
           const LoadFactors            factors,
           const Barycentric           &point) const;

    /// The same with what the hypothesis of plane bodies implies.
    dealii::SymmetricTensor<2, 3>
    solid_stress(const Cell        &cell,
                 const DofVector   &cartesian_displacement,
                 const LoadFactors  factors,
                 const Barycentric &point = middle()) const;

    /// The displacement gradient in the cell, its row d that of component d.
    dealii::Tensor<2, dim>
    displacement_gradient(const Cell        &cell,
                          const DofVector   &cartesian_displacement,
                          const Barycentric &point = middle()) const;

    /**
     * 1/2 <A u, u> - <f, u>, f with @p factors, from the strains of the cells,
     * with compensated sums: in a product with A, whose rows nearly cancel,
     * rounding grows with the condition of A, in the strains it does not.
     */
    double
    elastic_functional(const DofVector  &u,
                       const LoadFactors factors = 1.) const;

    /// What elastic_functional() sums up: the strain energies of the cells (of
    /// degree 2 at each point of a cell) in their order, and the loads and the
    /// displacements in the unknowns' frames.
    struct Terms
    {
      std::vector<double> energies;
      DofVector           load;
      DofVector           displacement;

      double
      sum() const;
    };

    Terms
    elastic_terms(const DofVector &u, const LoadFactors factors = 1.) const;

    /// The strain energy 1/2 <A u, u>, likewise.
    double
    strain_energy(const DofVector &u, const LoadFactors factors = 1.) const;

    /// <f, u>, the work of the whole load that grows with its factor.
    double
    load_work(const DofVector &u, const LoadFactors factors = 1.) const;

    /// The barycentric coordinates of a cell's middle.
    static Barycentric
    middle();

  private:
    /// u with its lifting, in the unknowns.
    DofVector
    lifted(const DofVector &u, const LoadFactors factors) const;

    /// With a load given in the unknowns' frames.
    Terms
    terms(const DofVector  &u,
          const LoadFactors factors,
          const DofVector  &load) const;

    /// The displacement gradient, of a cell that is known.
    static dealii::Tensor<2, dim>
    gradient(const BernsteinSimplex<dim> &simplex,
             const CellNodes<dim>        &nodes,
             const DofVector             &cartesian_displacement,
             const Barycentric           &point);

    /// At a point of the cell, for the whole load.
    double
    thermal_stress(const Cell &cell, const Barycentric &point) const;

    const ElasticUnknowns<dim>               &unknowns;
    ByRegion<Material>                        materials;
    ByRegion<dealii::SymmetricTensor<4, dim>> stiffness;
    DofVector                                 live_forces;
    DofVector                                 dead_forces; ///< or empty
    std::vector<double>                       thermal_stresses;
  };
} // namespace Debond

#endif
