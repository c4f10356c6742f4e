// SPDX-License-Identifier: LGPL-2.1-or-later
// ElasticProblem: from cells to matrices, vectors and forces.
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>

#include <debond/elasticity/elastic_problem.h>
#include <debond/elasticity/linear_simplex.h>

#include <boost/accumulators/accumulators.hpp>
#include <boost/accumulators/statistics/stats.hpp>
#include <boost/accumulators/statistics/sum_kahan.hpp>

#include <cmath>
#include <limits>

namespace Debond
{
  template <int dim>
  void
  ElasticProblem<dim>::assemble(const Material     &new_material,
                                const Loads<dim>   &loads,
                                const MatrixStorage new_storage)
  {
    new_material.validate<dim>();
    applied_forces   = load_vector(dofs, loads);
    elastic_material = new_material;
    stiffness        = new_material.elasticity_tensor<dim>();

    system_load = in_frames(applied_forces);
    constraints.set_zero(system_load);

    dealii::DynamicSparsityPattern pattern(dofs.n_dofs());
    dealii::DoFTools::make_sparsity_pattern(dofs,
                                            pattern,
                                            constraints,
                                            /*keep_constrained_dofs=*/false);
    storage = new_storage;
    system_matrix.clear();
    distributed_matrix.reset();
    if (storage == MatrixStorage::serial)
      {
        sparsity.copy_from(pattern);
        system_matrix.reinit(sparsity);
        add_cell_matrices(system_matrix);
      }
    else
      {
        distributed_matrix =
          std::make_unique<dealii::TrilinosWrappers::SparseMatrix>();
        distributed_matrix->reinit(pattern);
        add_cell_matrices(*distributed_matrix);
        distributed_matrix->compress(dealii::VectorOperation::add);
      }
  }



  template <int dim>
  template <typename MatrixType>
  void
  ElasticProblem<dim>::add_cell_matrices(MatrixType &matrix) const
  {
    const unsigned int         n_cell_dofs = fe.n_dofs_per_cell();
    dealii::FullMatrix<double> cell_matrix(n_cell_dofs);
    std::vector<dealii::types::global_dof_index> cell_dofs(n_cell_dofs);
    std::array<dealii::SymmetricTensor<2, dim>, dim *(dim + 1)> strains;

    for (const auto &cell : dofs.active_cell_iterators())
      {
        const LinearSimplex<dim> simplex(cell);

        // The basis function of the unknown k of vertex v is phi_v times the
        // direction of the unknown.
        for (unsigned int v = 0; v <= dim; ++v)
          {
            const unsigned int frame = frame_of_vertex[cell->vertex_index(v)];
            for (unsigned int k = 0; k < dim; ++k)
              {
                dealii::Tensor<1, dim> direction;
                if (frame == dealii::numbers::invalid_unsigned_int)
                  direction[k] = 1.;
                else
                  for (unsigned int d = 0; d < dim; ++d)
                    direction[d] = frames[frame].to_cartesian[d][k];

                const unsigned int i = v * dim + k;
                cell_dofs[i]         = cell->vertex_dof_index(v, k);
                strains[i]           = dealii::symmetrize(
                  dealii::outer_product(direction, simplex.gradients[v]));
              }
          }

        for (unsigned int i = 0; i < n_cell_dofs; ++i)
          {
            const dealii::SymmetricTensor<2, dim> weighted_stress =
              simplex.volume * (stiffness * strains[i]);
            for (unsigned int j = 0; j < n_cell_dofs; ++j)
              cell_matrix(i, j) = weighted_stress * strains[j];
          }
        constraints.distribute_local_to_global(cell_matrix, cell_dofs, matrix);
      }
  }



  template <int dim>
  dealii::Vector<double>
  ElasticProblem<dim>::in_frames(const dealii::Vector<double> &forces) const
  {
    dealii::Vector<double> result = forces;
    for (const Frame &frame : frames)
      for (unsigned int k = 0; k < dim; ++k)
        {
          result[frame.dofs[k]] = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            result[frame.dofs[k]] +=
              frame.to_cartesian[d][k] * forces[frame.dofs[d]];
        }
    return result;
  }



  template <int dim>
  dealii::Vector<double>
  ElasticProblem<dim>::cartesian_forces(
    const dealii::Vector<double> &forces) const
  {
    dealii::Vector<double> result = forces;
    for (const Frame &frame : frames)
      for (unsigned int d = 0; d < dim; ++d)
        {
          result[frame.dofs[d]] = 0.;
          for (unsigned int k = 0; k < dim; ++k)
            result[frame.dofs[d]] +=
              frame.to_frame[k][d] * forces[frame.dofs[k]];
        }
    return result;
  }



  template <int dim>
  dealii::Vector<double>
  ElasticProblem<dim>::cartesian_displacement(
    const dealii::Vector<double> &u) const
  {
    dealii::Vector<double> result = u;
    for (const Frame &frame : frames)
      for (unsigned int d = 0; d < dim; ++d)
        {
          result[frame.dofs[d]] = 0.;
          for (unsigned int k = 0; k < dim; ++k)
            result[frame.dofs[d]] +=
              frame.to_cartesian[d][k] * u[frame.dofs[k]];
        }
    return result;
  }



