// SPDX-License-Identifier: LGPL-2.1-or-later
// Supports, gaps and bonds that vary, against closed forms: stretched columns,
// a block that is pressed through a gap, a column on bonds of which it is
// pulled off, halves of symmetric bodies, bonds given in several ways.

#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "../check.h"
#include "solve_scene.h"

using namespace Debond;

namespace
{
  /// A box that is free to deform uniformly: planes of symmetry left, at the
  /// bottom (and at the back), a foundation above it.
  Values
  block(const unsigned int dim, const Units &units)
  {
    const double L = units.length;
    return {"Dimension=" + std::to_string(dim),
            "Mesh/Lengths=" + text(2. * L) + ", " + text(0.5 * L) +
              (dim == 3 ? ", " + text(0.3 * L) : ""),
            dim == 3 ? "Mesh/Cells=4, 2, 1" : "Mesh/Cells=6, 3",
            "Material/Young modulus=" + text(70. * units.modulus),
            "Material/Poisson ratio=0.3",
            "Boundary conditions/Clamped boundaries=",
            "Boundary conditions/Contact boundary=top",
            std::string("Boundary conditions/Roller boundaries=left, bottom") +
              (dim == 3 ? ", back" : ""),
            "Contact law/Tangential displacement=free"};
  }



  void
  test_stretched_column(const unsigned int dim, const Units &units)
  {
    section("Column stretched, ", dim, "D, ", units.name);
    const double depth = dim == 3 ? 0.3 * units.length : 1.,
                 area = 0.5 * units.length * depth, E = 70. * units.modulus,
                 strain = 1e-3;
    for (const std::string method :
         {"majorise minimise", "energy bundle", "euclidean bundle"})
      {
        // The proximal weight of the paper's method is for its own units.
        if (method == "euclidean bundle" && (dim == 3 || units.modulus != 1.))
          continue;
        const Json result = solve_scene(
          block(dim, units) +
          Values{"Boundary conditions/Displacement right=" +
                   text(2. * units.length * strain) +
                   (dim == 3 ? "; free; free" : "; free"),
                 "Contact law/Law=none",
                 "Solver/Method=" + method,
                 "Solver/Euclidean bundle/Maximum iterations=20000",
                 // Contact forces of rounding are no part of the reactions.
                 "Verification/Tolerance=0.01"});
        // The paper's method ends before that.
        const double tolerance = method == "euclidean bundle" ? 1e-5 : 1e-10;
        const double J = 0.5 * E * strain * strain * 2. * units.length * area;
        check(method + ", J",
              relative(result["functional"], J),
              0.1 * tolerance);
        check(method + ", reaction right",
              relative(result["reactions"]["right"][0], E * strain * area),
              tolerance);
        check(method + ", reaction left",
              relative(result["reactions"]["left"][0], -E * strain * area),
              tolerance);
        check(method + ", reaction bottom",
              std::abs(double(result["reactions"]["bottom"][1])) /
                (E * strain * area),
              tolerance);
      }
  }



  /// It widens by more than the gap and then presses on the foundation.
  void
  test_block_through_gap(const unsigned int dim, const Units &units)
  {
    section("Block pressed through a gap, ", dim, "D, ", units.name);
    const double depth = dim == 3 ? 0.3 * units.length : 1.,
                 L = 2. * units.length, H = 0.5 * units.length,
                 E = 70. * units.modulus, nu = 0.3, compression = -1e-3,
                 gap = 0.4 * nu * 1e-3 * H;
    const Values scene =
      block(dim, units) +
      Values{"Boundary conditions/Displacement right=" + text(L * compression) +
               (dim == 3 ? "; free; free" : "; free"),
             "Contact law/Initial gap=" + text(gap),
             "Contact law/Law=none",
             "Solver/Method=majorise minimise"};
    const Json   result  = solve_scene(scene);
    const double modulus = E / (1. - nu * nu), across = gap / H,
                 along       = modulus * (compression + nu * across),
                 transversal = modulus * (across + nu * compression);
    check("J",
          relative(result["functional"],
                   0.5 * (along * compression + transversal * across) * L * H *
                     depth),
          1e-11);
    check("reaction right",
          relative(result["reactions"]["right"][0], along * H * depth),
          1e-10);
    check("force of the foundation",
          relative(result["contact_reaction"][1], transversal * L * depth),
          1e-10);

    // At a fifth of the displacement it does not touch, at twice it does.
    const Json path =
      solve_scene(scene + Values{"Load path/Factors=0.2, 1, 2",
                                 "Load path/Global branch=none"});
    const auto J = [&](const double factor) {
      const double e = factor * compression;
      if (-nu * e * H < gap)
        return 0.5 * E * e * e * L * H * depth;
      return 0.5 *
             (modulus * (e + nu * across) * e +
              modulus * (across + nu * e) * across) *
             L * H * depth;
    };
    for (const Json &row : path["path"])
      check("load path, factor " + row.at("factor").get<std::string>(),
            relative(number(row, "J"), J(number(row, "factor"))),
            1e-10);
  }



