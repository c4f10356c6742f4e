// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/fields.h>

#include <boost/accumulators/accumulators.hpp>
#include <boost/accumulators/statistics/stats.hpp>
#include <boost/accumulators/statistics/sum_kahan.hpp>

#include <cmath>
#include <limits>
#include <vector>

namespace Debond
{
  template <int dim>
  ElasticFields<dim>::ElasticFields(const ElasticUnknowns<dim> &unknowns,
                                    const ByRegion<Material>   &materials,
                                    const DofVector            &applied_forces,
                                    const std::vector<double> &thermal_stresses,
                                    const DofVector           &dead_forces)
    : unknowns(unknowns)
    , materials(materials)
    , stiffness(materials.transformed([](const Material &material) {
      return material.elasticity_tensor<dim>();
    }))
    , live_forces(applied_forces)
    , dead_forces(dead_forces)
    , thermal_stresses(thermal_stresses)
  {
    if (dead_forces.size() > 0)
      live_forces -= dead_forces;
  }



  template <int dim>
  const Material &
  ElasticFields<dim>::material(const Cell &cell) const
  {
    return materials(cell->material_id());
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
    const DofVector displacement = unknowns.cartesian_displacement(u, factors);

    DofVector forces(unknowns.n_dofs());
    for (const auto &cell : unknowns.dof_handler().active_cell_iterators())
      {
        const BernsteinSimplex<dim> simplex(cell, unknowns.degree());
        const CellNodes<dim>        nodes(cell);
        for (unsigned int q = 0; q < simplex.n_points; ++q)
          {
            const Barycentric                     point = simplex.point(q);
            const dealii::SymmetricTensor<2, dim> sigma =
              stiffness(cell->material_id()) *
              dealii::symmetrize(gradient(simplex, nodes, displacement, point));
            for (unsigned int n = 0; n < nodes.size; ++n)
              {
                const dealii::Tensor<1, dim> force =
                  simplex.weight * (sigma * simplex.gradient(n, point));
                for (unsigned int d = 0; d < dim; ++d)
                  forces[nodes.dofs[n][d]] += force[d];
              }
          }
      }
    forces -= applied_nodal_forces(factors);
    return unknowns.in_frames(forces);
  }



  template <int dim>
  DofVector
  ElasticFields<dim>::residual_rounding(const DofVector  &u,
                                        const LoadFactors factors) const
  {
    const DofVector displacement = unknowns.cartesian_displacement(u, factors);

    DofVector rounding(unknowns.n_dofs());
    for (const auto &cell : unknowns.dof_handler().active_cell_iterators())
      {
        const BernsteinSimplex<dim> simplex(cell, unknowns.degree());
        const CellNodes<dim>        nodes(cell);
        const double modulus = stiffness(cell->material_id()).norm();
        for (unsigned int q = 0; q < simplex.n_points; ++q)
          {
            const Barycentric point         = simplex.point(q);
            double            size_gradient = 0.;
            for (unsigned int n = 0; n < nodes.size; ++n)
              {
                double size = 0.;
                for (unsigned int d = 0; d < dim; ++d)
                  size += std::abs(displacement[nodes.dofs[n][d]]);
                size_gradient += size * simplex.gradient(n, point).norm();
              }
            for (unsigned int n = 0; n < nodes.size; ++n)
              for (unsigned int d = 0; d < dim; ++d)
                rounding[nodes.dofs[n][d]] += simplex.weight * modulus *
                                              size_gradient *
                                              simplex.gradient(n, point).norm();
          }
      }
    const DofVector forces = applied_nodal_forces(factors);
    for (unsigned int i = 0; i < rounding.size(); ++i)
      rounding[i] = std::numeric_limits<double>::epsilon() *
                    (rounding[i] + std::abs(forces[i]));
    return rounding;
  }



  template <int dim>
  dealii::SymmetricTensor<2, dim>
  ElasticFields<dim>::stress(const Cell        &cell,
                             const DofVector   &cartesian_displacement,
                             const LoadFactors  factors,
                             const Barycentric &point) const
  {
    return stress(cell,
                  BernsteinSimplex<dim>(cell, unknowns.degree()),
                  CellNodes<dim>(cell),
                  cartesian_displacement,
                  factors,
                  point);
  }



  template <int dim>
  dealii::SymmetricTensor<2, dim>
  ElasticFields<dim>::stress(const Cell                  &cell,
                             const BernsteinSimplex<dim> &simplex,
                             const CellNodes<dim>        &nodes,
                             const DofVector   &cartesian_displacement,
                             const LoadFactors  factors,
                             const Barycentric &point) const
  {
    dealii::SymmetricTensor<2, dim> stress =
      stiffness(cell->material_id()) *
      dealii::symmetrize(
        gradient(simplex, nodes, cartesian_displacement, point));
    if (!thermal_stresses.empty())
      stress -= factors.loads * thermal_stress(cell, point) *
                dealii::unit_symmetric_tensor<dim>();
    return stress;
  }



  template <int dim>
  dealii::SymmetricTensor<2, 3>
  ElasticFields<dim>::solid_stress(const Cell        &cell,
                                   const DofVector   &cartesian_displacement,
                                   const LoadFactors  factors,
                                   const Barycentric &point) const
  {
    return material(cell).solid_stress(
      stress(cell, cartesian_displacement, factors, point),
      factors.loads * thermal_stress(cell, point));
  }



