// SPDX-License-Identifier: LGPL-2.1-or-later
// Bodies that only their bonds and the foundation hold, against closed forms:
// columns pulled and pressed, pulled off and tilted.

#include <debond/check/coming_off.h>
#include <debond/solve/scene.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "../check.h"
#include "parameters_of.h"
#include "solve_scene.h"

using namespace Debond;

namespace
{
  /// The least u_nu (or 0) and the largest one.
  std::pair<double, double>
  range_of_openings(const Json &result)
  {
    std::pair<double, double> range = {0., -1e300};
    for (const Json &row : result["profile"])
      {
        range.first = std::min(range.first, number(row, "u_nu"));
        raise(range.second, number(row, "u_nu"));
      }
    return range;
  }



  /// A pad of length 0.2 and height 0.1 (and depth 0.1) on a foundation, which
  /// may widen (held by planes of symmetry), or with nu = 0 and tangential
  /// displacements fixed.
  Values
  pad(const unsigned int dim, const Units &units, const bool may_widen)
  {
    const double L = units.length;
    return {"Dimension=" + std::to_string(dim),
            "Mesh/Lengths=" + text(0.2 * L) + ", " + text(0.1 * L) +
              (dim == 3 ? ", " + text(0.1 * L) : ""),
            dim == 3 ? "Mesh/Cells=4, 2, 2" : "Mesh/Cells=8, 4",
            "Material/Young modulus=" + text(70. * units.modulus),
            std::string("Material/Poisson ratio=") + (may_widen ? "0.3" : "0"),
            "Boundary conditions/Clamped boundaries=",
            "Boundary conditions/Contact boundary=bottom",
            std::string("Boundary conditions/Roller boundaries=") +
              (may_widen ? dim == 3 ? "left, back" : "left" : ""),
            std::string("Contact law/Tangential displacement=") +
              (may_widen ? "free" : "fixed"),
            "Contact law/Bond stiffness=" +
              text(100. * units.modulus / units.length),
            "Contact law/Bond threshold=" + text(1e-3 * L)};
  }



  /// Traction on the top, upwards.
  Values
  pulled(const unsigned int dim, const std::string &p)
  {
    return {"Loads/Traction top=0; " + p + (dim == 3 ? "; 0" : "")};
  }



  /// The motion is a translation in y and a rotation about z, from the middle
  /// of the pad's lower side, with what the loads do along it.
  void
  check_coming_off(const Json        &summary,
                   const unsigned int dim,
                   const double       translation,
                   const double       rotation,
                   const double       work)
  {
    const Json &off   = summary["comes_off"];
    double      error = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      raise(error,
            std::abs(off["translation"][d].get<double>() -
                     (d == 1 ? translation : 0.)));
    check("translation", error, 1e-9);
    check("rotation",
          std::abs(off["rotation"].back().get<double>() - rotation),
          1e-9 * std::max(1., std::abs(rotation)));
    check("work", relative(off["work"], work), 1e-9);
  }



  /// Bonds of stiffness @p a bear the traction @p p on the pad.
  void
  check_held(const Json        &result,
             const unsigned int dim,
             const Units       &units,
             const double       a,
             const double       p)
  {
    const double L = units.length, E = 70. * units.modulus, H = 0.1 * L,
                 area = 0.2 * L * (dim == 3 ? 0.1 * L : 1.);
    check("bonds hold it", result["status"] == "success");
    check("J",
          relative(result["functional"],
                   -0.5 * p * p * area * (H / E + 1. / a)),
          1e-12);
    const auto [least, largest] = range_of_openings(result);
    check("least_u_nu", relative(least, -p / a), 1e-12);
    check("largest_u_nu", relative(largest, -p / a), 1e-12);
  }



