// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_fields_h
#define debond_elasticity_fields_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>
#include <deal.II/lac/vector.h>

#include <debond/elasticity/material.h>
#include <debond/elasticity/unknowns.h>
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
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

    /// Keeps a reference to the unknowns. @p applied_forces: the Cartesian
    /// nodal forces of all loads, at every degree of freedom.
    /// @p thermal_stresses: of each active cell the pressure that its change of
    /// temperature makes if it cannot expand; none if empty.
    ElasticFields(const ElasticUnknowns<dim>   &unknowns,
                  const ByRegion<Material>     &materials,
                  const dealii::Vector<double> &applied_forces,
                  const std::vector<double>    &thermal_stresses = {});

    const Material &
    material(const Cell &cell) const;

    /// The Cartesian nodal forces of all loads, at every degree of freedom, the
    /// constrained ones included.
    const dealii::Vector<double> &
    applied_nodal_forces() const;

    /// The resultant of all applied loads, in Cartesian components.
    dealii::Tensor<1, dim>
    total_load() const;

    /**
     * A u - f, f being @p load_factor times the load (and prescribed
     * displacements as many times as large), at every degree of freedom, the
     * constrained ones included: internal forces, from the cells' stresses,
     * minus the applied nodal forces, in the unknowns' frames. At constrained
     * degrees of freedom this is the reaction of the support, at u_nu of a
     * contact node minus the normal force of the foundation.
     */
    dealii::Vector<double>
    residual(const dealii::Vector<double> &u,
             const double                  load_factor = 1.) const;

    /**
     * What the rounding of u to double precision can make of residual(u,
     * load_factor) at each degree of freedom: epsilon (|A| |u| + |f|), with
     * norms of each cell's entries. No u can be expected to have a smaller
     * residual.
     */
    dealii::Vector<double>
    residual_rounding(const dealii::Vector<double> &u,
                      const double                  load_factor = 1.) const;

    /// Strain-energy density, stress and displacement gradient are constant
    /// on each cell: the stress of the active cell, in the units of E, with
    /// @p load_factor times the change of temperature.
    dealii::SymmetricTensor<2, dim>
    stress(const Cell                   &cell,
           const dealii::Vector<double> &cartesian_displacement,
           const double                  load_factor) const;

    /// The same with what the hypothesis of plane bodies implies.
    dealii::SymmetricTensor<2, 3>
    solid_stress(const Cell                   &cell,
                 const dealii::Vector<double> &cartesian_displacement,
                 const double                  load_factor) const;

    /// The displacement gradient of the cell, its row d that of component d.
    dealii::Tensor<2, dim>
    displacement_gradient(
      const Cell                   &cell,
      const dealii::Vector<double> &cartesian_displacement) const;

    /**
     * 1/2 <A u, u> - load_factor <f, u> from the strains of the cells, with
     * compensated sums: in a product with A, whose rows nearly cancel, rounding
     * grows with the condition of A, in the strains it does not.
     */
    double
    elastic_functional(const dealii::Vector<double> &u,
                       const double                  load_factor = 1.) const;

    /// The strain energy 1/2 <A u, u>, likewise.
    double
    strain_energy(const dealii::Vector<double> &u,
                  const double                  load_factor = 1.) const;

    /// <f, u>, the work of the whole load.
    double
    load_work(const dealii::Vector<double> &u,
              const double                  load_factor = 1.) const;

  private:
    /// u with its lifting, in the unknowns.
    dealii::Vector<double>
    lifted(const dealii::Vector<double> &u, const double load_factor) const;

    /// 1/2 <A u, u> - work_factor <f, u>.
    double
    energy(const dealii::Vector<double> &u,
           const double                  load_factor,
           const double                  work_factor) const;

    /// Of the cell, for the whole load.
    double
    thermal_stress(const Cell &cell) const;

    const ElasticUnknowns<dim>               &unknowns;
    ByRegion<Material>                        materials;
    ByRegion<dealii::SymmetricTensor<4, dim>> stiffness;
    dealii::Vector<double>                    applied_forces;
    std::vector<double>                       thermal_stresses;
  };
} // namespace Debond

#endif
