// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The crossed subdivision: counts, measures and ids. The material's tensor
// against closed forms.

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <debond/elasticity/elastic_problem.h>
#include <debond/mesh/box.h>
#include <debond/mesh/crossed_mesh.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <set>
#include <stdexcept>

#include "../check.h"

using namespace dealii;
using namespace Debond;

template <int dim>
void
test_box(const BoxParameters &box)
{
  Triangulation<dim> mesh;
  make_box(box, mesh);

  std::map<types::boundary_id, unsigned int> counts;
  std::map<types::boundary_id, double>       measures;
  double                                     volume = 0.;
  for (const auto &cell : mesh.active_cell_iterators())
    {
      volume += cell->measure();
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary())
          {
            ++counts[face->boundary_id()];
            measures[face->boundary_id()] += face->measure();
          }
    }

  std::cout << mesh.n_active_cells() << " cells, " << mesh.n_used_vertices()
            << " vertices" << std::endl;
  double expected_volume = 1.;
  for (unsigned int d = 0; d < dim; ++d)
    expected_volume *= box.lengths[d];
  check("volume", std::abs(volume / expected_volume - 1.), 1e-13);

  for (const auto &[name, id] : box_sides<dim>())
    {
      // The side normal to direction id / 2.
      std::cout << name << ": " << counts[id] << " faces" << std::endl;
      check("measure",
            std::abs(measures[id] * box.lengths[id / 2] / expected_volume - 1.),
            1e-13);
    }
}



// An L-shaped mesh (2D), two cubes (3D), with ids set by hand.
template <int dim>
void
test_ids()
{
  Triangulation<dim> coarse;
  if constexpr (dim == 2)
    GridGenerator::hyper_L(coarse);
  else
    GridGenerator::subdivided_hyper_rectangle(coarse,
                                              {2, 1, 1},
                                              Point<3>(),
                                              Point<3>(2., 1., 1.));

  // Ids that can be recomputed from the place.
  unsigned int n = 0;
  for (const auto &cell : coarse.active_cell_iterators())
    {
      cell->set_material_id(10 + n);
      cell->set_manifold_id(20 + n);
      ++n;
    }
  n = 0;
  std::vector<std::tuple<Point<dim>, types::boundary_id, types::manifold_id>>
    sides;
  for (const auto &cell : coarse.active_cell_iterators())
    for (const auto &face : cell->face_iterators())
      if (face->at_boundary())
        {
          face->set_boundary_id(30 + n);
          face->set_manifold_id(50 + n);
          sides.emplace_back(face->center(), 30 + n, 50 + n);
          ++n;
        }
  // An inner face with a manifold.
  for (const auto &cell : coarse.active_cell_iterators())
    for (const auto &face : cell->face_iterators())
      if (!face->at_boundary())
        face->set_manifold_id(99);

  Triangulation<dim> crossed;
  crossed_subdivision(coarse, crossed);

  unsigned int wrong = 0, cells = 0, boundary_faces = 0, inner = 0;
  for (const auto &cell : crossed.active_cell_iterators())
    {
      const auto parent =
        GridTools::find_active_cell_around_point(coarse, cell->center());
      wrong += cell->material_id() != parent->material_id();
      wrong += cell->manifold_id() != parent->manifold_id();
      ++cells;
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary())
          {
            ++boundary_faces;
            // The coarse face nearest to a fine one contains it.
            double             best     = 1e300;
            types::boundary_id id       = 0;
            types::manifold_id manifold = 0;
            for (const auto &side : sides)
              if (face->center().distance(std::get<0>(side)) < best)
                {
                  best     = face->center().distance(std::get<0>(side));
                  id       = std::get<1>(side);
                  manifold = std::get<2>(side);
                }
            wrong += face->boundary_id() != id;
            wrong += face->manifold_id() != manifold;
          }
        else
          inner += face->manifold_id() == 99;
    }
  std::cout << cells << " cells, " << boundary_faces << " boundary faces, "
            << inner / 2 << " inner faces with a manifold" << std::endl;
  check("ids", wrong == 0);
}