  void
  test_column(const unsigned int dim, const Units &units, const bool may_widen)
  {
    section("Pad, ",
            dim,
            "D, ",
            units.name,
            (may_widen ? ", may widen" : ", tangential fixed"));
    const double L = units.length, area = 0.2 * L * (dim == 3 ? 0.1 * L : 1.),
                 E = 70. * units.modulus, H = 0.1 * L,
                 a = 100. * units.modulus / L, M = 1e-3 * L;
    const Values scene = pad(dim, units, may_widen);

    const double p      = 0.9 * a * M;
    const Json   result = solve_scene(scene + pulled(dim, text(p)));
    check_held(result, dim, units, a, p);
    check("force of the foundation",
          relative(result["contact_reaction"][1], -p * area),
          1e-12);

    const Json pressed = solve_scene(scene + pulled(dim, text(-p)));
    check("pressed, J",
          relative(pressed["functional"], -0.5 * p * p * area * H / E),
          1e-12);
    check("and in contact",
          range_of_openings(pressed) == std::make_pair(0., 0.));
    const Json without_bonds = solve_scene(scene + pulled(dim, text(-p)) +
                                           Values{"Contact law/Law=none"});
    check("without bonds, J",
          relative(without_bonds["functional"], pressed["functional"]),
          1e-12);

    check("just below the threshold",
          solve_scene(scene + pulled(dim, text(0.9999999 * a * M)))["status"] ==
            "success");
    const Json off = solve_scene(scene + pulled(dim, text(1.0000001 * a * M)));
    check("just above", off["status"] == "comes off" && off["exit_code"] == 0);
    check("which has no J", off["functional"].is_null());
    check_coming_off(off, dim, 1., 0., 1.0000001 * a * M * area);
    check("and without bonds",
          solve_scene(scene + pulled(dim, text(1e-9 * a * M)) +
                      Values{"Contact law/Law=none"})["status"] == "comes off");
    check("before it comes to a gap that is closed",
          solve_scene(scene + pulled(dim, text(-p)) +
                      Values{"Contact law/Law=none",
                             "Contact law/Initial gap=" +
                               text(1e-4 * L)})["status"] == "success");

    const Json path =
      solve_scene(scene + pulled(dim, text(a * M)) +
                  Values{"Load path/Factors=0.4, 0.8, 1.2, 0.4"});
    check("load path", path["status"] == "comes off");
    check("at factor 1.2", path["load_path"]["comes_off_at"] == 1.2);
    check("after 0.8", path["load_path"]["last_factor"] == 0.8);
    check_coming_off(path, dim, 1., 0., 1.2 * a * M * area);
    check("where J is",
          relative(path["functional"],
                   -0.32 * a * M * a * M * area * (H / E + 1. / a)),
          1e-12);
  }



  /// Without bonds the resultant has to stay within the pad: 1 - b x has its
  /// resultant b L^2 / 12 from the middle.
  void
  test_tilting(const unsigned int dim, const Units &units)
  {
    section("Tilting, ", dim, "D, ", units.name);
    const double L  = 0.2 * units.length;
    const auto   at = [&](const double part) {
      return pad(dim, units, false) +
             pulled(dim,
                    text(-1e-3 * units.modulus) + "*(1 + " +
                      text(6. * part / L) + "*(x - " + text(0.5 * L) + "))") +
             Values{"Contact law/Law=none"};
    };
    for (const double part : {0.5, 0.9, 0.99})
      {
        const Json result = solve_scene(at(part));
        check("resultant at " + text(part) + " of the half",
              result["status"] == "success" &&
                result["bond_states"]["contact"] > 0 &&
                (part < 0.6 || result["bond_states"]["free"] > 0));
      }
    // It turns about the end beyond which the resultant is.
    const double depth = dim == 3 ? 0.1 * units.length : 1.;
    for (const double part : {1.01, 1.5, -1.01})
      {
        const Json result = solve_scene(at(part));
        check("resultant at " + text(part), result["status"] == "comes off");
        check_coming_off(result,
                         dim,
                         0.5,
                         (part < 0. ? 1. : -1.) / L,
                         0.5e-3 * units.modulus * L * depth *
                           (std::abs(part) - 1.));
      }
  }



  void
  test_crack(const Units &units)
  {
    section("Cracks, ", units.name);
    // Only the middle third is glued: it cannot come off under a couple that
    // the foundation bears together with it.
    const double L = 0.2 * units.length,
                 a = 100. * units.modulus / units.length,
                 M = 1e-3 * units.length;
    const Values cracked =
      pad(2, units, false) +
      Values{"Contact law/Bond stiffness=if(abs(x - " + text(0.5 * L) + ") < " +
             text(0.15 * L) + ", " + text(a) + ", 0)"};
    const Json held = solve_scene(
      cracked +
      pulled(2, text(0.1 * a * M) + "*(x - " + text(0.5 * L) + ")/" + text(L)));
    check("a couple is borne",
          held["status"] == "success" && held["bond_states"]["free"] > 0);
    check("the whole strength is not",
          solve_scene(cracked + pulled(2, text(0.9 * a * M)))["status"] ==
            "comes off");
  }



