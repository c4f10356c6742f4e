// SPDX-License-Identifier: LGPL-2.1-or-later
// Contact boundaries with bonds, gaps and tangential conditions of their own:
// equal bonds beside one law, columns glued at both ends against closed forms,
// small scenes against an enumeration of all states of the bonds by
// own_check.h. Arguments: the number of these scenes, the first one.

#include <deal.II/base/mpi.h>

#include <cmath>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "../check.h"
#include "own_check.h"
#include "solve_scene.h"

using namespace Debond;

namespace
{
  /// The benchmark's strip with bonds at its end as well.
  void
  test_equal(const std::string &name, const Values &settings)
  {
    const Values scene =
      Values{"Parts/Glued=bottom: x < 0.2",
             "Boundary conditions/Clamped boundaries=left",
             "Boundary conditions/Contact boundary=bottom, right",
             "Contact law/Bond threshold=0.0003",
             "Loads/Body force=-0.8; 0.8*sin(12*x)"} +
      settings;
    const Json one = solve_scene(scene);
    const Json several =
      solve_scene(scene + Values{"Contact law/Bond stiffness Glued=69",
                                 "Contact law/Bond strength right=0.0207",
                                 "Contact law/Bond threshold right=0.0003"});
    check(name + ": solved", one["status"] == "success");
    // Local methods find the intact state or the peeled one.
    if (name == "automatic" || name == "gauss 5")
      check(name + ": some bonds break, some do not",
            one["bond_states"]["broken"] > 0 &&
              one["bond_states"]["bonded"] > 0);
    check(name + ": J",
          relative(several["functional"], one["functional"]),
          1e-14);
    check(name + ": states", one["bond_states"] == several["bond_states"]);
    check(name + ": estimated error",
          relative(several["estimated_error"], one["estimated_error"]),
          1e-10);
  }



  /// A column of height H that shrinks by q H, glued at both ends, may widen.
  void
  test_columns(const unsigned int dim)
  {
    const double H = 0.1, E = 70., nu = 0.3, q = 2e-3, a = 100., b = 30.;
    const auto   column =
      [&](const double M_bottom, const double M_top, const double gap) {
        return solve_scene(
          {"Dimension=" + std::to_string(dim),
           std::string("Mesh/Lengths=0.2, 0.1") + (dim == 3 ? ", 0.1" : ""),
           dim == 3 ? "Mesh/Cells=4, 2, 2" : "Mesh/Cells=8, 4",
           "Material/Young modulus=70",
           "Material/Poisson ratio=0.3",
           "Material/Hypothesis=plane stress",
           "Material/Thermal expansion=1e-3",
           "Loads/Temperature change=-2",
           "Boundary conditions/Clamped boundaries=",
           std::string("Boundary conditions/Symmetry boundaries=left") +
             (dim == 3 ? ", back" : ""),
           "Boundary conditions/Contact boundary=bottom, top",
           "Contact law/Tangential displacement=fixed",
           "Contact law/Tangential displacement bottom=free",
           "Contact law/Tangential displacement top=free",
           "Contact law/Bond stiffness=1",
           "Contact law/Bond threshold=5",
           "Contact law/Bond stiffness bottom=" + text(a),
           "Contact law/Bond threshold bottom=" + text(M_bottom),
           "Contact law/Bond stiffness top=" + text(b),
           "Contact law/Bond threshold top=" + text(M_top),
           "Contact law/Initial gap top=" + text(gap)});
      };
    const double area = dim == 3 ? 0.02 : 0.2;
    // Of the strains of a free column, over its height.
    const double free =
      (dim == 3 ? 1.5 / (1. - 2. * nu) : 1. / (1. - nu)) * E * q * q * H;
    for (const double gap : {0., 1e-4})
      {
        const std::string name =
          std::to_string(dim) + "D, gap " + text(gap) + ": ";
        // What the springs and the column share.
        const double length = q * H + gap;
        const double t      = length / (1. / a + 1. / b + H / E);
        const Json   holds  = column(1.001 * t / a, 1.001 * t / b, gap);
        check(name + "solved", holds["status"] == "success");
        check(name + "J",
              relative(holds["functional"], area * (0.5 * t * length - free)),
              1e-12);
        check(name + "opening",
              relative(holds["largest_opening"], t / b),
              1e-12);
        for (const bool at_top : {true, false})
          {
            const double M_bottom = (at_top ? 2. : 0.999) * t / a,
                         M_top    = (at_top ? 0.999 : 2.) * t / b;
            const Json breaks     = column(M_bottom, M_top, gap);
            check(name + "breaks where it is weak",
                  breaks["status"] == "success");
            const double G =
              at_top ? 0.5 * b * M_top * M_top : 0.5 * a * M_bottom * M_bottom;
            // The other one holds it without a force.
            check(name + "J then",
                  relative(breaks["functional"], area * (G - free)),
                  1e-12);
          }
      }
  }