  /// A column on bonds below it, the top lifted by d: a spring E/H and a spring
  /// a in series, of which the second one is stretched by the gap already.
  void
  test_column_on_bonds(const unsigned int dim, const Units &units)
  {
    section("Column on bonds, ", dim, "D, ", units.name);
    const double depth = dim == 3 ? 0.3 * units.length : 1.,
                 L = 2. * units.length, H = 0.5 * units.length,
                 E = 70. * units.modulus, a = 0.5 * E / H, M = 1e-3 * H,
                 area = L * depth, gap = 0.25 * M;
    const auto scene = [&](const double lift) {
      return Values{"Dimension=" + std::to_string(dim),
                    "Mesh/Lengths=" + text(L) + ", " + text(H) +
                      (dim == 3 ? ", " + text(0.3 * units.length) : ""),
                    dim == 3 ? "Mesh/Cells=4, 2, 1" : "Mesh/Cells=6, 3",
                    "Material/Young modulus=" + text(E),
                    "Material/Poisson ratio=0.3",
                    "Boundary conditions/Clamped boundaries=",
                    "Boundary conditions/Contact boundary=bottom",
                    std::string("Boundary conditions/Roller boundaries=left") +
                      (dim == 3 ? ", back" : ""),
                    std::string("Boundary conditions/Displacement top=free; ") +
                      text(lift) + (dim == 3 ? "; free" : ""),
                    "Contact law/Tangential displacement=free",
                    "Contact law/Bond stiffness=" + text(a),
                    "Contact law/Bond threshold=" + text(M),
                    "Contact law/Initial gap=" + text(gap),
                    "Solver/Method=majorise minimise"};
    };
    // The bottom's displacement while bonds hold, and J then.
    const auto displacement = [&](const double lift) {
      return (E / H * lift - a * gap) / (a + E / H);
    };
    const auto J_bonded = [&](const double lift) {
      const double u = displacement(lift);
      return 0.5 * area *
             (E / H * (lift - u) * (lift - u) + a * (u + gap) * (u + gap));
    };
    const double J_broken = 0.5 * a * M * M * area;

    const double lift   = 0.5 * M;
    const Json   bonded = solve_scene(
      scene(lift) + Values{"Solver/Search=automatic", "Solver/Prove=true"});
    check("J", relative(bonded["functional"], J_bonded(lift)), 1e-11);
    check("the minimum is proved", bonded["minimum"]["state"] == "global");
    check("reaction of the top",
          relative(bonded["reactions"]["top"][1],
                   a * (displacement(lift) + gap) * area),
          1e-10);
    check("force of the foundation",
          relative(bonded["contact_reaction"][1],
                   -a * (displacement(lift) + gap) * area),
          1e-10);

    // Where both states are minima the search knows which one is lower.
    const double far  = 1.1 * M;
    const Json   torn = solve_scene(
      scene(far) + Values{"Solver/Search=automatic", "Solver/Prove=true"});
    check("J of broken bonds", relative(torn["functional"], J_broken), 1e-11);
    check("which is proved", torn["minimum"]["state"] == "global");

    // Bonds break when they are stretched by M, and all at once.
    const double last = M - gap + a * M / (E / H);
    const Json   path =
      solve_scene(scene(1.) + Values{"Load path/Factors=" + text(0.999 * last) +
                                       ", " + text(1.001 * last),
                                     "Load path/Global branch=none"});
    check("load path before the bonds break",
          relative(number(path["path"][0], "J"), J_bonded(0.999 * last)),
          1e-10);
    check("load path after they broke",
          relative(number(path["path"][1], "J"), J_broken),
          1e-10);
  }