  /// Two contact nodes have nothing but rigid motions: S is rounding.
  void
  test_two_nodes(const Units &units)
  {
    section("Two nodes, ", units.name);
    const double L = units.length, E = 70. * units.modulus, H = 0.1 * L,
                 a = 100. * units.modulus / L, M = 1e-3 * L, p = 0.9 * a * M;
    const Values pad_of_one_cell =
      pad(2, units, false) + Values{"Mesh/Cells=1, 8"};
    const Values from_the_side = {
      "Loads/Traction right=" + text(1e-5 * units.modulus) + "; 0"};
    const Json held = solve_scene(pad_of_one_cell + pulled(2, text(p)));
    check("bonds hold it", held["status"] == "success");
    check("J",
          relative(held["functional"],
                   -0.5 * p * p * 0.2 * L * (H / E + 1. / a)),
          1e-12);
    check("and from the side",
          solve_scene(pad_of_one_cell + from_the_side)["status"] == "success");
    check("without them it falls over",
          solve_scene(pad_of_one_cell + from_the_side +
                      Values{"Contact law/Law=none"})["status"] == "comes off");
  }



  /// Bonds of @p ratio times the stiffness of the body, beside which the softer
  /// of the two is little more than rounding.
  void
  test_ratio(const unsigned int dim, const Units &units, const double ratio)
  {
    section(
      "Bonds ", ratio, " times as stiff as the body, ", dim, "D, ", units.name);
    const double L = units.length, area = 0.2 * L * (dim == 3 ? 0.1 * L : 1.),
                 E = 70. * units.modulus, H = 0.1 * L, a = ratio * E / H,
                 M = 1e-3 * L, p = 0.9 * a * M;
    const Values scene =
      pad(dim, units, false) + Values{"Contact law/Bond stiffness=" + text(a)};

    const Json result = solve_scene(scene + pulled(dim, text(p)));
    check_held(result, dim, units, a, p);

    // Rounding of the body's stiffness is a part of that of soft bonds.
    const double above = 1. + std::max(1e-5, 1e-15 / ratio);
    const Json   off   = solve_scene(scene + pulled(dim, text(above * a * M)));
    check("above their threshold it comes off",
          off["status"] == "comes off" && off["exit_code"] == 0);
    check_coming_off(off, dim, 1., 0., above * a * M * area);
  }



  /// Soft bonds at the middle node alone, which nothing but the foundation
  /// keeps the body from turning about.
  void
  test_single_bond(const unsigned int dim, const Units &units)
  {
    section("A single soft bond, ", dim, "D, ", units.name);
    // In 3D eight triangles meet in the node, each a quarter of a cell's face.
    const double L = units.length, E = 70. * units.modulus, H = 0.1 * L,
                 a = 1e-11 * E / H, M = 1e-3 * L,
                 area    = 0.2 * L * (dim == 3 ? 0.1 * L : 1.),
                 of_node = dim == 3 ? 2. / 3. * 0.05 * L * 0.05 * L : 0.025 * L;
    const auto near      = [L](const char *coordinate, const double middle) {
      return std::string("abs(") + coordinate + " - " + text(middle * L) +
             ") < " + text(0.01 * L);
    };
    const std::string at_the_node =
      near("x", 0.1) + (dim == 3 ? " && " + near("z", 0.05) : "");
    const auto at = [&](const double part) {
      return solve_scene(pad(dim, units, false) +
                         pulled(dim, text(part * a * M * of_node / area)) +
                         Values{"Contact law/Bond stiffness=if(" + at_the_node +
                                ", " + text(a) + ", 0)"});
    };
    const Json result = at(0.9);
    check("holds the body", result["status"] == "success");
    check("J",
          relative(result["functional"], -0.5 * 0.81 * a * M * M * of_node),
          1e-9);
    check("until it breaks", at(1.00001)["status"] == "comes off");
  }



  /// Of bonds this soft nothing is left in the forces.
  void
  test_softest(const Units &units)
  {
    section("Bonds lost in rounding, ", units.name);
    const double a = 1e-14 * 70. * units.modulus / (0.1 * units.length);
    // Its figure is rounding.
    const std::ostringstream message;
    std::streambuf *const    before = std::cerr.rdbuf(message.rdbuf());

    const Json result = solve_scene(
      pad(2, units, false) + Values{"Contact law/Bond stiffness=" + text(a)} +
      pulled(2, text(0.9e-3 * a * units.length)));
    std::cerr.rdbuf(before);
    check("no success", result["status"] == "not verified");
    check("and why",
          message.str().find("rounding of the displacements") !=
            std::string::npos);
    check("which the exit code says", result["exit_code"] == 3);
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;
  for (const Units &units : systems)
    {
      for (const unsigned int dim : {2, 3})
        {
          test_column(dim, units, true);
          test_column(dim, units, false);
          test_tilting(dim, units);
          test_single_bond(dim, units);
        }
      test_crack(units);
      test_two_nodes(units);
      for (const double ratio : {1e-11, 1e-6, 1e6, 1e10})
        test_ratio(2, units, ratio);
      for (const double ratio : {1e-11, 1e10})
        test_ratio(3, units, ratio);
      test_softest(units);
    }
}