  /// A box with two or three contact sides, against all states of the bonds.
  void
  test_enumeration(const unsigned int number)
  {
    std::mt19937 engine(number);
    const auto   uniform = [&](const double from, const double to) {
      return from + (to - from) * (engine() / 4294967296.);
    };
    const auto chance = [&](const double p) { return uniform(0., 1.) < p; };

    OwnCheck::Scene<2> own;
    own.lengths          = {{1., uniform(0.3, 1.)}};
    own.cells            = {{4, 2}};
    own.lambda           = 0.75;
    own.mu               = 1.;
    own.clamped          = {"left"};
    own.contact          = {"bottom", chance(0.5) ? "top" : "right"};
    own.tangential_fixed = chance(0.5);
    own.a                = 2.;
    own.M                = 0.1;
    own.quadrature       = "nodal";
    // lambda = E nu / (1 - nu^2), mu = E / (2 (1 + nu)) with nu = 0.2727...
    const double nu     = own.lambda / (own.lambda + 2. * own.mu);
    Values       values = {"Mesh/Lengths=1, " + text(own.lengths[1]),
                           "Mesh/Cells=4, 2",
                           "Material/Young modulus=" + text(2. * own.mu * (1. + nu)),
                           "Material/Poisson ratio=" + text(nu),
                           "Boundary conditions/Clamped boundaries=left",
                           "Contact law/Bond stiffness=2",
                           "Contact law/Bond threshold=0.1",
                           std::string("Contact law/Tangential displacement=") +
                             (own.tangential_fixed ? "fixed" : "free"),
                           "Solver/Method=automatic",
                           "Solver/Search=full",
                           "Solver/Prove=true"};
    std::string  contact;
    for (const std::string &side : own.contact)
      {
        contact += (contact.empty() ? "" : ", ") + side;
        auto        &bonds   = own.own[side];
        const double a       = 2. * uniform(0.1, 1.) * (chance(0.5) ? 0.1 : 1.),
                     M       = uniform(0.02, 0.1);
        bonds.stiffness      = [a](const auto &) { return a; };
        bonds.threshold      = [M](const auto &) { return M; };
        const bool by_energy = chance(0.5);
        values               = values +
                 Values{"Contact law/Bond threshold " + side + '=' + text(M),
                        by_energy ?
                          "Contact law/Fracture energy " + side + '=' +
                            text(0.5 * a * M * M) :
                          "Contact law/Bond stiffness " + side + '=' + text(a)};
        if (chance(0.3))
          {
            const double gap = uniform(0., 0.05), slope = uniform(0., 0.05);
            bonds.gap = [=](const auto &point) {
              return gap + slope * point[0];
            };
            values.push_back("Contact law/Initial gap " + side + '=' +
                             text(gap) + "+" + text(slope) + "*x");
          }
        if (chance(0.3))
          {
            bonds.tangential_fixed = !own.tangential_fixed;
            values.push_back("Contact law/Tangential displacement " + side +
                             (own.tangential_fixed ? "=free" : "=fixed"));
          }
      }
    values.push_back("Boundary conditions/Contact boundary=" + contact);
    const double fx = uniform(-0.5, 0.5), fy = uniform(-0.5, 0.5),
                 slope = uniform(-1., 1.);
    own.body_force     = [=](const auto &point, const auto &) {
      return std::array<OwnCheck::Real, 2>{{fx, fy + slope * point[0]}};
    };
    values.push_back("Loads/Body force=" + text(fx) + "; " + text(fy) + "+(" +
                     text(slope) + ")*x");

    const OwnCheck::Body<2> body(own);
    const unsigned int      n     = body.n_contact();
    OwnCheck::Real          least = 1e300L;
    for (unsigned int state = 0; state < 1U << n; ++state)
      {
        OwnCheck::VectorX s = OwnCheck::VectorX::Zero(n);
        for (unsigned int i = 0; i < n; ++i)
          if ((state >> i) % 2 == 1)
            s(i) = -1.;
        least = std::min(least, body.functional(body.expand(body.descend(s))));
      }
    const Json        result = solve_scene(values);
    const std::string name   = "scene " + std::to_string(number);
    check(name + ": proved",
          result["status"] == "success" &&
            result["minimum"]["state"] == "global");
    if (result["status"] != "success")
      std::cout << result["status"] << std::endl;
    else
      check(name + ": J is the least of all states",
            std::abs(result["functional"].get<double>() -
                     static_cast<double>(least)) /
              std::abs(static_cast<double>(least)),
            1e-9);
  }
} // namespace



int
main(int argc, char *argv[])
{
  const unsigned int n_scenes = argc > 1 ? std::stoul(argv[1]) : 12;
  const unsigned int first    = argc > 2 ? std::stoul(argv[2]) : 0;
  print_figures               = argc > 1;
  // Multigrid needs MPI, which starts only once in a process.
  int                                            no_arguments = 0;
  char                                         **no_argument  = nullptr;
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(no_arguments,
                                                     no_argument,
                                                     1);

  test_equal("automatic", {"Solver/Method=automatic"});
  test_equal("proof", {"Solver/Method=automatic", "Solver/Prove=true"});
  for (const std::string rule : {"gauss 5", "gauss 2", "midpoint"})
    test_equal(rule,
               {"Solver/Method=automatic", "Contact law/Quadrature=" + rule});
  test_equal("energy bundle", {"Solver/Method=energy bundle"});
  test_equal("euclidean bundle",
             {"Solver/Method=euclidean bundle", "Mesh/Cells=20, 2"});
  test_equal("multigrid",
             {"Solver/Method=majorise minimise",
              "Solver/Linear solver=multigrid"});
  test_equal("degree 2",
             {"Solver/Method=automatic",
              "Mesh/Degree=2",
              "Mesh/Cells=20, 2",
              "Contact law/Quadrature=gauss 8"});
  test_equal("load path",
             {"Solver/Method=automatic",
              "Load path/Factors=0.3, 0.6, 1",
              "Load path/Bonds heal=false"});
  test_equal("refined",
             {"Solver/Method=automatic", "Accuracy/Maximum unknowns=3000"});
  test_columns(2);
  test_columns(3);
  for (unsigned int number = first; number < first + n_scenes; ++number)
    test_enumeration(number);
}
