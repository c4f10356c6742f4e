// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Several materials and changes of temperature against closed forms: columns of
// two layers, a body that expands freely, one that cannot expand.

#include <debond/mesh/box.h>

#include <cmath>

#include "../check.h"
#include "field.h"

using namespace dealii;
using namespace Debond;

using Hypothesis = Material::Hypothesis;

/// A field with the same components everywhere.
template <int dim>
std::shared_ptr<const Function<dim>>
constant(const std::vector<double> &components)
{
  return std::make_shared<Functions::ConstantFunction<dim>>(components);
}



template <int dim>
Vector<double>
cartesian_solution(const ElasticProblem<dim> &problem)
{
  return problem.unknowns().cartesian_displacement(solve(problem));
}



/// The largest difference of the displacement from @p exact, a function of the
/// position, relative to the size of that.
template <int dim, typename Exact>
double
error(const ElasticProblem<dim> &problem,
      const Vector<double>      &u,
      const Exact               &exact)
{
  double difference = 0., size = 0.;
  for (const auto &cell :
       problem.unknowns().dof_handler().active_cell_iterators())
    for (const unsigned int v : cell->vertex_indices())
      {
        const Tensor<1, dim> value = exact(cell->vertex(v));
        for (unsigned int d = 0; d < dim; ++d)
          {
            difference =
              std::max(difference,
                       std::abs(u(cell->vertex_dof_index(v, d)) - value[d]));
            size = std::max(size, std::abs(value[d]));
          }
      }
  return difference / size;
}



/// Columns of two layers without lateral strain (nu = 0), clamped at the
/// bottom, pulled at the top: the strain of each layer is q/E.
template <int dim>
void
test_layers()
{
  Triangulation<dim> mesh;
  make_box({{{1., 2., 1.}}, {{2, 4, 2}}, 0.}, mesh);
  for (const auto &cell : mesh.active_cell_iterators())
    cell->set_material_id(cell->center()[1] < 0.5 ? 3 : 0);

  constexpr double   E = 2., E_3 = 7., q = 0.3;
  ByRegion<Material> materials(Material{E, 0., Hypothesis::plane_strain});
  materials.set(3, Material{E_3, 0., Hypothesis::plane_strain});
  ElasticProblem<dim> problem(mesh,
                              {{box_sides<dim>().at("bottom")}, {}, true});
  Loads<dim>          loads;
  loads.tractions[box_sides<dim>().at("top")] = {{constant<dim>(
    dim == 2 ? std::vector<double>{0., q} : std::vector<double>{0., q, 0.})}};
  problem.assemble(materials, loads);
  const Vector<double> u     = cartesian_solution(problem);
  const auto           exact = [&](const Point<dim> &p) {
    Tensor<1, dim> value;
    value[1] = q * (std::min(p[1], 0.5) / E_3 + std::max(0., p[1] - 0.5) / E);
    return value;
  };
  std::cout << dim << "D" << std::endl;
  check("a column of two layers", error(problem, u, exact), 1e-13);

  double            stress_error = 0.;
  CellStresses<dim> stresses(problem.fields(), u);
  for (const auto &cell :
       problem.unknowns().dof_handler().active_cell_iterators())
    {
      stresses.reinit(cell);
      stress_error =
        std::max(stress_error, std::abs(stresses.stress(0)[1][1] / q - 1.));
    }
  check("the stress is the same in both", stress_error, 1e-12);

  check("energy of the layers",
        std::abs(problem.fields().elastic_functional(
                   problem.unknowns().from_cartesian(u)) /
                   (-0.5 * q * q * (0.5 / E_3 + 1.5 / E)) -
                 1.),
        1e-12);
}



