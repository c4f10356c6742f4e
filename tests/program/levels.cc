// SPDX-License-Identifier: LGPL-2.1-or-later
// Contact by truncated multigrid on the coarser meshes of a box: how many
// cycles it takes, beside conjugate gradients for A u = f with the same cycle,
// and that the factorisation has nothing to add to its results:
// majorise-minimise on the condensed problem, started there, ends with the same
// J, contact and bonds.
//
// With a scene and assignments as arguments: the figures for that scene.

#include <deal.II/base/mpi.h>
#include <deal.II/base/timer.h>
#include <deal.II/lac/solver_cg.h>

#include <debond/check/verification.h>
#include <debond/elasticity/prolongations.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "../check.h"
#include "solved.h"

using namespace Debond;

namespace
{
  struct Outcome
  {
    SolveResult  result;
    unsigned int linear_cycles; ///< for A u = f
    double       law_violation;
    double       J_error;         ///< of J, against the direct path from there
    unsigned int other_nodes = 0; ///< whose contact or bonds it changes
    double       linear_seconds, seconds;
  };



  template <int dim>
  Outcome
  outcome_of(const Parameters &parameters,
             const Parameters &direct_parameters,
             const bool        compare)
  {
    Outcome          outcome = {};
    const Scene<dim> scene   = scene_of<dim>(parameters);
    const auto      &problem = scene.problem();
    dealii::Timer    timer;
    {
      const TruncatedMultigrid cycle(problem.trilinos_matrix(),
                                     prolongations(scene.body(),
                                                   problem.unknowns()));
      const DistributedVector  f =
        distribute(problem.load(),
                   problem.unknowns().dof_handler().locally_owned_dofs(),
                   MPI_COMM_SELF);
      DistributedVector u = f;
      u                   = 0.;
      dealii::SolverControl control(1000, 1e-10 * f.l2_norm());
      dealii::SolverCG<DistributedVector>(control).solve(
        problem.trilinos_matrix(), u, f, cycle);
      outcome.linear_cycles = control.last_step();
      if (print_figures)
        std::cout << "    " << cycle.n_levels() << " levels\n";
    }
    outcome.linear_seconds = timer.cpu_time();

    timer.restart();
    outcome.result  = solved(parameters, scene);
    outcome.seconds = timer.cpu_time();
    outcome.law_violation =
      verify(problem, scene.adhesion(), scene.law(), outcome.result.u).error();
    for (const std::string &note : outcome.result.notes)
      std::cout << "    " << note << '\n';

    if (!compare)
      return outcome;
    const SolveResult direct =
      solved(direct_parameters, scene, &outcome.result.u);
    outcome.J_error =
      std::abs(outcome.result.functional / direct.functional - 1.);
    const auto s = problem.unknowns().contact().trace(outcome.result.u);
    const auto r = problem.unknowns().contact().trace(direct.u);
    const auto E = scene.adhesion().curvature(s);
    const auto F = scene.adhesion().curvature(r);
    for (unsigned int i = 0; i < s.size(); ++i)
      outcome.other_nodes +=
        (s(i) == 0.) != (r(i) == 0.) || E.coeff(i, i) != F.coeff(i, i);
    return outcome;
  }



  Outcome
  outcome_of(const std::string &scene,
             const Values      &assignments,
             const bool         compare = true)
  {
    Values method = {"Solver/Method=majorise minimise", "Solver/Search=none"};
    if (scene.empty())
      method.emplace_back("Loads/Traction top=0; if(x < 0.2, 0.69, -0.345)");
    const auto with_solver = [&](const std::string &solver) {
      return parameters_of_file(
        scene, method + Values{"Solver/Linear solver=" + solver} + assignments);
    };
    const Parameters parameters = with_solver("multigrid"),
                     direct     = with_solver("direct");
    const Outcome outcome       = parameters.dimension == 2 ?
                                    outcome_of<2>(parameters, direct, compare) :
                                    outcome_of<3>(parameters, direct, compare);
    if (print_figures)
      {
        std::cout << "    " << to_string(outcome.result.status) << ", J ";
        std::cout.precision(12);
        std::cout << outcome.result.functional << ", off by ";
        std::cout.precision(3);
        std::cout << outcome.J_error << ", " << outcome.other_nodes
                  << " other nodes, law violation " << outcome.law_violation
                  << ", iterations " << outcome.result.iterations << '\n'
                  << "    cycles " << outcome.result.linear_iterations
                  << " for contact, " << outcome.linear_cycles
                  << " for A u = f, seconds " << outcome.seconds << ", "
                  << outcome.linear_seconds << ":";
        for (const auto &[part, seconds] : outcome.result.parts)
          std::cout << ' ' << part << ' ' << seconds;
        std::cout << std::endl;
      }
    return outcome;
  }



