// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Scenes with quadratic displacements: J beside an independent program and
// beside J without the error of the mesh, the foundation at every point,
// methods beside each other, units, bodies of many kinds beside linear
// displacements, and meshes that are refined.

#include <deal.II/fe/fe_values.h>

#include <debond/check/verification.h>
#include <debond/solve/adaptive_loop.h>
#include <debond/solve/method_choice.h>

#include <cmath>

#include "../check.h"
#include "solved.h"

using namespace Debond;

namespace
{
  template <int dim>
  struct Solved
  {
    explicit Solved(const Values &values)
      : parameters(parameters_of(values))
      , scene(parameters)
    {
      result = solved(parameters, scene);
      error  = verify(scene.problem(), scene.adhesion(), scene.law(), result.u)
                .error();
      estimate = estimate_error<dim>({scene.problem(),
                                      scene.adhesion(),
                                      scene.conditions(),
                                      scene.supports(),
                                      scene.loads()},
                                     result.u,
                                     result.functional)
                   .relative();
    }

    double
    J() const
    {
      return result.functional;
    }

    /// The largest u_nu at points of all faces, from the displacement there, in
    /// parts of the largest one.
    double
    penetration() const
    {
      const auto     &unknowns     = scene.problem().unknowns();
      const DofVector displacement = unknowns.cartesian_displacement(result.u);
      double          largest      = -1e300;
      // Points of a fine grid, those on the edges too.
      std::vector<dealii::Point<dim - 1>> points;
      for (unsigned int i = 0; i <= 40; ++i)
        for (unsigned int j = 0; j <= (dim == 3 ? 40 - i : 0); ++j)
          {
            points.emplace_back();
            points.back()[0] = i / 40.;
            if constexpr (dim == 3)
              points.back()[1] = j / 40.;
          }
      dealii::FEFaceValues<dim>           fe_values(unknowns.mapping(),
                                          unknowns.dof_handler().get_fe(),
                                          dealii::Quadrature<dim - 1>(points),
                                          dealii::update_values |
                                            dealii::update_normal_vectors);
      std::vector<dealii::Vector<double>> values(points.size(),
                                                 dealii::Vector<double>(dim));
      for (const auto &cell : unknowns.dof_handler().active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary() &&
              scene.conditions().contact.count(cell->face(f)->boundary_id()) >
                0)
            {
              fe_values.reinit(cell, f);
              fe_values.get_function_values(displacement, values);
              for (unsigned int q = 0; q < points.size(); ++q)
                {
                  double u_nu = 0.;
                  for (unsigned int d = 0; d < dim; ++d)
                    u_nu += fe_values.normal_vector(q)[d] * values[q](d);
                  raise(largest, u_nu);
                }
            }
      return largest / displacement.linfty_norm();
    }

    const Parameters parameters;
    const Scene<dim> scene;
    SolveResult      result;
    double           error;
    double           estimate;
  };



  const Values benchmark = {"Loads/Traction top=0; if(x < 0.2, 0.69, -0.345)",
                            "Contact law/Quadrature=gauss 8"};

  const Values quadratic = with(benchmark, {"Mesh/Degree=2"});

  /// On refined meshes by two programs.
  constexpr double limit = -5.91510e-04;



  void
  check_benchmark()
  {
    // A program of its own, in Python, with Gauss points on this mesh.
    const Solved<2> coarse(with(quadratic, {"Mesh/Cells=20, 2"}));
    check("20x2, J beside another program",
          std::abs(coarse.J() / -5.892218422e-04 - 1.),
          1e-5);
    check("20x2, unknowns",
          coarse.scene.problem().unknowns().n_free_dofs() == 671);
    check("20x2, verification", coarse.error, 1e-9);
    check("20x2, u_nu <= 0 at all points", coarse.penetration(), 1e-15);
    const Solved<2> gauss(
      with(quadratic, {"Mesh/Cells=20, 2", "Contact law/Quadrature=gauss 20"}));
    check("gauss 20 beside exact", std::abs(gauss.J() / coarse.J() - 1.), 1e-5);

    const Solved<2> fine(with(quadratic, {"Mesh/Cells=40, 4"}));
    const double    error = fine.J() / limit - 1.;
    check("40x4, J is above its limit", error < 0.);
    check("40x4, error of J", std::abs(error), 2e-3);
    check("40x4, estimate over error", std::abs(fine.estimate / -error), 1.3);
    check("40x4, error over estimate", std::abs(-error / fine.estimate), 1.3);

    for (const std::string method : {"energy bundle", "majorise minimise"})
      {
        const Solved<2> other(
          with(quadratic, {"Mesh/Cells=20, 2", "Solver/Method=" + method}));
        check(method + ", J", std::abs(other.J() / coarse.J() - 1.), 1e-9);
        check(method + ", verification", other.error, 1e-5);
      }
    const Values    few = with(quadratic, {"Mesh/Cells=5, 1"});
    const Solved<2> euclidean(with(few, {"Solver/Method=euclidean bundle"}));
    check("euclidean bundle, J",
          std::abs(euclidean.J() / Solved<2>(few).J() - 1.),
          1e-5);

    const Solved<2> pascal(with(quadratic,
                                {"Mesh/Cells=20, 2",
                                 "Mesh/Lengths=400, 40",
                                 "Material/Young modulus=69e3",
                                 "Loads/Traction top="
                                 "0; if(x < 200, 690, -345)",
                                 "Contact law/Bond stiffness=69",
                                 "Contact law/Bond threshold=2"}));
    check("in MPa and mm, J",
          std::abs(pascal.J() * 1e-9 / coarse.J() - 1.),
          1e-12);
    check("in as many steps",
          pascal.result.iterations == coarse.result.iterations);
  }