  /// The right half of a symmetric body on a roller is half of it.
  void
  test_half_of_symmetric_body()
  {
    section("Half of a symmetric body");
    for (const double angle : {0., 30., -75.})
      {
        const std::string turned = "Mesh/Rotation=" + text(angle);
        const double      c      = std::cos(angle * std::acos(-1.) / 180.),
                     s           = std::sin(angle * std::acos(-1.) / 180.);
        const std::string along  = '(' + text(c) + "*x+(" + text(s) + ")*y)";
        const std::string load =
          "if(abs(" + along + "-0.2)<0.1000001, 0.69, -0.345)";
        const Values common = {turned,
                               "Loads/Traction top=" + text(-s) + "*" + load +
                                 ";" + text(c) + "*" + load,
                               "Solver/Method=automatic"};
        const Json   whole  = solve_scene(common + Values{"Mesh/Cells=40, 4"});
        const Json   half   = solve_scene(
          common + Values{"Mesh/Cells=20, 4",
                          "Mesh/Lengths=0.2, 0.04",
                          "Boundary conditions/Clamped boundaries=left",
                          "Boundary conditions/Roller boundaries=right"});
        check("turned by " + text(angle) + ", J",
              relative(2. * double(half["functional"]), whole["functional"]),
              1e-9);
      }
  }



  /// Bonds by numbers, by expressions, by strength and fracture energy.
  void
  test_bonds()
  {
    section("Bonds given in several ways");
    const Values loaded = {"Loads/Traction top=0; if(x < 0.2, 0.69, -0.345)",
                           "Solver/Method=automatic"};
    const double J      = solve_scene(loaded)["functional"];
    const std::vector<Values> same = {
      {"Contact law/Bond stiffness=69+0*x"},
      {"Contact law/Bond stiffness=69+0*x",
       "Contact law/Bond threshold=2e-3*(1+0*y)"},
      {"Contact law/Bond threshold=2e-3*(1+0*y)"},
      {"Contact law/Bond strength=0.138",
       "Contact law/Fracture energy=1.38e-4"},
      {"Contact law/Bond strength=0.138+0*x",
       "Contact law/Fracture energy=1.38e-4"},
      {"Contact law/Bond stiffness=69", "Contact law/Bond strength=0.138"},
      {"Contact law/Bond threshold=0.002", "Contact law/Bond strength=0.138"},
      {"Contact law/Bond stiffness=69", "Contact law/Fracture energy=1.38e-4"},
      {"Contact law/Bond threshold=0.002",
       "Contact law/Fracture energy=1.38e-4"}};
    for (const Values &bonds : same)
      {
        std::string name;
        for (const std::string &bond : bonds)
          name += (name.empty() ? "" : ", ") + bond.substr(12);
        check(name,
              relative(solve_scene(loaded + bonds)["functional"], J),
              1e-12);
      }

    // Without bonds anywhere they are none, with a crack they are fewer.
    const double none =
      solve_scene(loaded + Values{"Contact law/Law=none"})["functional"];
    check("no bonds by expression",
          relative(solve_scene(
                     loaded +
                     Values{"Contact law/Bond stiffness=0*x"})["functional"],
                   none),
          1e-12);
    const Json crack = solve_scene(
      loaded + Values{"Contact law/Bond stiffness=if(x < 0.25, 0, 69)",
                      "Solver/Prove=true"});
    const double J_crack = crack["functional"];
    check("a crack lies between", none < J_crack && J_crack < J);
    check("and is proved", crack["minimum"]["state"] == "global");
    check("what is not bonded is free",
          int(crack["bond_states"]["free"]) +
              int(crack["bond_states"]["contact"]) >=
            24);
  }