  template <int dim>
  double
  ElasticFields<dim>::thermal_stress(const Cell        &cell,
                                     const Barycentric &point) const
  {
    if (thermal_stresses.empty())
      return 0.;
    if (unknowns.degree() == 1)
      return thermal_stresses[cell->active_cell_index()];
    // The linear function that has these values at the points.
    const double small = BernsteinSimplex<dim>::small_coordinate();
    double       sum   = 0.;
    for (unsigned int q = 0; q <= dim; ++q)
      sum += (point[q] - small) / (1. - (dim + 1) * small) *
             thermal_stresses[(dim + 1) * cell->active_cell_index() + q];
    return sum;
  }



  template <int dim>
  typename ElasticFields<dim>::Barycentric
  ElasticFields<dim>::middle()
  {
    Barycentric result;
    result.fill(1. / (dim + 1));
    return result;
  }



  template <int dim>
  dealii::Tensor<2, dim>
  ElasticFields<dim>::displacement_gradient(
    const Cell        &cell,
    const DofVector   &cartesian_displacement,
    const Barycentric &point) const
  {
    return gradient(BernsteinSimplex<dim>(cell, unknowns.degree()),
                    CellNodes<dim>(cell),
                    cartesian_displacement,
                    point);
  }



  template <int dim>
  dealii::Tensor<2, dim>
  ElasticFields<dim>::gradient(const BernsteinSimplex<dim> &simplex,
                               const CellNodes<dim>        &nodes,
                               const DofVector   &cartesian_displacement,
                               const Barycentric &point)
  {
    dealii::Tensor<2, dim> result;
    // The basis sums to one: without vertex 0 there are only differences of
    // neighbours' displacements, and a translation rounds nothing away.
    for (unsigned int n = 1; n < nodes.size; ++n)
      {
        dealii::Tensor<1, dim> difference;
        for (unsigned int d = 0; d < dim; ++d)
          difference[d] = cartesian_displacement[nodes.dofs[n][d]] -
                          cartesian_displacement[nodes.dofs[0][d]];
        result += dealii::outer_product(difference, simplex.gradient(n, point));
      }
    return result;
  }



  template <int dim>
  double
  ElasticFields<dim>::elastic_functional(const DofVector  &u,
                                         const LoadFactors factors) const
  {
    return elastic_terms(u, factors).sum();
  }



  template <int dim>
  typename ElasticFields<dim>::Terms
  ElasticFields<dim>::elastic_terms(const DofVector  &u,
                                    const LoadFactors factors) const
  {
    return terms(u, factors, unknowns.in_frames(applied_nodal_forces(factors)));
  }



  template <int dim>
  double
  ElasticFields<dim>::strain_energy(const DofVector  &u,
                                    const LoadFactors factors) const
  {
    return terms(u, factors, DofVector(u.size())).sum();
  }



  template <int dim>
  double
  ElasticFields<dim>::load_work(const DofVector  &u,
                                const LoadFactors factors) const
  {
    return unknowns.in_frames(live_forces) * lifted(u, factors);
  }



  template <int dim>
  DofVector
  ElasticFields<dim>::lifted(const DofVector  &u,
                             const LoadFactors factors) const
  {
    DofVector x = u;
    if (unknowns.has_lifting())
      x += unknowns.lifting(factors);
    return x;
  }



  template <int dim>
  typename ElasticFields<dim>::Terms
  ElasticFields<dim>::terms(const DofVector  &u,
                            const LoadFactors factors,
                            const DofVector  &load) const
  {
    const DofVector displacement = unknowns.cartesian_displacement(u, factors);
    Terms           result       = {{}, load, lifted(u, factors)};
    for (const auto &cell : unknowns.dof_handler().active_cell_iterators())
      {
        const BernsteinSimplex<dim> simplex(cell, unknowns.degree());
        const CellNodes<dim>        nodes(cell);
        for (unsigned int q = 0; q < simplex.n_points; ++q)
          {
            const dealii::SymmetricTensor<2, dim> strain = dealii::symmetrize(
              gradient(simplex, nodes, displacement, simplex.point(q)));
            result.energies.push_back(
              0.5 * simplex.weight *
              (strain * (stiffness(cell->material_id()) * strain)));
          }
      }
    return result;
  }



  template <int dim>
  double
  ElasticFields<dim>::Terms::sum() const
  {
    namespace accumulators = boost::accumulators;
    accumulators::
      accumulator_set<double, accumulators::stats<accumulators::tag::sum_kahan>>
        result;
    for (const double energy : energies)
      result(energy);
    for (unsigned int i = 0; i < displacement.size(); ++i)
      result(-load(i) * displacement(i));
    return accumulators::sum_kahan(result);
  }



  template <int dim>
  dealii::Tensor<1, dim>
  ElasticFields<dim>::total_load(const LoadFactors factors) const
  {
    const DofVector        applied_forces = applied_nodal_forces(factors);
    dealii::Tensor<1, dim> result;
    std::vector<bool>      visited(
      n_nodes(unknowns.dof_handler().get_triangulation(), unknowns.degree()),
      false);
    for (const auto &cell : unknowns.dof_handler().active_cell_iterators())
      {
        const CellNodes<dim> nodes(cell);
        for (unsigned int n = 0; n < nodes.size; ++n)
          if (!visited[nodes.indices[n]])
            {
              visited[nodes.indices[n]] = true;
              for (unsigned int d = 0; d < dim; ++d)
                result[d] += applied_forces[nodes.dofs[n][d]];
            }
      }
    return result;
  }



  template class ElasticFields<2>;
  template class ElasticFields<3>;
} // namespace Debond
