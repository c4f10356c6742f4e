// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Loads: polynomials are integrated exactly, jumps that follow the mesh too,
// and what jumps inside of a face has a note with the face; a ring under
// pressure after Lame.

#include <deal.II/grid/grid_generator.h>

#include <debond/check/displacement_error.h>
#include <debond/mesh/box.h>
#include <debond/mesh/crossed_mesh.h>

#include <cmath>
#include <functional>
#include <iostream>

#include "../check.h"
#include "field.h"

using namespace dealii;
using namespace Debond;

constexpr types::boundary_id left = 0, right = 1, top = 3;



/// The work of the loads on a displacement field, which must be linear.
template <int dim>
double
work(const DoFHandler<dim>                 &dof_handler,
     const Loads<dim>                      &loads,
     const typename Field<dim>::Expression &displacement)
{
  Vector<double> u(dof_handler.n_dofs());
  for (const auto &cell : dof_handler.active_cell_iterators())
    for (const unsigned int v : cell->vertex_indices())
      for (unsigned int d = 0; d < dim; ++d)
        u[cell->vertex_dof_index(v, d)] = displacement(cell->vertex(v))[d];
  return u * load_vector(dof_handler, loads);
}



template <int dim>
struct Bar
{
  explicit Bar(const std::array<unsigned int, 3> &cells)
  {
    make_box<dim>({{{0.4, 0.04, dim == 2 ? 1. : 0.04}}, cells, 0.}, mesh);
    problem = std::make_unique<ElasticProblem<dim>>(
      mesh, BoundaryConditions{{left, right}, {}, true});
  }

  /// The force of a traction along y on the top.
  double
  on_top(const std::function<double(const Point<dim> &)> &traction)
  {
    Loads<dim> loads;
    loads.tractions[top] = {{field<dim>([&](const Point<dim> &p) {
      Tensor<1, dim> t;
      t[1] = traction(p);
      return t;
    })}};
    problem->assemble(Material(), loads);
    return total_load(*problem)[1];
  }

  double
  in_body(const std::function<double(const Point<dim> &)> &force)
  {
    Loads<dim> loads;
    loads.body_force = field<dim>([&](const Point<dim> &p) {
      Tensor<1, dim> f;
      f[0] = force(p);
      return f;
    });
    problem->assemble(Material(), loads);
    return total_load(*problem)[0];
  }

  /// Whether there is one note with all these words.
  bool
  has_note(const std::vector<std::string> &words) const
  {
    const auto &notes = problem->load_notes();
    if (notes.size() != 1)
      return false;
    for (const std::string &word : words)
      if (notes[0].find(word) == std::string::npos)
        return false;
    return true;
  }

  Triangulation<dim>                   mesh;
  std::unique_ptr<ElasticProblem<dim>> problem;
};



void
test_plane()
{
  Bar<2>   bar(std::array<unsigned int, 3>{{40, 4, 1}});
  Loads<2> loads;
  loads.tractions[top] = {{field<2>([](const Point<2> &p) {
    return Tensor<1, 2>({0., p[0] < 0.2 ? 0.69 : -0.345});
  })}};
  check("jump at a vertex, moment",
        std::abs(work<2>(bar.problem->unknowns().dof_handler(),
                         loads,
                         [](const Point<2> &p) {
                           return Tensor<1, 2>({0., p[0]});
                         }) /
                   (0.69 * 0.02 - 0.345 * 0.06) -
                 1.),
        1e-12);
  check("its resultant",
        std::abs(bar.on_top([](const Point<2> &p) {
          return p[0] < 0.2 ? 0.69 : -0.345;
        }) / 0.069 -
                 1.),
        1e-12);
  check("no note", bar.problem->load_notes().empty());
  check("sin(30 x)",
        std::abs(bar.on_top([](const Point<2> &p) {
          return std::sin(30. * p[0]);
        }) / ((1. - std::cos(12.)) / 30.) -
                 1.),
        1e-12);
  check("no note", bar.problem->load_notes().empty());

  // All points of the side are on the same side of a jump.
  check("a jump at the side's own y",
        std::abs(bar.on_top([](const Point<2> &p) {
          return p[1] < 0.04 ? 1. : 2.;
        }) / 0.8 -
                 1.),
        1e-12);

  // An eighth of a face times what one of four points may miss.
  const double force =
    bar.on_top([](const Point<2> &p) { return p[0] < 0.12345 ? 6.9e8 : 0.; });
  check("jump inside of a face",
        std::abs(force / (6.9e8 * 0.12345) - 1.),
        0.5 * 0.01 / 8. / 0.12345);
  check("its note", bar.has_note({"not smooth", "(0.125, 0.04)"}));
  bar.on_top([](const Point<2> &p) { return std::abs(p[0] - 0.2033); });
  check("a kink has no note, or that it is not smooth",
        bar.problem->load_notes().empty() || bar.has_note({"not smooth"}));
  bar.on_top(
    [](const Point<2> &p) { return 0.001 / std::pow(p[0] - 0.2033, 2); });
  check("a pole's note", bar.has_note({"not smooth", "(0.205, 0.04)"}));

  check("a body force that jumps",
        std::abs(bar.in_body([](const Point<2> &p) {
          return p[0] < 0.2 ? 1e6 : 1.;
        }) / ((1e6 + 1.) * 0.2 * 0.04) -
                 1.),
        1e-12);
  Loads<2> weight;
  weight.body_force = field<2>([](const Point<2> &p) {
    return Tensor<1, 2>({p[0], -3.});
  });
  check("a linear body force",
        std::abs(work<2>(bar.problem->unknowns().dof_handler(),
                         weight,
                         [](const Point<2> &p) {
                           return Tensor<1, 2>({p[0], 1.});
                         }) /
                   (0.04 * 0.4 * 0.4 * 0.4 / 3. - 3. * 0.4 * 0.04) -
                 1.),
        1e-13);
}