template <int dim>
void
test_stress(const Material &material, const std::string &name)
{
  const double E = material.young_modulus, nu = material.poisson_ratio;

  SymmetricTensor<2, dim> strain;
  for (unsigned int i = 0; i < dim; ++i)
    for (unsigned int j = i; j < dim; ++j)
      strain[i][j] = 0.3 + 0.7 * i - 0.4 * j * j;

  // Hooke's law the other way round, from stress to strain: with the
  // out-of-plane stress and strain of the hypothesis.
  const SymmetricTensor<2, dim> stress =
    material.elasticity_tensor<dim>() * strain;
  SymmetricTensor<2, 3> s;
  for (unsigned int i = 0; i < dim; ++i)
    for (unsigned int j = i; j < dim; ++j)
      s[i][j] = stress[i][j];
  if (dim == 2 && material.hypothesis == Material::Hypothesis::plane_strain)
    s[2][2] = nu * (s[0][0] + s[1][1]);

  double error = 0.;
  for (unsigned int i = 0; i < dim; ++i)
    for (unsigned int j = i; j < dim; ++j)
      raise(error,
            std::abs((1. + nu) / E * s[i][j] -
                     (i == j ? nu / E * trace(s) : 0.) - strain[i][j]));
  check(name + ", Hooke's law", error, 1e-13);

  const double von_mises = std::sqrt(
    0.5 * (std::pow(s[0][0] - s[1][1], 2) + std::pow(s[1][1] - s[2][2], 2) +
           std::pow(s[2][2] - s[0][0], 2)) +
    3. * (std::pow(s[0][1], 2) + std::pow(s[1][2], 2) + std::pow(s[0][2], 2)));
  check(name + ", von Mises",
        std::abs(Debond::von_mises(material.solid_stress(stress)) / von_mises -
                 1.),
        1e-13);
}



int
main()
{
  section("Boxes");
  test_box<2>({{{0.4, 0.04, 1.}}, {{40, 4, 1}}, 0.});
  test_box<3>({{{0.4, 0.04, 0.05}}, {{5, 2, 3}}, 0.});
  test_box<2>({{{0.4, 0.04, 1.}}, {{3, 2, 1}}, 30.});
  test_box<3>({{{0.4, 0.04, 0.05}}, {{3, 2, 1}}, 30.});

  {
    Triangulation<2> turned;
    make_box<2>({{{3., 1., 1.}}, {{1, 1, 1}}, 30.}, turned);
    double far = 0.;
    for (const auto &vertex : turned.get_vertices())
      raise(far, vertex * Point<2>(std::sqrt(0.75), 0.5));
    check("turned counterclockwise", std::abs(far - 3.), 1e-13);
  }

  section("Ids");
  test_ids<2>();
  test_ids<3>();

  section("Meshes that cannot be crossed");
  print_error([] {
    Triangulation<2> coarse, crossed;
    GridGenerator::subdivided_hyper_cube(coarse, 2);
    coarse.begin_active()->set_refine_flag();
    coarse.execute_coarsening_and_refinement();
    crossed_subdivision(coarse, crossed);
  });
  print_error([] {
    Triangulation<3> coarse, crossed, twice;
    GridGenerator::hyper_cube(coarse);
    crossed_subdivision(coarse, crossed);
    crossed_subdivision(crossed, twice);
  });
  print_error([] {
    Triangulation<2> coarse, crossed;
    GridGenerator::hyper_cube(coarse);
    crossed_subdivision(coarse, crossed);
    crossed_subdivision(coarse, crossed);
  });
  print_error([] {
    // A dart: the mean of the corners is outside.
    Triangulation<2> coarse, crossed;
    CellData<2>      dart;
    dart.vertices = {0, 1, 2, 3};
    coarse.create_triangulation({{0., 0.}, {4., 0.2}, {0.2, 4.}, {0.25, 0.25}},
                                {dart},
                                SubCellData());
    crossed_subdivision(coarse, crossed);
  });
  print_error([] {
    Triangulation<2> mesh;
    make_box<2>({{{1., 1., 1.}}, {{2, 0, 1}}, 0.}, mesh);
  });
  print_error([] {
    Triangulation<3> mesh;
    make_box<3>({{{1., 1., -1.}}, {{2, 1, 1}}, 0.}, mesh);
  });

  section("Material");
  const Material plane_stress{2.3, 0.33, Material::Hypothesis::plane_stress};
  const Material plane_strain{2.3, 0.33, Material::Hypothesis::plane_strain};
  test_stress<2>(plane_stress, "plane stress");
  test_stress<2>(plane_strain, "plane strain");
  test_stress<3>(plane_stress, "3D");

  // Plane strain is plane stress with E / (1 - nu^2), nu / (1 - nu).
  const Material equivalent{2.3 / (1. - 0.33 * 0.33),
                            0.33 / (1. - 0.33),
                            Material::Hypothesis::plane_stress};
  check("plane strain by plane stress",
        (equivalent.elasticity_tensor<2>() -
         plane_strain.elasticity_tensor<2>())
          .norm(),
        1e-13);

  print_error([] { Material{-1., 0.3}.validate<2>(); });
  print_error([] { Material{1., 1.}.validate<2>(); });
  print_error([] {
    Material{1., 0.5, Material::Hypothesis::plane_strain}.validate<2>();
  });
  print_error([] { Material{1., -1.}.validate<3>(); });
  print_error([] { Material{std::nan(""), 0.3}.validate<3>(); });
  print_error([] { Material{1., 0.7}.validate<2>(); });
}