  template <int dim>
  dealii::Vector<double>
  ElasticProblem<dim>::unknowns(
    const dealii::Vector<double> &cartesian_displacement) const
  {
    dealii::Vector<double> result = cartesian_displacement;
    for (const Frame &frame : frames)
      for (unsigned int k = 0; k < dim; ++k)
        {
          result[frame.dofs[k]] = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            result[frame.dofs[k]] +=
              frame.to_frame[k][d] * cartesian_displacement[frame.dofs[d]];
        }
    constraints.set_zero(result);
    return result;
  }



  template <int dim>
  std::vector<dealii::Vector<double>>
  ElasticProblem<dim>::rigid_body_modes() const
  {
    constexpr unsigned int              n_rotations = dim * (dim - 1) / 2;
    std::vector<dealii::Vector<double>> modes(
      dim + n_rotations, dealii::Vector<double>(dofs.n_dofs()));
    for (const auto &cell : dofs.active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        {
          for (unsigned int d = 0; d < dim; ++d)
            modes[d][cell->vertex_dof_index(v, d)] = 1.;
          // The rotation in the plane of the axes d and e.
          unsigned int rotation = dim;
          for (unsigned int d = 0; d < dim; ++d)
            for (unsigned int e = d + 1; e < dim; ++e, ++rotation)
              {
                modes[rotation][cell->vertex_dof_index(v, d)] =
                  -cell->vertex(v)[e];
                modes[rotation][cell->vertex_dof_index(v, e)] =
                  cell->vertex(v)[d];
              }
        }
    for (dealii::Vector<double> &mode : modes)
      mode = unknowns(mode);
    return modes;
  }



  template <int dim>
  dealii::Vector<double>
  ElasticProblem<dim>::residual(const dealii::Vector<double> &u,
                                const double                  load_factor) const
  {
    const dealii::Vector<double> displacement = cartesian_displacement(u);

    dealii::Vector<double> forces(dofs.n_dofs());
    for (const auto &cell : dofs.active_cell_iterators())
      {
        const LinearSimplex<dim>              simplex(cell);
        const dealii::SymmetricTensor<2, dim> sigma =
          stress(cell, displacement);
        for (unsigned int v = 0; v <= dim; ++v)
          {
            const dealii::Tensor<1, dim> force =
              simplex.volume * (sigma * simplex.gradients[v]);
            for (unsigned int d = 0; d < dim; ++d)
              forces[cell->vertex_dof_index(v, d)] += force[d];
          }
      }
    forces.add(-load_factor, applied_forces);
    return in_frames(forces);
  }



  template <int dim>
  dealii::Vector<double>
  ElasticProblem<dim>::residual_rounding(const dealii::Vector<double> &u,
                                         const double load_factor) const
  {
    const dealii::Vector<double> displacement = cartesian_displacement(u);
    const double                 modulus      = stiffness.norm();

    dealii::Vector<double> rounding(dofs.n_dofs());
    for (const auto &cell : dofs.active_cell_iterators())
      {
        const LinearSimplex<dim> simplex(cell);
        double                   gradient = 0.;
        for (unsigned int v = 0; v <= dim; ++v)
          {
            double size = 0.;
            for (unsigned int d = 0; d < dim; ++d)
              size += std::abs(displacement[cell->vertex_dof_index(v, d)]);
            gradient += size * simplex.gradients[v].norm();
          }
        for (unsigned int v = 0; v <= dim; ++v)
          for (unsigned int d = 0; d < dim; ++d)
            rounding[cell->vertex_dof_index(v, d)] +=
              simplex.volume * modulus * gradient * simplex.gradients[v].norm();
      }
    for (unsigned int i = 0; i < rounding.size(); ++i)
      rounding[i] = std::numeric_limits<double>::epsilon() *
                    (rounding[i] + std::abs(load_factor * applied_forces[i]));
    return rounding;
  }



  template <int dim>
  dealii::SymmetricTensor<2, dim>
  ElasticProblem<dim>::stress(
    const typename dealii::DoFHandler<dim>::active_cell_iterator &cell,
    const dealii::Vector<double> &cartesian_displacement) const
  {
    return stiffness * dealii::symmetrize(
                         displacement_gradient(cell, cartesian_displacement));
  }



  template <int dim>
  dealii::Tensor<2, dim>
  ElasticProblem<dim>::displacement_gradient(
    const typename dealii::DoFHandler<dim>::active_cell_iterator &cell,
    const dealii::Vector<double> &cartesian_displacement) const
  {
    const LinearSimplex<dim> simplex(cell);
    dealii::Tensor<2, dim>   gradient;
    // The basis sums to one: without vertex 0 there are only differences of
    // neighbours' displacements, and a translation rounds nothing away.
    for (unsigned int v = 1; v <= dim; ++v)
      {
        dealii::Tensor<1, dim> difference;
        for (unsigned int d = 0; d < dim; ++d)
          difference[d] = cartesian_displacement[cell->vertex_dof_index(v, d)] -
                          cartesian_displacement[cell->vertex_dof_index(0, d)];
        gradient += dealii::outer_product(difference, simplex.gradients[v]);
      }
    return gradient;
  }



  template <int dim>
  double
  ElasticProblem<dim>::elastic_functional(const dealii::Vector<double> &u,
                                          const double load_factor) const
  {
    const dealii::Vector<double> displacement = cartesian_displacement(u);
    namespace accumulators                    = boost::accumulators;
    accumulators::
      accumulator_set<double, accumulators::stats<accumulators::tag::sum_kahan>>
        sum;
    for (const auto &cell : dofs.active_cell_iterators())
      {
        const dealii::SymmetricTensor<2, dim> strain =
          dealii::symmetrize(displacement_gradient(cell, displacement));
        sum(0.5 * LinearSimplex<dim>(cell).volume *
            (strain * (stiffness * strain)));
      }
    for (unsigned int i = 0; i < u.size(); ++i)
      sum(-load_factor * system_load(i) * u(i));
    return accumulators::sum_kahan(sum);
  }



  template <int dim>
  dealii::Tensor<1, dim>
  ElasticProblem<dim>::total_load() const
  {
    dealii::Tensor<1, dim> result;
    std::vector<bool>      visited(frame_of_vertex.size(), false);
    for (const auto &cell : dofs.active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        if (!visited[cell->vertex_index(v)])
          {
            visited[cell->vertex_index(v)] = true;
            for (unsigned int d = 0; d < dim; ++d)
              result[d] += applied_forces[cell->vertex_dof_index(v, d)];
          }
    return result;
  }



  template void
  ElasticProblem<2>::assemble(const Material &,
                              const Loads<2> &,
                              const MatrixStorage);
  template dealii::Vector<double>
  ElasticProblem<2>::in_frames(const dealii::Vector<double> &) const;
  template dealii::Vector<double>
  ElasticProblem<2>::cartesian_forces(const dealii::Vector<double> &) const;
  template dealii::Vector<double>
  ElasticProblem<2>::cartesian_displacement(
    const dealii::Vector<double> &) const;
  template dealii::Vector<double>
  ElasticProblem<2>::unknowns(const dealii::Vector<double> &) const;
  template dealii::Vector<double>
  ElasticProblem<2>::residual(const dealii::Vector<double> &,
                              const double) const;
  template dealii::Vector<double>
  ElasticProblem<2>::residual_rounding(const dealii::Vector<double> &,
                                       const double) const;
  template std::vector<dealii::Vector<double>>
  ElasticProblem<2>::rigid_body_modes() const;
  template dealii::SymmetricTensor<2, 2>
  ElasticProblem<2>::stress(
    const typename dealii::DoFHandler<2>::active_cell_iterator &,
    const dealii::Vector<double> &) const;
  template dealii::Tensor<2, 2>
  ElasticProblem<2>::displacement_gradient(
    const typename dealii::DoFHandler<2>::active_cell_iterator &,
    const dealii::Vector<double> &) const;
  template double
  ElasticProblem<2>::elastic_functional(const dealii::Vector<double> &,
                                        const double) const;
  template dealii::Tensor<1, 2>
  ElasticProblem<2>::total_load() const;
  template void
  ElasticProblem<3>::assemble(const Material &,
                              const Loads<3> &,
                              const MatrixStorage);
  template dealii::Vector<double>
  ElasticProblem<3>::in_frames(const dealii::Vector<double> &) const;
  template dealii::Vector<double>
  ElasticProblem<3>::cartesian_forces(const dealii::Vector<double> &) const;
  template dealii::Vector<double>
  ElasticProblem<3>::cartesian_displacement(
    const dealii::Vector<double> &) const;
  template dealii::Vector<double>
  ElasticProblem<3>::unknowns(const dealii::Vector<double> &) const;
  template dealii::Vector<double>
  ElasticProblem<3>::residual(const dealii::Vector<double> &,
                              const double) const;
  template dealii::Vector<double>
  ElasticProblem<3>::residual_rounding(const dealii::Vector<double> &,
                                       const double) const;
  template std::vector<dealii::Vector<double>>
  ElasticProblem<3>::rigid_body_modes() const;
  template dealii::SymmetricTensor<2, 3>
  ElasticProblem<3>::stress(
    const typename dealii::DoFHandler<3>::active_cell_iterator &,
    const dealii::Vector<double> &) const;
  template dealii::Tensor<2, 3>
  ElasticProblem<3>::displacement_gradient(
    const typename dealii::DoFHandler<3>::active_cell_iterator &,
    const dealii::Vector<double> &) const;
  template double
  ElasticProblem<3>::elastic_functional(const dealii::Vector<double> &,
                                        const double) const;
  template dealii::Tensor<1, 3>
  ElasticProblem<3>::total_load() const;
} // namespace Debond