  /// A column that may widen, lifted by d at its top and pulled by q at its
  /// right side: the springs H/E and 1/a in series bear d + H nu q/E.
  void
  test_factors(const unsigned int dim, const Units &units)
  {
    section("Two lists of factors, ", dim, "D, ", units.name);
    const double L = 2. * units.length, H = 0.5 * units.length,
                 depth = dim == 3 ? 0.3 * units.length : 1.,
                 E = 70. * units.modulus, nu = 0.3, a = 0.5 * E / H,
                 M = 1e-3 * H, d = 1e-3 * H, q = 1e-3 * E;
    const Values scene = {
      "Dimension=" + std::to_string(dim),
      "Mesh/Lengths=" + text(L) + ", " + text(H) +
        (dim == 3 ? ", " + text(depth) : ""),
      dim == 3 ? "Mesh/Cells=4, 2, 1" : "Mesh/Cells=6, 3",
      "Material/Young modulus=" + text(E),
      "Material/Poisson ratio=" + text(nu),
      "Boundary conditions/Clamped boundaries=",
      "Boundary conditions/Contact boundary=bottom",
      std::string("Boundary conditions/Roller boundaries=") +
        (dim == 3 ? "left, back" : "left"),
      std::string("Boundary conditions/Displacement top=free; ") + text(d) +
        (dim == 3 ? "; free" : ""),
      "Loads/Traction right=" + text(q) + (dim == 3 ? "; 0; 0" : "; 0"),
      "Contact law/Tangential displacement=free",
      "Contact law/Bond stiffness=" + text(a),
      "Contact law/Bond threshold=" + text(M),
      "Parts/half=bottom: x > " + text(0.5 * L),
      "Probes/tip=" + text(L) + ", " + text(H) +
        (dim == 3 ? ", " + text(depth) : ""),
      "Probes/wall=mean right",
      "Probes/all of it=mean half",
      "Probes/glue=force bottom",
      "Output/Contact profile=false"};

    /// The largest errors of a path in which bonds hold where @p bonded says
    /// so.
    const auto check_path = [&](const std::string               &name,
                                const Values                    &settings,
                                const std::vector<double>       &loads,
                                const std::vector<double>       &displacements,
                                const std::vector<unsigned int> &bonded,
                                const double                     dissipated) {
      const Json path  = solve_scene(scene + settings);
      bool       same  = path["path"].size() == bonded.size();
      double     force = 0., displacement = 0., energy = 0.;
      for (unsigned int k = 0; same && k < bonded.size(); ++k)
        {
          const Json  &row  = path["path"][k];
          const double lift = displacements[k] * d, pull = loads[k] * q;
          const double sigma =
            bonded[k] == 1 ? (lift + H * nu * pull / E) / (1. / a + H / E) : 0.;
          const double area = L * depth, wall = L * (pull - nu * sigma) / E,
                       opening = lift - H * (sigma - nu * pull) / E;
          const auto error     = [&row](const std::string &column,
                                    const double       value,
                                    const double       scale) {
            return std::abs(number(row, column) - value) / scale;
          };
          force =
            std::max({force,
                      error("reaction_top_y", sigma * area, E * area),
                      error("probe_glue_y", -sigma * area, E * area),
                      error("contact_reaction_y", -sigma * area, E * area)});
          displacement =
            std::max({displacement,
                      error("mean_top_y", lift, d),
                      error("probe_tip_y", lift, d),
                      error("mean_right_x", wall, d),
                      error("probe_wall_x", wall, d),
                      error("probe_tip_x", wall, d),
                      error("mean_half_y", opening, d),
                      error("probe_all_of_it_y", opening, d),
                      error("broken_zone", bonded[k] == 1 ? 0. : area, area)});
          const double strain_energy =
            0.5 * (sigma * sigma + pull * pull - 2. * nu * sigma * pull) / E *
            area * H;
          energy = std::max(
            {energy,
             error("elastic_energy", strain_energy, E * d * d * area / H),
             error("dissipated_energy",
                   bonded[k] == 1 ? 0. : dissipated * area,
                   a * M * M * area)});
          same = same && number(row, "factor") == loads[k] &&
                 number(row, "displacement_factor") == displacements[k];
        }
      section(name);
      check("factors", same);
      check("forces", force, 1e-13);
      check("displacements", displacement, 1e-11);
      check("energies", energy, 1e-11);
      return path;
    };

    // Bonds break at d = M (1 + a H/E) = 1.5 d without q; q opens by 0.3 d.
    const Json   path  = check_path("together",
                                 {"Load path/Factors=0:0.25:1"},
                                 {0., 0.25, 0.5, 0.75, 1.},
                                 {0., 0.25, 0.5, 0.75, 1.},
                                 {1, 1, 1, 1, 1},
                                 0.);
    const double sigma = (d + H * nu * q / E) / (1. / a + H / E);
    check("summary",
          std::max(relative(path["probes"]["tip"][0], L * (q - nu * sigma) / E),
                   relative(path["mean_displacements"]["top"][1], d)),
          1e-11);
    check_path("each its own",
               {"Load path/Factors=0, 0, 1, 1, 0.5",
                "Load path/Displacement factors=0, 1, 1, 0.5, 0.5"},
               {0., 0., 1., 1., 0.5},
               {0., 1., 1., 0.5, 0.5},
               {1, 1, 1, 1, 1},
               0.);
    check_path("loads as they are, bonds heal",
               {"Load path/Displacement factors=0, 1, 2, 1, 0.5"},
               {1., 1., 1., 1., 1.},
               {0., 1., 2., 1., 0.5},
               {1, 1, 0, 0, 1},
               0.);
    check_path("or not",
               {"Load path/Displacement factors=0, 1, 2, 1, 0.5, 0",
                "Load path/Bonds heal=false"},
               {1., 1., 1., 1., 1., 1.},
               {0., 1., 2., 1., 0.5, 0.},
               {1, 1, 0, 0, 0, 0},
               0.5 * a * M * M);
    // What is dead has no factor.
    const Json dead  = solve_scene(scene + Values{"Load path/Factors=0, 0.5, 1",
                                                 "Load path/Dead loads=right"});
    double     error = 0.;
    for (const Json &row : dead["path"])
      raise(error,
            std::abs(number(row, "reaction_top_y") /
                       ((number(row, "factor") * d + H * nu * q / E) /
                        (1. / a + H / E) * L * depth) -
                     1.));
    check("dead load", error, 1e-11);
  }



