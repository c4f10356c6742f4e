// SPDX-License-Identifier: LGPL-2.1-or-later
// The same body with vertices, cells and the corners within each cell in
// another order: the same minimum, and the same displacement at each point.

#include <deal.II/base/function_parser.h>

#include <debond/contact/adhesion_integral.h>
#include <debond/contact/laws/winkler.h>
#include <debond/elasticity/elastic_problem.h>
#include <debond/linear_algebra/condensation.h>
#include <debond/mesh/box.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/optimization/majorise/majorise_minimise.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <numeric>
#include <random>

#include "../check.h"

using namespace Debond;

namespace
{
  template <int dim>
  void
  shuffle(const dealii::Triangulation<dim> &mesh,
          std::mt19937                     &random,
          dealii::Triangulation<dim>       &shuffled)
  {
    std::vector<unsigned int> place(mesh.n_vertices());
    std::iota(place.begin(), place.end(), 0u);
    std::shuffle(place.begin(), place.end(), random);
    std::vector<dealii::Point<dim>> vertices(mesh.n_vertices());
    for (unsigned int i = 0; i < vertices.size(); ++i)
      vertices[place[i]] = mesh.get_vertices()[i];

    std::vector<dealii::CellData<dim>> cells;
    dealii::SubCellData                sides;
    for (const auto &cell : mesh.active_cell_iterators())
      {
        cells.emplace_back(dim + 1);
        for (unsigned int v = 0; v <= dim; ++v)
          cells.back().vertices[v] = place[cell->vertex_index(v)];
        // Keeps the orientation.
        std::rotate(cells.back().vertices.begin(),
                    cells.back().vertices.begin() + random() % 3,
                    cells.back().vertices.begin() + 3);
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary())
            {
              const auto add = [&](auto &faces) {
                faces.emplace_back(dim);
                for (unsigned int v = 0; v < dim; ++v)
                  faces.back().vertices[v] = place[face->vertex_index(v)];
                faces.back().boundary_id = face->boundary_id();
              };
              if constexpr (dim == 2)
                add(sides.boundary_lines);
              else
                add(sides.boundary_quads);
            }
      }
    std::shuffle(cells.begin(), cells.end(), random);
    shuffled.create_triangulation(vertices, cells, sides);
  }



  struct Minimum
  {
    double          value;
    Eigen::VectorXd s; ///< in the order of the contact nodes' positions
  };



  template <int dim>
  Minimum
  minimise(const dealii::Triangulation<dim> &mesh,
           const std::string                &traction,
           const AdhesiveLaw                &law)
  {
    BoundaryConditions conditions;
    conditions.clamped = {box_sides<dim>().at("left"),
                          box_sides<dim>().at("right")};
    conditions.contact = {box_sides<dim>().at("bottom")};
    ElasticProblem<dim> problem(mesh, conditions);
    Loads<dim>          loads;
    const auto          top =
      std::make_shared<dealii::FunctionParser<dim>>(static_cast<unsigned>(dim));
    top->initialize(dealii::FunctionParser<dim>::default_variable_names(),
                    traction,
                    {});
    loads.tractions[box_sides<dim>().at("top")] = {{top}};
    problem.assemble(Material(), loads);

    const ContactQuadrature<dim> quadrature(
      ContactQuadratureParameters::parse("nodal"));
    const AdhesionIntegral<dim> adhesion(
      problem.unknowns().contact().boundary(), law, quadrature);
    std::vector<unsigned int> normals;
    for (const auto normal : problem.unknowns().contact().normals())
      normals.push_back(normal);
    const Condensation condensed(problem.matrix(),
                                 problem.load(),
                                 normals,
                                 [&](const unsigned int i) {
                                   return problem.unknowns().is_constrained(i);
                                 });
    Minimum            result;
    result.s.setZero(normals.size());
    CondensedProblem condensed_problem(condensed.schur_complement(),
                                       condensed.load(),
                                       adhesion,
                                       result.s);
    MajoriseMinimise(MajoriseMinimiseParameters()).minimize(condensed_problem);
    result.value =
      problem.fields().elastic_functional(condensed.expand(result.s)) +
      adhesion.value(result.s);
    return result;
  }



  template <int dim>
  void
  test(const BoxParameters &box,
       const std::string   &traction,
       const AdhesiveLaw   &law)
  {
    dealii::Triangulation<dim> mesh;
    make_box(box, mesh);
    const Minimum expected = minimise(mesh, traction, law);

    std::mt19937 random(20);
    double       value_error = 0., distance = 0.;
    for (unsigned int round = 0; round < 10; ++round)
      {
        dealii::Triangulation<dim> shuffled;
        shuffle(mesh, random, shuffled);
        const Minimum minimum = minimise(shuffled, traction, law);
        value_error =
          std::max(value_error, std::abs(minimum.value / expected.value - 1.));
        distance = std::max(distance,
                            (minimum.s - expected.s).lpNorm<Eigen::Infinity>() /
                              law.bond_threshold());
      }
    const unsigned int n_broken =
      std::count_if(expected.s.begin(), expected.s.end(), [&](const double s) {
        return s < -law.bond_threshold();
      });
    std::cout << dim << "D, " << n_broken << " of " << expected.s.size()
              << " bonds broken: J to 1e-12: " << verdict(value_error, 1e-12)
              << ", u_nu to 1e-9 M: " << verdict(distance, 1e-9) << '\n';
    if (print_figures)
      std::cout << "  " << value_error << ' ' << distance << '\n';
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;
  const AdhesiveLaw law(winkler_law(69., 0.002).branches);
  BoxParameters     box;
  test<2>(box, "0; if(x < 0.2, 0.69, -0.345)", law);
  box.cells = {{80, 8, 1}};
  test<2>(box, "0; if(x < 0.2, 0.69, -0.345)", law);
  box.cells = {{16, 2, 2}};
  test<3>(box, "0; if(x < 0.2, 0.69, -0.345); 0", law);
}