  /// At most the given numbers of cycles for A u = f and for contact.
  void
  test(const std::string &name,
       const unsigned int linear_cycles,
       const unsigned int contact_cycles,
       const Values      &assignments)
  {
    if (print_figures)
      std::cout << name << std::endl;
    const Outcome outcome = outcome_of("", assignments);
    section(name);
    check("success", outcome.result.status == SolverStatus::success);
    check("cycles for A u = f", outcome.linear_cycles, linear_cycles);
    check("for contact", outcome.result.linear_iterations, contact_cycles);
    check("law", outcome.law_violation, 1e-6);
    check("J of the direct path", outcome.J_error, 1e-11);
    check("its contact and bonds", outcome.other_nodes == 0);
  }
} // namespace



int
main(int argc, char *argv[])
{
  print_figures = argc > 1;
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (argc > 2)
    {
      const std::string scene = argv[1];
      const bool        alone = scene == "alone";
      outcome_of(alone ? argv[2] : scene,
                 Values(argv + 2 + alone, argv + argc),
                 !alone);
      return 0;
    }

  const Values d3    = {"Dimension=3",
                        "Mesh/Lengths=0.4, 0.04, 0.04",
                        "Loads/Traction top=0; if(x < 0.2, 0.69, -0.345); 0"};
  const auto   cells = [](const std::string &numbers) {
    return Values{"Mesh/Cells=" + numbers};
  };
  const auto bonds = [](const std::string &a, const std::string &M) {
    return Values{"Contact law/Bond stiffness=" + a,
                  "Contact law/Bond threshold=" + M};
  };
  test("2D, 80x8", 16, 18, cells("80, 8"));
  test("2D, 320x32", 16, 18, cells("320, 32"));
  test("2D, 640x64", 16, 18, cells("640, 64"));
  test("3D, 40x4x4", 16, 18, d3 + cells("40, 4, 4"));

  for (const auto &[a, M] : {std::make_pair("6.9", "0.002"),
                             {"690", "0.002"},
                             {"6900", "0.002"},
                             {"1e5", "2e-4"}})
    {
      test("2D, 80x8, a = " + std::string(a),
           16,
           18,
           cells("80, 8") + bonds(a, M));
      test("3D, 20x2x2, a = " + std::string(a),
           16,
           18,
           d3 + cells("20, 2, 2") + bonds(a, M));
    }

  test("2D, odd, 75x7", 17, 19, cells("75, 7"));
  test("3D, odd, 37x5x3", 19, 21, d3 + cells("37, 5, 3"));
  test("2D, cells 4:1", 17, 19, cells("40, 16"));
  test("2D, cells 10:1", 17, 19, cells("40, 40"));
  test("3D, cells 4:1", 17, 19, d3 + cells("20, 8, 8"));

  const Values top = {"Boundary conditions/Clamped boundaries=top",
                      "Loads/Traction top=0; 0",
                      "Loads/Body force=0; if(x < 0.2, 30, -15)"};
  test("2D, pad clamped on top", 16, 18, top + cells("80, 8"));
  test("2D, clamped left, tangentially free",
       20,
       24,
       Values{"Boundary conditions/Clamped boundaries=left",
              "Contact law/Tangential displacement=free"} +
         cells("80, 8"));
  test("2D, turned, bottom and top in contact",
       16,
       18,
       Values{"Mesh/Rotation=30",
              "Boundary conditions/Contact boundary=bottom, top",
              "Loads/Traction top=0; 0",
              "Loads/Body force=3; 10"} +
         cells("80, 8"));
  test("3D, plate clamped at two sides",
       18,
       20,
       d3 + Values{"Mesh/Lengths=0.4, 0.04, 0.4",
                   "Mesh/Cells=24, 3, 24",
                   "Boundary conditions/Clamped boundaries=left, back"});
  test("2D, gauss 2",
       16,
       18,
       cells("80, 8") + Values{"Contact law/Quadrature=gauss 2"});
  test("2D, 0.001 off the foundation, pressed",
       16,
       22,
       cells("80, 8") + Values{"Contact law/Initial gap=0.001"});

  for (const auto &[nu, linear, contact] :
       {std::make_tuple("0.45", 40, 50), std::make_tuple("0.49", 90, 110)})
    test("2D, plane strain, nu = " + std::string(nu),
         linear,
         contact,
         cells("80, 8") + Values{"Material/Hypothesis=plane strain",
                                 "Material/Poisson ratio=" + std::string(nu)});

  // In Pa and m, and MPa and mm.
  const auto steps = [](const Values &assignments) {
    const Outcome outcome = outcome_of("", assignments, false);
    return std::make_pair(outcome.linear_cycles,
                          outcome.result.linear_iterations);
  };
  const auto gpa = steps(cells("80, 8"));
  check("as many cycles in Pa and m",
        gpa ==
          steps(cells("80, 8") +
                Values{"Material/Young modulus=69e9",
                       "Contact law/Bond stiffness=69e9",
                       "Loads/Traction top=0; if(x < 0.2, 0.69e9, -0.345e9)"}));
  check("as many cycles in MPa and mm",
        gpa == steps(cells("80, 8") +
                     Values{"Mesh/Lengths=400, 40",
                            "Material/Young modulus=69e3",
                            "Contact law/Bond stiffness=69",
                            "Contact law/Bond threshold=2",
                            "Loads/Traction top=0; if(x < 200, 690, -345)"}));
}
