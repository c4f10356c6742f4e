// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The paper's numbers of unknowns, the energy of its benchmark without contact,
// the frames of the contact nodes, rigid motions and the errors in the input.

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <debond/elasticity/contact_frame.h>
#include <debond/mesh/box.h>
#include <debond/mesh/crossed_mesh.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <stdexcept>

#include "../check.h"
#include "field.h"

using namespace dealii;
using namespace Debond;

constexpr types::boundary_id left = 0, right = 1, bottom = 2, top = 3;

/// The paper's tractions on the top.
Loads<2>
paper_loads()
{
  Loads<2> loads;
  loads.tractions[top] = {{field<2>([](const Point<2> &p) {
    return Tensor<1, 2>({0., p[0] < 0.2 ? 0.69 : -0.345});
  })}};
  return loads;
}

BoundaryConditions
paper_conditions()
{
  return {{left, right}, {bottom}, true};
}



void
test_benchmark()
{
  const auto box = [](const unsigned int n) {
    return BoxParameters{{{0.4, 0.04, 1.}}, {{10 * n, n, 1}}, 0.};
  };

  for (const unsigned int n : {4, 8, 16})
    {
      Triangulation<2> mesh;
      make_box(box(n), mesh);
      const ElasticProblem<2> problem(mesh, paper_conditions());
      const unsigned int      n_free = problem.unknowns().n_free_dofs();
      std::cout << 10 * n << "x" << n << ": "
                << n_free + problem.unknowns().contact().size()
                << " degrees of freedom as the paper counts, " << n_free
                << " free, " << problem.unknowns().contact().size()
                << " contact nodes" << std::endl;
    }

  // External work without contact and adhesion, from an independent code.
  const auto work = [&](const unsigned int n) {
    Triangulation<2> mesh;
    make_box(box(n), mesh);
    ElasticProblem<2> problem(mesh, paper_conditions());
    problem.assemble(Material(), paper_loads());
    return solve(problem) * problem.load();
  };
  check("external work 40x4",
        std::abs(work(4) / (2. * 6.2397134244e-04) - 1.),
        1e-9);
  check("external work 80x8", std::abs(work(8) / 0.001267525943 - 1.), 1e-9);
}



void
test_frames()
{
  // A sheared bar, so that the normals at its corners are not orthogonal.
  for (const bool fixed : {true, false})
    {
      Triangulation<2> mesh;
      make_box<2>({{{1., 0.5, 1.}}, {{4, 2, 1}}, 0.}, mesh);
      GridTools::transform(
        [](const Point<2> &p) {
          return Point<2>(p[0] + 0.3 * p[1], p[1] - 0.1 * p[0]);
        },
        mesh);
      ElasticProblem<2> problem(mesh, {{right}, {left, bottom}, fixed});
      // 2 nodes inside of the left side and its top end, 3 inside of the
      // bottom; the corner has two nodes if it is free, else none.
      std::cout << problem.unknowns().contact().boundary().nodes.size()
                << " contact nodes" << std::endl;
    }
  for (const bool fixed : {true, false})
    {
      Triangulation<3> mesh;
      make_box<3>({{{1., 0.5, 0.5}}, {{2, 1, 1}}, 20.}, mesh);
      ElasticProblem<3> problem(mesh, {{right}, {left, bottom, 4}, fixed});
      // The left side has one vertex and the centre to itself, the bottom and
      // the back one vertex and two centres each: 8. If they are free, there
      // are three edge vertices with 2 nodes each and a corner with 3 as well.
      std::cout << problem.unknowns().contact().boundary().nodes.size()
                << " contact nodes" << std::endl;
    }

  // A polygon for a disc: the mean normals are radial.
  {
    Triangulation<2> coarse, mesh;
    GridGenerator::hyper_ball(coarse);
    coarse.refine_global(2);
    crossed_subdivision(coarse, mesh);
    ElasticProblem<2> problem(mesh, {{}, {0}, true});
    double            error = 0., perimeter = 0., length = 0.;
    for (const auto &node : problem.unknowns().contact().boundary().nodes)
      {
        error = std::max(error, (node.normal - node.position).norm());
        length += node.measure;
      }
    for (const auto &face : problem.unknowns().contact().boundary().faces)
      perimeter += face.measure;
    std::cout << "disc, "
              << problem.unknowns().contact().boundary().nodes.size()
              << " contact nodes" << std::endl;
    check("radial normals", error, 1e-13);
    check("perimeter of the 16-gon",
          std::abs(perimeter / (32. * std::sin(numbers::PI / 16.)) - 1.),
          1e-13);
    check("measure of the nodes", std::abs(length / perimeter - 1.), 1e-13);
  }

  // Sides along the axes have exact normals, and the nodes are in order, even
  // if the coordinates have rounding errors.
  {
    Triangulation<3> mesh;
    make_box<3>({{{0.4, 0.04, 0.04}}, {{7, 1, 3}}, 0.}, mesh);
    GridTools::transform(
      [](const Point<3> &p) {
        return p + Point<3>(-4e-15 * p[2], 2e-15 * p[0], 0.);
      },
      mesh);
    const ElasticProblem<3> problem(mesh, paper_conditions());
    const auto &nodes  = problem.unknowns().contact().boundary().nodes;
    bool        exact  = true;
    bool        sorted = true;
    for (unsigned int k = 0; k < nodes.size(); ++k)
      {
        exact = exact && nodes[k].normal == Tensor<1, 3>({0., -1., 0.});
        if (k > 0)
          {
            const Point<3> a = nodes[k - 1].position, b = nodes[k].position;
            sorted =
              sorted && (a[0] < b[0] - 1e-8 ||
                         (std::abs(a[0] - b[0]) < 1e-8 && a[2] < b[2] - 1e-8));
          }
      }
    // (8 - 2) x 4 corners of the grid and 7 x 3 centres.
    std::cout << nodes.size()
              << " contact nodes, exact normals: " << verdict(exact)
              << ", in order: " << verdict(sorted) << std::endl;
  }
}