  /// At corners and edges of several sides the foundation alone holds the body.
  void
  test_corner_of_foundations(const unsigned int dim)
  {
    section("Corner of contact sides, ", dim, "D");
    const std::string depth  = dim == 3 ? ", 1" : "";
    const Json        result = solve_scene(
      {"Dimension=" + std::to_string(dim),
              "Mesh/Lengths=2, 1" + depth,
              "Mesh/Cells=2, 1" + depth,
              "Material/Young modulus=1",
              "Boundary conditions/Clamped boundaries=left",
              std::string("Boundary conditions/Contact boundary=bottom, ") +
                (dim == 3 ? "right, back" : "right"),
              "Contact law/Bond stiffness=1",
              "Contact law/Bond threshold=1",
              std::string("Loads/Traction top=0; 0.01") + (dim == 3 ? "; 0" : "")});
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double left       = result["reactions"]["left"][d],
                     supports   = result["clamped_reaction"][d],
                     foundation = result["contact_reaction"][d],
                     applied    = result["applied_force"][d];
        check("force of supports", std::abs(supports - left) / 0.02, 1e-14);
        check("force of the foundation",
              std::abs(applied + left + foundation) / 0.02,
              1e-14);
      }
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;
  for (const Units &units : systems)
    for (const unsigned int dim : {2, 3})
      {
        test_stretched_column(dim, units);
        test_block_through_gap(dim, units);
        test_column_on_bonds(dim, units);
        test_factors(dim, units);
      }
  test_half_of_symmetric_body();
  test_bonds();
  for (const unsigned int dim : {2, 3})
    test_corner_of_foundations(dim);
}
