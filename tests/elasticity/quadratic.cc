// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Patch tests of linear and quadratic displacements, quadratic ones of bodies
// under loads that have one in closed form, heated ones, loads against what
// they do on quadratic functions, the operator against energies and against
// extended precision, frames at edges.

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/numerics/vector_tools_interpolate.h>

#include <debond/check/displacement_error.h>
#include <debond/mesh/crossed_mesh.h>
#include <debond/solve/minimum/extended_operator.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <memory>
#include <random>

#include "../check.h"
#include "field.h"

using namespace dealii;
using namespace Debond;

constexpr types::boundary_id left = 0, right = 1, bottom = 2;



/// An unstructured box of simplices, boundaries 0 to 2 dim - 1.
template <int dim>
void
make_mesh(Triangulation<dim> &mesh)
{
  Triangulation<dim> cells;
  Point<dim>         corner;
  for (unsigned int d = 0; d < dim; ++d)
    corner[d] = 1. + 0.5 * d;
  std::vector<unsigned int> n(dim, dim == 2 ? 3 : 2);
  GridGenerator::subdivided_hyper_rectangle(
    cells, n, Point<dim>(), corner, true);
  GridTools::distort_random(0.2, cells, true, 3);
  crossed_subdivision(cells).make_mesh(mesh);
}



template <int dim>
Material
material()
{
  Material result;
  result.young_modulus      = 2.;
  result.poisson_ratio      = 0.3;
  result.thermal_expansions = {{0.1, 0.1, 0.1}};
  return result;
}



/// (x.Q_d.x)_d with numbers of no symmetry, or linear.
template <int dim>
struct Quadratic
{
  const bool is_quadratic;

  Tensor<1, dim>
  operator()(const Point<dim> &x) const
  {
    Tensor<1, dim> value;
    for (unsigned int d = 0; d < dim; ++d)
      {
        value[d] = 0.1 * (d + 1.) + 0.2 * x[(d + 1) % dim];
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            value[d] += coefficient(d, i, j) * x[i] * x[j];
      }
    return value;
  }

  double
  coefficient(const unsigned int d,
              const unsigned int i,
              const unsigned int j) const
  {
    return !is_quadratic ? 0. :
                           0.1 + 0.07 * d - 0.05 * i + 0.03 * j + 0.11 * i * j;
  }

  /// - div sigma.
  Tensor<1, dim>
  force(const SymmetricTensor<4, dim> &C) const
  {
    Tensor<1, dim> result;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        for (unsigned int k = 0; k < dim; ++k)
          for (unsigned int l = 0; l < dim; ++l)
            result[i] -=
              C[i][j][k][l] * (coefficient(k, l, j) + coefficient(k, j, l));
    return result;
  }
};



/// The displacement prescribed on the whole boundary, with its body force.
template <int dim>
void
test_patch(const unsigned int degree, const Material &material)
{
  Triangulation<dim> mesh;
  make_mesh(mesh);
  const Quadratic<dim> u     = {degree == 2};
  const auto           exact = field<dim>(u);

  Supports<dim>               supports;
  PrescribedDisplacement<dim> all;
  all.name = "all";
  for (unsigned int b = 0; b < 2 * dim; ++b)
    all.boundaries.insert(b);
  all.components.fill(true);
  all.values             = exact;
  supports.displacements = {all};
  ElasticProblem<dim>  problem(mesh, {}, supports, degree);
  Loads<dim>           loads;
  const Tensor<1, dim> force =
    u.force(material.template elasticity_tensor<dim>());
  loads.body_force = field<dim>([force](const Point<dim> &) { return force; });
  problem.assemble(material, loads);

  const Vector<double>    w     = solve(problem);
  const DisplacementError error = displacement_error(problem, w, *exact);
  const std::string       name =
    std::to_string(dim) + "D, degree " + std::to_string(degree) + ": ";
  check(name + "displacement, energy norm", error.energy_norm, 1e-9);

  // The energies, and forces where nothing is prescribed, come from the same A.
  const auto &fields = problem.fields();
  check(name + "energy of the displacement",
        std::abs(fields.strain_energy(w) / error.exact_energy - 1.),
        1e-9);
  Vector<double> residual = fields.residual(w);
  problem.unknowns().constraints().set_zero(residual);
  check(name + "residual", residual.linfty_norm(), 1e-13);

  std::mt19937                           random(5);
  std::uniform_real_distribution<double> number(-1., 1.);
  Vector<double>                         v(w.size());
  for (double &entry : v)
    entry = number(random);
  problem.unknowns().constraints().set_zero(v);
  Vector<double> Av(v.size());
  problem.matrix().vmult(Av, v);
  problem.unknowns().constraints().set_zero(Av);
  ExtendedVector extended(v.size());
  for (unsigned int i = 0; i < v.size(); ++i)
    extended(i) = v(i);
  const ExtendedVector product = ExtendedOperator<dim>(problem) * extended;
  double               largest = 0.;
  for (unsigned int i = 0; i < v.size(); ++i)
    raise(largest, static_cast<double>(std::abs(product(i) - Av(i))));
  check(name + "A in extended precision", largest / Av.linfty_norm(), 1e-14);
  check(name + "number of unknowns",
        problem.unknowns().n_dofs() ==
          dim *
            (mesh.n_vertices() + (degree == 2 ? mesh.n_active_lines() : 0)));
}



