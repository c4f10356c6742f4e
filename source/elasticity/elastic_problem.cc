// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>

#include <debond/base/ranks.h>
#include <debond/elasticity/elastic_problem.h>
#include <debond/elasticity/temperature_load.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace Debond
{
  template <int dim>
  void
  ElasticProblem<dim>::assemble(const ByRegion<Material> &materials,
                                const Loads<dim>         &loads,
                                const Loads<dim>         &dead_loads)
  {
    const dealii::DoFHandler<dim> &dofs = elastic_unknowns.dof_handler();
    const dealii::AffineConstraints<double> &constraints =
      elastic_unknowns.constraints();

    materials.transformed([](const Material &material) {
      material.validate<dim>();
      return true;
    });
    notes.clear();
    const MPI_Comm      ranks = elastic_unknowns.communicator();
    std::vector<double> pressures;
    DofVector           applied_forces, dead_forces;
    on_all_ranks(ranks, [&]() {
      pressures      = thermal_stresses(dofs.get_triangulation(),
                                   materials,
                                   loads,
                                   dofs.get_fe().degree);
      applied_forces = load_vector(dofs, loads, &notes);
      add_thermal_forces(dofs, pressures, applied_forces);
      if (dead_loads.body_force || !dead_loads.tractions.empty())
        dead_forces = load_vector(dofs, dead_loads, &notes);
    });
    notes = union_of_ranks(notes, ranks);
    add_over_ranks(applied_forces, ranks);
    if (dead_forces.size() > 0)
      {
        add_over_ranks(dead_forces, ranks);
        applied_forces += dead_forces;
      }
    elastic_fields = std::make_unique<ElasticFields<dim>>(
      elastic_unknowns, materials, applied_forces, pressures, dead_forces);

    const auto load_with = [&](const LoadFactors factors) {
      DofVector load =
        elastic_fields->residual(DofVector(dofs.n_dofs()), factors);
      load *= -1.;
      constraints.set_zero(load);
      return load;
    };
    f_0.reinit(0);
    f_2.reinit(0);
    if (elastic_unknowns.has_gap() || dead_forces.size() > 0)
      f_0 = load_with(0.);
    if (elastic_unknowns.has_prescribed_displacements())
      {
        f_2 = load_with(LoadFactors(0., 1.));
        if (f_0.size() > 0)
          f_2 -= f_0;
      }
    if (elastic_unknowns.has_lifting())
      whole_load = load_with(1.);
    else
      whole_load = elastic_unknowns.in_frames(applied_forces);
    constraints.set_zero(whole_load);

    // Cells of other ranks around the own ones make own rows complete.
    dealii::DynamicSparsityPattern               pattern(dofs.n_dofs(),
                                           dofs.n_dofs(),
                                           dofs.locally_owned_dofs());
    std::vector<dealii::types::global_dof_index> cell_dofs(
      dofs.get_fe().dofs_per_cell);
    for (const auto &cell : dofs.active_cell_iterators())
      {
        cell->get_dof_indices(cell_dofs);
        constraints.add_entries_local_to_global(
          cell_dofs, pattern, /*keep_constrained_entries=*/false);
      }
    system_matrix.clear();
    distributed.reset();
    sparsity.copy_from(pattern);
    system_matrix.reinit(sparsity);
    add_cell_matrices(materials);
  }



  template <int dim>
  void
  ElasticProblem<dim>::add_cell_matrices(const ByRegion<Material> &materials)
  {
    const auto  stiffness = materials.transformed([](const Material &material) {
      return material.elasticity_tensor<dim>();
    });
    const auto &dofs      = elastic_unknowns.dof_handler();
    dealii::FEValues<dim> fe_values(elastic_unknowns.mapping(),
                                    dofs.get_fe(),
                                    strain_rule<dim>(elastic_unknowns.degree()),
                                    dealii::update_gradients |
                                      dealii::update_JxW_values);
    const dealii::FEValuesExtractors::Vector     displacement(0);
    const unsigned int                           n = fe_values.dofs_per_cell;
    dealii::FullMatrix<double>                   cell_matrix(n);
    std::vector<dealii::types::global_dof_index> cell_dofs(n);
    std::vector<dealii::SymmetricTensor<2, dim>> strains(n);

    const dealii::IndexSet   &own = dofs.locally_owned_dofs();
    std::vector<unsigned int> order(n);
    std::vector<dealii::types::global_dof_index> columns;
    std::vector<double>                          values;
    for (const auto &cell : dofs.active_cell_iterators())
      {
        fe_values.reinit(cell);
        cell->get_dof_indices(cell_dofs);
        cell_matrix = 0.;
        for (const unsigned int q : fe_values.quadrature_point_indices())
          {
            for (unsigned int i = 0; i < n; ++i)
              strains[i] = fe_values[displacement].symmetric_gradient(i, q);
            for (unsigned int i = 0; i < n; ++i)
              {
                const dealii::SymmetricTensor<2, dim> weighted_stress =
                  fe_values.JxW(q) *
                  (stiffness(cell->material_id()) * strains[i]);
                for (unsigned int j = 0; j < n; ++j)
                  cell_matrix(i, j) += weighted_stress * strains[j];
              }
          }
        elastic_unknowns.to_unknowns(cell_dofs, cell_matrix);

        // As AffineConstraints does it, but for rows of other ranks.
        std::iota(order.begin(), order.end(), 0U);
        std::sort(order.begin(),
                  order.end(),
                  [&](const unsigned int a, const unsigned int b) {
                    return cell_dofs[a] < cell_dofs[b];
                  });
        columns.clear();
        for (const unsigned int j : order)
          if (!elastic_unknowns.is_constrained(cell_dofs[j]))
            columns.push_back(cell_dofs[j]);
        for (unsigned int i = 0; i < n; ++i)
          {
            const auto row = cell_dofs[i];
            if (!own.is_element(row))
              continue;
            if (elastic_unknowns.is_constrained(row))
              {
                system_matrix.add(row, row, std::abs(cell_matrix(i, i)));
                continue;
              }
            values.clear();
            for (const unsigned int j : order)
              if (!elastic_unknowns.is_constrained(cell_dofs[j]))
                values.push_back(cell_matrix(i, j));
            system_matrix.add(row,
                              static_cast<unsigned int>(columns.size()),
                              columns.data(),
                              values.data(),
                              /*elide_zero_values=*/false,
                              /*col_indices_are_sorted=*/true);
          }
      }
  }



  template <int dim>
  DofVector
  ElasticProblem<dim>::diagonal() const
  {
    DofVector result(elastic_unknowns.n_dofs());
    for (const auto i : elastic_unknowns.dof_handler().locally_owned_dofs())
      result(i) = system_matrix.diag_element(i);
    add_over_ranks(result, elastic_unknowns.communicator());
    return result;
  }



  template <int dim>
  const ElasticFields<dim> &
  ElasticProblem<dim>::fields() const
  {
    Assert(elastic_fields, dealii::ExcInvalidState());
    return *elastic_fields;
  }



  template <int dim>
  const DistributedMatrix &
  ElasticProblem<dim>::distributed_matrix() const
  {
    if (!distributed)
      distributed = std::make_unique<const DistributedMatrix>(
        MatrixOnRanks(system_matrix,
                      elastic_unknowns.dof_handler().locally_owned_dofs(),
                      elastic_unknowns.communicator()));
    return *distributed;
  }



  template <int dim>
  DofVector
  ElasticProblem<dim>::load(const LoadFactors factors) const
  {
    DofVector load = whole_load;
    load *= factors.loads;
    if (f_0.size() > 0)
      load.add(1. - factors.loads, f_0);
    if (f_2.size() > 0)
      load.add(factors.displacements - factors.loads, f_2);
    return load;
  }



  template <int dim>
  double
  ElasticProblem<dim>::lifting_energy(const LoadFactors factors) const
  {
    return elastic_unknowns.has_lifting() ?
             elastic_fields->elastic_functional(
               DofVector(elastic_unknowns.n_dofs()), factors) :
             0.;
  }



  template class ElasticProblem<2>;
  template class ElasticProblem<3>;
} // namespace Debond