  /// J(x + h d) against the subgradient.
  void
  check_subgradient()
  {
    const Solved<2> solved(with(quadratic, {"Mesh/Cells=10, 1"}));
    const auto     &J = solved.scene.functional();
    DofVector       u = solved.result.u, d(u.size()), eta(u.size());
    for (unsigned int i = 0; i < u.size(); ++i)
      if (!solved.scene.problem().unknowns().is_constrained(i))
        d(i) = 1e-4 * (std::fmod(0.618 * i, 1.) - 0.5);
    u.add(0.3, d);
    J.subgradient(u, eta);
    const double h     = 1e-4;
    DofVector    right = u, left = u;
    right.add(h, d);
    left.add(-h, d);
    check("subgradient of J against differences",
          std::abs((J.value(right) - J.value(left)) / (2. * h) / (eta * d) -
                   1.),
          1e-7);
  }



  /// Quadratic displacements are lower than linear ones on the same mesh, and
  /// not lower than the limit that both have.
  template <int dim>
  void
  check_body(const std::string &name, const Values &values)
  {
    const Solved<dim> one(values);
    const Solved<dim> two(with(values, {"Mesh/Degree=2"}));
    section(name);
    check("  verification", two.error, 1e-6);
    check("  u_nu <= 0 at all points", two.penetration(), 1e-15);
    check("  J is lower than with linear displacements", two.J() < one.J());
    check("  estimated error beside linear displacements",
          two.estimate / one.estimate,
          0.7);
  }



  void
  check_bodies()
  {
    check_body<2>("pad clamped on top",
                  with(benchmark,
                       {"Mesh/Lengths=0.1, 0.1",
                        "Mesh/Cells=4, 4",
                        "Boundary conditions/Clamped boundaries=top",
                        "Contact law/Tangential displacement=free",
                        "Loads/Traction top=",
                        "Loads/Traction left=2; 0.5"}));
    check_body<2>("L-shaped",
                  {"Mesh/Source=generator",
                   "Mesh/Generator=hyper_L",
                   "Mesh/Arguments=0 : 2 : true",
                   "Mesh/Refinements=1",
                   "Boundary conditions/Clamped boundaries=0",
                   "Boundary conditions/Contact boundary=3",
                   "Contact law/Quadrature=gauss 8",
                   "Contact law/Tangential displacement=free",
                   "Loads/Traction top=",
                   "Loads/Traction 1=1; 0.5"});
    check_body<2>("plane strain, nu = 0.4999",
                  with(benchmark,
                       {"Mesh/Cells=20, 2",
                        "Material/Hypothesis=plane strain",
                        "Material/Poisson ratio=0.4999"}));
    check_body<2>("supports that move",
                  with(benchmark,
                       {"Mesh/Cells=20, 2",
                        "Contact law/Tangential displacement=free",
                        "Boundary conditions/Clamped boundaries=left",
                        "Boundary conditions/Displacement right="
                        "free; 0.003 + 0.01*y*y"}));
    check_body<3>("bar",
                  {"Dimension=3",
                   "Mesh/Lengths=0.4, 0.04, 0.04",
                   "Mesh/Cells=6, 1, 1",
                   "Loads/Traction top=0; if(x < 0.2, 0.69, -0.345); 0",
                   "Contact law/Quadrature=gauss 5"});
  }



  void
  check_loop(const std::string &name, const Values &values)
  {
    const auto [scene, levels, result] = refined<2>(parameters_of(values));
    bool falls = true, is_held = true;
    for (unsigned int k = 1; k < levels.size(); ++k)
      falls = falls && levels[k].functional < levels[k - 1].functional;
    for (const AdaptiveLevel &level : levels)
      is_held = is_held && level.functional > limit * (1. + 2e-6);
    section(name);
    check("  several meshes", levels.size() >= 3);
    check("  J falls on each", falls);
    check("  and stays above its limit", is_held);
    check("  nothing is short", result.shortfall.empty());
    check("  error of J",
          std::abs(result.solve.functional / limit - 1.),
          1.3e-4);
    check("  unknowns", levels.back().unknowns, 2500.);
    // With the state of the mesh before; kinks of the trace move.
    check("  steps on the last mesh",
          levels.back().iterations < levels.front().iterations);
  }



  /// Fronts of stiff bonds, of which the kinks move: the minima of majorants
  /// alone come to 1e-8 of the forces in 200 steps.
  void
  check_stiff_bonds()
  {
    for (const std::string traction :
         {"if(abs(x-0.2)<0.05,5,0)", "4*sin(30*x)", "1.2+1.2*sin(20*x)"})
      {
        const Parameters parameters =
          parameters_of({"Mesh/Lengths=0.4, 0.2",
                         "Mesh/Cells=12, 6",
                         "Mesh/Degree=2",
                         "Boundary conditions/Clamped boundaries=top",
                         "Contact law/Quadrature=gauss 8",
                         "Contact law/Bond stiffness=6900",
                         "Contact law/Bond threshold=1e-3",
                         "Loads/Traction bottom=0; " + traction,
                         "Accuracy/Target=1e-4"});
        const auto [scene, levels, result] = refined<2>(parameters);
        unsigned int most_steps            = 0;
        for (const AdaptiveLevel &level : levels)
          raise(most_steps, level.iterations);
        section("stiff bonds, ", traction);
        check("  success", result.solve.status == SolverStatus::success);
        check("  nothing is short", result.shortfall.empty());
        check("  steps", most_steps, 60.);
      }
  }
} // namespace



int
main(int argc, char **)
{
  print_figures = argc > 1;
  check_benchmark();
  check_subgradient();
  check_bodies();
  check_loop("refined meshes",
             with(quadratic, {"Mesh/Cells=20, 2", "Accuracy/Target=1e-4"}));
  check_stiff_bonds();
}