/// A change of temperature that is linear: the body bends without stresses.
template <int dim>
void
test_heat()
{
  Triangulation<dim> mesh;
  make_mesh(mesh);
  const double                alpha = material<dim>().thermal_expansions[0];
  const auto                  exact = field<dim>([alpha](const Point<dim> &x) {
    Tensor<1, dim> u;
    u[0] = alpha * x[0] * x[0] / 2.;
    for (unsigned int d = 1; d < dim; ++d)
      {
        u[d] = alpha * x[0] * x[d];
        u[0] -= alpha * x[d] * x[d] / 2.;
      }
    return u;
  });
  Supports<dim>               supports;
  PrescribedDisplacement<dim> held;
  held.name       = "left";
  held.boundaries = {left};
  held.components.fill(true);
  held.values            = exact;
  supports.displacements = {held};
  ElasticProblem<dim> problem(mesh, {}, supports, 2);
  Loads<dim>          loads;
  loads.temperature_change = field<dim>(
    [](const Point<dim> &x) {
      Tensor<1, dim> T;
      T[0] = x[0];
      return T;
    },
    1);
  problem.assemble(material<dim>(), loads);
  const Vector<double> w    = solve(problem);
  const std::string    name = std::to_string(dim) + "D, heated: ";
  check(name + "energy norm",
        displacement_error(problem, w, *exact).energy_norm,
        1e-9);
  const Vector<double>    u = problem.unknowns().cartesian_displacement(w);
  double                  largest        = 0.;
  const auto              reference_cell = ReferenceCells::get_simplex<dim>();
  std::vector<Point<dim>> vertices;
  for (const unsigned int v : reference_cell.vertex_indices())
    vertices.push_back(reference_cell.template vertex<dim>(v));
  CellStresses<dim> stresses(problem.fields(), u, 1., vertices);
  for (const auto &cell :
       problem.unknowns().dof_handler().active_cell_iterators())
    {
      stresses.reinit(cell);
      for (unsigned int v = 0; v <= dim; ++v)
        raise(largest, stresses.stress(v).norm());
    }
  check(name + "stress at vertices", largest, 1e-12);
}



/// f.v of a quadratic v, for a linear body force and a traction that is cubic.
template <int dim>
void
test_loads()
{
  Triangulation<dim> mesh;
  make_mesh(mesh);
  BoundaryConditions conditions;
  conditions.clamped = {bottom};
  ElasticProblem<dim> problem(mesh, conditions, {}, 2);
  Loads<dim>          loads;
  loads.tractions[right] = {{field<dim>([&](const Point<dim> &x) {
    Tensor<1, dim> t;
    t[0] = std::pow(x[1], 3);
    return t;
  })}};
  loads.body_force       = field<dim>([](const Point<dim> &x) {
    Tensor<1, dim> f;
    f[1] = 1. + x[0];
    return f;
  });
  problem.assemble(material<dim>(), loads);
  const Vector<double> f = problem.fields().applied_nodal_forces();

  // v = (y^2, x y).
  Vector<double> v(f.size());
  VectorTools::interpolate(problem.unknowns().mapping(),
                           problem.unknowns().dof_handler(),
                           *field<dim>([](const Point<dim> &x) {
                             Tensor<1, dim> value;
                             value[0] = x[1] * x[1];
                             value[1] = x[0] * x[1];
                             return value;
                           }),
                           v);
  const double work = f * v;
  // On the side x = 1, of height 1.5 (and width 2): int y^5; in the body
  // int (1 + x) x y.
  const double width = dim == 2 ? 1. : 2.;
  const double exact = width * std::pow(1.5, 6) / 6. +
                       width * (1. / 2. + 1. / 3.) * 1.5 * 1.5 / 2.;
  check(std::to_string(dim) + "D: work of the loads",
        std::abs(work / exact - 1.),
        1e-12);
}



/// A turned body on an inclined foundation: u_nu is an unknown of vertices and
/// edges.
void
test_frames()
{
  const auto energy = [](const double angle) {
    Triangulation<2> mesh;
    make_mesh(mesh);
    GridTools::rotate(angle, mesh);
    BoundaryConditions conditions;
    conditions.clamped                 = {left};
    conditions.contact                 = {bottom};
    conditions.tangential_displacement = TangentialDisplacement::free;
    ElasticProblem<2> problem(mesh, conditions, {}, 2);
    Loads<2>          loads;
    loads.tractions[right] = {{field<2>([angle](const Point<2> &) {
      return Tensor<1, 2>({std::cos(angle) - std::sin(angle) * 0.3,
                           std::sin(angle) + std::cos(angle) * 0.3});
    })}};
    problem.assemble(material<2>(), loads);
    const auto  &contact = problem.unknowns().contact();
    double       normal  = 0.;
    unsigned int n_edges = 0;
    for (const auto &node : contact.boundary().nodes)
      raise(normal,
            (node.normal - Tensor<1, 2>({std::sin(angle), -std::cos(angle)}))
              .norm());
    for (const auto &face : contact.boundary().faces)
      n_edges += face.edge_nodes[0] != numbers::invalid_unsigned_int;
    double measure = 0.;
    for (const auto &node : contact.boundary().nodes)
      measure += node.measure;
    check("nodes of the foundation",
          contact.size() == 2 * n_edges && n_edges == 3);
    check("their normals", normal, 1e-14);
    // Without the third of a face that the clamped vertex has.
    check("their measures",
          std::abs(measure + contact.boundary().faces[0].measure / 3. - 1.),
          1e-12);
    return problem.fields().elastic_functional(solve(problem));
  };
  const double straight = energy(0.);
  check("a turned body", std::abs(energy(0.7) / straight - 1.), 1e-12);
}



int
main(int argc, char **)
{
  print_figures = argc > 1;
  for (const unsigned int degree : {1, 2})
    {
      Material strain   = material<2>();
      strain.hypothesis = Material::Hypothesis::plane_strain;
      test_patch<2>(degree, material<2>());
      test_patch<2>(degree, strain);
      test_patch<3>(degree, material<3>());
    }
  test_heat<2>();
  test_heat<3>();
  test_loads<2>();
  test_loads<3>();
  test_frames();
}