/// @p alpha: the strain in the plane of a change of one that a free body of the
/// hypothesis has.
template <int dim>
void
test_temperature(const Material &material, const double alpha)
{
  constexpr double   change = 40.;
  const auto        &sides  = box_sides<dim>();
  Triangulation<dim> mesh;
  make_box({{{1., 2., 1.}}, {{2, 3, 2}}, 0.}, mesh);
  Loads<dim> loads;
  loads.temperature_change = constant<dim>({change});

  // The field alpha change x, whatever the clamps say.
  ElasticProblem<dim> free(mesh, {{sides.at("left")}, {}, true});
  free.assemble(material, loads);
  Vector<double> expanded(free.load().size());
  for (const auto &cell : free.unknowns().dof_handler().active_cell_iterators())
    for (const unsigned int v : cell->vertex_indices())
      for (unsigned int d = 0; d < dim; ++d)
        expanded(cell->vertex_dof_index(v, d)) =
          alpha * change * cell->vertex(v)[d];
  double            stress = 0., out_of_plane = 0.;
  CellStresses<dim> stresses(free.fields(), expanded);
  for (const auto &cell : free.unknowns().dof_handler().active_cell_iterators())
    {
      stresses.reinit(cell);
      stress       = std::max(stress, stresses.stress(0).norm());
      out_of_plane = stresses.solid_stress(0)[2][2];
    }
  const double scale =
    material.young_modulus * material.thermal_expansion * change;
  check("no stress in a body that expands freely", stress / scale, 1e-13);
  // In plane strain the body cannot expand out of the plane.
  const bool plane_strain =
    dim == 2 && material.hypothesis == Hypothesis::plane_strain;
  check("out of the plane",
        std::abs(out_of_plane / scale + (plane_strain ? 1. : 0.)),
        1e-12);

  // Clamped on all sides nothing moves, and the stress is that of constrained
  // expansion; the clamps bear it.
  std::set<types::boundary_id> all;
  for (const auto &[unused, id] : sides)
    all.insert(id);
  ElasticProblem<dim> held(mesh, {all, {}, true});
  held.assemble(material, loads);
  const Vector<double> u  = cartesian_solution(held);
  const double         nu = material.poisson_ratio;
  const double         pressure =
    scale / (dim == 2 && material.hypothesis == Hypothesis::plane_stress ?
               1. - nu :
               1. - 2. * nu);
  check("a body that cannot expand does not move",
        u.linfty_norm() / (material.thermal_expansion * change),
        1e-13);
  double            difference = 0.;
  CellStresses<dim> held_stresses(held.fields(), u);
  for (const auto &cell : held.unknowns().dof_handler().active_cell_iterators())
    {
      held_stresses.reinit(cell);
      difference = std::max(difference,
                            (held_stresses.stress(0) +
                             pressure * unit_symmetric_tensor<dim>())
                              .norm());
    }
  check("its stress", difference / pressure, 1e-12);
  double         force    = 0.;
  Vector<double> residual = held.fields().residual(Vector<double>(u.size()));
  for (const auto &cell : held.unknowns().dof_handler().active_cell_iterators())
    for (const unsigned int v : cell->vertex_indices())
      if (cell->vertex(v)[0] < 1e-12)
        {
          force += residual(cell->vertex_dof_index(v, 0));
          residual(cell->vertex_dof_index(v, 0)) = 0.; // each vertex once
        }
  check("the force of the left side",
        std::abs(force / (2. * pressure) - 1.),
        1e-12);
  check("no resultant", total_load(held).norm() / pressure, 1e-13);
}



int
main(int argc, char **)
{
  print_figures = argc > 1;
  test_layers<2>();
  test_layers<3>();

  constexpr double E = 70., nu = 0.3, alpha = 2e-5;
  std::cout << "Plane stress" << std::endl;
  test_temperature<2>({E, nu, Hypothesis::plane_stress, alpha}, alpha);
  std::cout << "Plane strain" << std::endl;
  test_temperature<2>({E, nu, Hypothesis::plane_strain, alpha},
                      (1. + nu) * alpha);
  std::cout << "3D" << std::endl;
  test_temperature<3>({E, nu, Hypothesis::plane_strain, alpha}, alpha);
}