template <int dim>
void
print_free_motions(const FreeRigidMotions<dim> &motions)
{
  for (const std::string &motion : motions.names)
    std::cout << motion << "; ";
  std::cout << motions.names.size() << " names" << std::endl;
}



/// The motions that only the contact boundary holds: A resists none of them.
template <int dim>
void
test_held_by_contact(const Triangulation<dim> &mesh,
                     const BoundaryConditions &conditions)
{
  ElasticProblem<dim> problem(mesh, conditions);
  problem.assemble(Material(), {});
  const auto &unknowns = problem.unknowns();
  print_free_motions(unknowns.held_by_contact());
  double largest = 0.;
  for (const auto &motion : unknowns.held_by_contact().motions)
    {
      Vector<double> u(unknowns.n_dofs()), forces(unknowns.n_dofs());
      for (const auto &cell : unknowns.dof_handler().active_cell_iterators())
        for (const unsigned int v : cell->vertex_indices())
          for (unsigned int d = 0; d < dim; ++d)
            u(cell->vertex_dof_index(v, d)) = motion(cell->vertex(v))[d];
      u = unknowns.from_cartesian(u);
      problem.matrix().vmult(forces, u);
      largest = std::max(largest,
                         forces.linfty_norm() /
                           (problem.matrix().l1_norm() * u.linfty_norm()));
    }
  check("without forces", largest, 1e-14);
}

void
test_rigid_motions()
{
  // A disc held in radial direction at three points can turn.
  std::vector<Support<2>> radial;
  for (const double angle : {0.3, 2.1, 4.5})
    {
      const Point<2> p(std::cos(angle), std::sin(angle));
      radial.push_back({Point<2>(1., 5.) + p, p});
    }
  print_free_motions(free_rigid_motions(radial, 2.));
  // A fourth support, in circumferential direction, holds it.
  radial.push_back({Point<2>(2., 5.), Point<2>(0., 1.)});
  print_free_motions(free_rigid_motions(radial, 2.));

  // Bodies clamped along a line turn about it: the y-axis, and a diagonal.
  std::vector<Support<3>> axis, diagonal;
  for (unsigned int d = 0; d < 3; ++d)
    for (const double s : {0., 1., 3.})
      {
        axis.push_back({Point<3>(2., s, 1.), Point<3>::unit_vector(d)});
        diagonal.push_back({Point<3>(s, 1., s), Point<3>::unit_vector(d)});
      }
  print_free_motions(free_rigid_motions(axis, 3.));
  print_free_motions(free_rigid_motions(diagonal, 3.));

  Triangulation<2> mesh;
  make_box<2>({{{0.4, 0.04, 1.}}, {{10, 1, 1}}, 0.}, mesh);
  Triangulation<3> body;
  make_box<3>({{{0.4, 0.04, 0.04}}, {{10, 1, 1}}, 0.}, body);
  test_held_by_contact<2>(mesh, {{}, {bottom}, true});
  test_held_by_contact<2>(mesh, {{}, {left}, true});
  test_held_by_contact<3>(body, {{}, {bottom}, true});
}



void
test_errors()
{
  Triangulation<2> mesh;
  make_box<2>({{{0.4, 0.04, 1.}}, {{10, 1, 1}}, 0.}, mesh);
  Triangulation<3> body;
  make_box<3>({{{0.4, 0.04, 0.04}}, {{10, 1, 1}}, 0.}, body);

  print_error([&] { ElasticProblem<2>(mesh, {{}, {}, true}); });
  print_error([&] { ElasticProblem<2>(mesh, {{}, {bottom}, false}); });
  print_error([&] { ElasticProblem<3>(body, {{}, {}, true}); });
  print_error([&] { ElasticProblem<2>(mesh, {{left}, {bottom}, false}); });
  print_error([&] {
    ElasticProblem<2>(mesh,
                      {{left, bottom}, {bottom}, true, box_boundaries<2>()});
  });
  print_error([&] { ElasticProblem<2>(mesh, {{left, 7}, {}, true}); });
  print_error([] {
    Triangulation<2> quadrilaterals;
    GridGenerator::hyper_cube(quadrilaterals);
    ElasticProblem<2>(quadrilaterals, {{0}, {}, true});
  });
  print_error([] {
    contact_frame<2>({Tensor<1, 2>({0., 1.}), Tensor<1, 2>({0., -1.})});
  });

  ElasticProblem<2> problem(mesh, paper_conditions());
  const auto        assemble = [&](const types::boundary_id    side,
                            const Field<2>::Expression &traction) {
    Loads<2> loads        = {};
    loads.tractions[side] = {{field<2>(traction)}};
    problem.assemble(Material(), loads);
  };
  print_error([&] {
    assemble(right, [](const Point<2> &) {
      return Tensor<1, 2>({0., std::numeric_limits<double>::infinity()});
    });
  });
  print_error([&] {
    assemble(top, [](const Point<2> &) -> Tensor<1, 2> {
      throw std::runtime_error("no value");
    });
  });
  print_error([&] { problem.assemble(Material{69., 1.2}, {}); });
}



int
main()
{
  std::cout << "Benchmark" << std::endl;
  test_benchmark();
  std::cout << "Frames" << std::endl;
  test_frames();
  std::cout << "Rigid motions" << std::endl;
  test_rigid_motions();
  std::cout << "Errors" << std::endl;
  test_errors();
}