void
test_solid()
{
  Bar<3> bar(std::array<unsigned int, 3>{{7, 1, 3}});
  check("x^2 z^2 in 3D",
        std::abs(bar.on_top([](const Point<3> &p) {
          return std::pow(p[0] * p[2], 2);
        }) / (std::pow(0.4 * 0.04, 3) / 9.) -
                 1.),
        1e-12);
  // The line x + 0.7 z = 0.2 runs across the faces of the top.
  const double loaded = 0.04 * (0.2 - 0.7 * 0.02);
  const double force  = bar.on_top(
    [](const Point<3> &p) { return p[0] + 0.7 * p[2] < 0.2 ? 1. : 0.; });
  check("a jump across faces", std::abs(force / loaded - 1.), 0.01);
  check("its note", bar.has_note({"not smooth"}));
  check("1/r in the body in 3D",
        bar.in_body([](const Point<3> &p) { return 1. / p.norm(); }) > 0.);
}



/// The ring between a = 1 and b = 2, of which a quarter is modelled, under the
/// pressure p inside, in plane strain:
/// u_r = (1 + nu) / E a^2 p / (b^2 - a^2) ((1 - 2 nu) r + b^2 / r).
double
error_of_ring(const unsigned int refinements)
{
  Triangulation<2> quadrilaterals, mesh;
  GridGenerator::quarter_hyper_shell(
    quadrilaterals, Point<2>(), 1., 2., 2, true);
  quadrilaterals.refine_global(refinements);
  crossed_subdivision(quadrilaterals, mesh);

  Supports<2> supports;
  for (const types::boundary_id id : {2, 3})
    {
      PrescribedDisplacement<2> roller;
      roller.name       = std::to_string(id);
      roller.boundaries = {id};
      roller.is_roller  = true;
      supports.displacements.push_back(roller);
    }
  Material material;
  material.young_modulus = 2.;
  material.poisson_ratio = 0.3;
  material.hypothesis    = Material::Hypothesis::plane_strain;
  const double p         = 0.1;
  Loads<2>     loads;
  loads.tractions[0] = {{std::make_shared<Functions::ConstantFunction<2>>(p)}};
  ElasticProblem<2> problem(mesh, {}, supports);
  problem.assemble(material, loads);
  // Whatever the polygon, the pressure's force is that on its projection.
  check("force of the pressure",
        (total_load(problem) - Tensor<1, 2>({p, p})).norm() / p,
        1e-12);
  return displacement_error(problem,
                            solve(problem),
                            *field<2>([p](const Point<2> &x) {
                              const double r = x.norm();
                              return 1.3 / 2. * p / 3. * (0.4 * r + 4. / r) /
                                     r * Tensor<1, 2>(x);
                            }))
    .l2;
}



int
main(int argc, char **)
{
  print_figures = argc > 1;
  test_plane();
  test_solid();
  const double coarse = error_of_ring(3), fine = error_of_ring(4);
  check("ring under pressure after Lame", fine, 5e-3);
  check("of second order", coarse / fine > 3.5 && coarse / fine < 4.5);
}
