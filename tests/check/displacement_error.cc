// SPDX-License-Identifier: LGPL-2.1-or-later
// The error norms against deal.II's own, and what they see: the displacement
// without divergence on a crossed mesh, and on squares cut along one diagonal,
// which are known to lock.

#include <deal.II/base/function_parser.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/numerics/vector_tools.h>

#include <debond/check/displacement_error.h>
#include <debond/elasticity/elastic_problem.h>
#include <debond/linear_algebra/condensation.h>
#include <debond/mesh/box.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <regex>
#include <string>

#include "../check.h"

using namespace Debond;

namespace
{
  using Function = std::shared_ptr<dealii::FunctionParser<2>>;

  /// Of x, y and the constant mu.
  Function
  function(const std::string &expressions, const double mu)
  {
    auto result = std::make_shared<dealii::FunctionParser<2>>(2);
    result->initialize("x,y", expressions, {{"mu", mu}});
    return result;
  }



  /// g = x^2 (1 - x)^2 and its derivatives.
  std::string
  g(const unsigned int derivative, const std::string &x)
  {
    const std::string of_x[] = {"x^2*(1-x)^2",
                                "2*x*(1-x)*(1-2*x)",
                                "(2-12*x+12*x^2)",
                                "(24*x-12)"};
    return std::regex_replace(of_x[derivative], std::regex("x"), x);
  }



  /// The curl of g(x) g(y), zero on the boundary of the unit square.
  const std::string displacement =
    g(0, "x") + '*' + g(1, "y") + "; -" + g(1, "x") + '*' + g(0, "y");

  /// Its body force, -mu times the Laplacian.
  const std::string body_force = "-mu*(" + g(2, "x") + '*' + g(1, "y") + '+' +
                                 g(0, "x") + '*' + g(3, "y") + "); mu*(" +
                                 g(3, "x") + '*' + g(0, "y") + '+' + g(1, "x") +
                                 '*' + g(2, "y") + ')';



  /// The error on a mesh whose whole boundary is clamped.
  DisplacementError
  solve(const dealii::Triangulation<2> &mesh, const double nu)
  {
    BoundaryConditions conditions;
    for (const auto id : mesh.get_boundary_ids())
      conditions.clamped.insert(id);
    ElasticProblem<2> problem(mesh, conditions);
    Material          material;
    material.young_modulus = 1.;
    material.poisson_ratio = nu;
    material.hypothesis    = Material::Hypothesis::plane_strain;
    Loads<2> loads;
    loads.body_force = function(body_force, material.shear_modulus());
    problem.assemble(material, loads);
    const Condensation condensed(problem.matrix(),
                                 problem.load(),
                                 {},
                                 [&](const unsigned int i) {
                                   return problem.unknowns().is_constrained(i);
                                 });
    const DofVector    u = condensed.expand(Eigen::VectorXd());

    const Function          exact = function(displacement, 0.);
    const DisplacementError error = displacement_error(problem, u, *exact);
    const auto              norm  = [&](const DofVector                    &v,
                          const dealii::VectorTools::NormType kind) {
      DofVector cells(mesh.n_active_cells());
      dealii::VectorTools::integrate_difference(
        problem.unknowns().mapping(),
        problem.unknowns().dof_handler(),
        v,
        *exact,
        cells,
        dealii::QGaussSimplex<2>(4),
        kind);
      return cells.l2_norm();
    };
    const DofVector zero(u.size());
    const double    l2 = norm(u, dealii::VectorTools::L2_norm) /
                      norm(zero, dealii::VectorTools::L2_norm);
    const double h1 = norm(u, dealii::VectorTools::H1_seminorm) /
                      norm(zero, dealii::VectorTools::H1_seminorm);
    std::cout << "  nu = " << nu << ": L2 and H1 as deal.II's to 1e-3: "
              << verdict(std::max(std::abs(error.l2 / l2 - 1.),
                                  std::abs(error.h1 / h1 - 1.)),
                         1e-3);
    // |grad u|^2 mu / 2 without divergence: 4/1225 is the integral of
    // |grad u|^2, by hand.
    std::cout << ", energy to 1e-6: "
              << verdict(
                   std::abs(error.exact_energy /
                              (material.shear_modulus() * 4. / 1225. * 0.5) -
                            1.) < 1e-6)
              << '\n';
    if (print_figures)
      std::cout << "    " << error.l2 << ' ' << l2 << ", " << error.h1 << ' '
                << h1 << ", " << error.exact_energy << '\n';
    return error;
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;
  BoxParameters box;
  box.lengths = {{1., 1., 1.}};
  box.cells   = {{16, 16, 1}};
  dealii::Triangulation<2> crossed, diagonal;
  make_box(box, crossed);
  dealii::GridGenerator::subdivided_hyper_cube_with_simplices(diagonal, 23);

  std::cout << "crossed\n";
  const double crossed_growth =
    solve(crossed, 0.4999).h1 / solve(crossed, 0.3).h1;
  std::cout << "one diagonal\n";
  const double diagonal_growth =
    solve(diagonal, 0.4999).h1 / solve(diagonal, 0.3).h1;
  std::cout << "The error in H1 grows towards nu = 1/2 by less than a half on "
               "the crossed mesh: "
            << verdict(crossed_growth, 1.5)
            << ", by more than 4 on the other one: "
            << verdict(diagonal_growth > 4.) << '\n';
  if (print_figures)
    std::cout << "  " << crossed_growth << ' ' << diagonal_growth << '\n';
}
