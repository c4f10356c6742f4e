// SPDX-License-Identifier: LGPL-2.1-or-later
// Scenes with the stepped law: all methods against enumeration of the branches
// of all contact nodes, search and proof, the load path with its states.

#include <deal.II/base/mpi.h>

#include <debond/contact/laws/stepped.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/solve/load_path.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <sstream>

#include "../check.h"
#include "../optimization/enumeration.h"
#include "solved.h"

using namespace Debond;

namespace
{
  constexpr double tolerance = 1e-9;



  /// 7 contact nodes, which have 3^7 states. At half the load the least J has
  /// bonds of all kinds.
  const Values small = {"Mesh/Cells=8, 1",
                        "Loads/Traction top=0; if(x < 0.2, 0.69, -0.345)",
                        "Contact law/Law=stepped",
                        "Contact law/Stepped/Stiffnesses=690, 100",
                        "Contact law/Stepped/Thresholds=0.001, 0.003"};



  using Place = std::function<double(const dealii::Point<2> &)>;



  double
  as_it_is(const dealii::Point<2> & /*point*/)
  {
    return 1.;
  }



  /// The least J of a scene with nodal quadrature, whose stiffnesses @p times
  /// multiplies.
  double
  least_functional(const Scene<2> &scene,
                   const double    factor,
                   const Place    &times = as_it_is)
  {
    const Condensation condensed =
      condense_to_contact(scene.problem(), scene.adhesion())
        .with_load(scene.problem().load(factor));
    const unsigned int n = static_cast<unsigned int>(condensed.load().size());
    LongMatrix         S(n, n);
    LongVector         g(n), where(n);
    std::vector<BranchList> branches(n);
    for (unsigned int i = 0; i < n; ++i)
      {
        g(i) = condensed.load()(i);
        for (unsigned int j = 0; j < n; ++j)
          S(i, j) = condensed.schur_complement()(i, j);
        branches[i] = stepped_law({690., 100.}, {0.001, 0.003}).branches;
        const auto &node =
          scene.problem().unknowns().contact().boundary().nodes[i];
        const double measure = node.measure * times(node.position);
        for (ConvexBranch &branch : branches[i])
          {
            branch.curvature *= measure;
            branch.constant *= measure;
          }
      }
    return static_cast<double>(enumerated_minimum(S, g, branches, where)) +
           condensed.energy_at_zero();
  }



  SolveResult
  run(const Values &scene, const Values &others)
  {
    const Parameters parameters = parameters_of(scene + others);
    return solved(parameters, scene_of<2>(parameters));
  }



  void
  test_methods()
  {
    const Scene<2> scene(parameters_of(small));
    const double   least = least_functional(scene, 1.);
    for (const Values &settings : std::vector<Values>{
           {"Solver/Method=automatic"},
           {"Solver/Prove=true"},
           {"Solver/Search=full"},
           {"Solver/Method=energy bundle", "Solver/Prove=true"},
           {"Solver/Linear solver=multigrid"},
           {"Solver/Method=euclidean bundle",
            "Solver/Euclidean bundle/Maximum iterations=20000"}})
      {
        // The last two follow the intact state.
        const bool is_least =
          settings.back().find("=20000") == std::string::npos &&
          settings.back().find("multigrid") == std::string::npos;
        const SolveResult result =
          run(small + Values{"Solver/Method=majorise minimise"}, settings);
        section(settings.back());
        check("success", result.status == SolverStatus::success);
        check("word",
              to_string(result.minimum.kind) ==
                std::string(is_least ? "global" : "local minimum"));
        check("the least J",
              is_least ? std::abs(result.functional / least - 1.) < tolerance :
                         result.functional > least);
      }
  }



  /// With other quadratures than nodal there is no proof, but all methods find
  /// stationary points, and the same one.
  void
  test_quadratures()
  {
    for (const std::string rule : {"midpoint", "gauss 3"})
      {
        const SolveResult one = run(small, {"Contact law/Quadrature=" + rule});
        const SolveResult other = run(small,
                                      {"Contact law/Quadrature=" + rule,
                                       "Solver/Method=energy bundle",
                                       "Solver/Search=full"});
        section(rule);
        check("two methods with the same J",
              std::abs(one.functional / other.functional - 1.),
              tolerance);
      }
  }



  void
  test_one_step()
  {
    const std::vector<std::string> scene    = {small[0], small[1]};
    const SolveResult              one_step = run(scene,
                                     {"Contact law/Law=stepped",
                                                   "Contact law/Stepped/Stiffnesses=690",
                                                   "Contact law/Stepped/Thresholds=0.002"});
    const SolveResult winkler = run(scene, {"Contact law/Bond stiffness=690"});
    check("one step is winkler",
          one_step.functional == winkler.functional && one_step.u == winkler.u);
  }



  /// Bonds by place: a crack, and bonds that get stiffer.
  void
  test_places()
  {
    const auto crack = [](const dealii::Point<2> &point) {
      return point[0] < 0.13 ? 0. : 1.;
    };
    const auto rising = [](const dealii::Point<2> &point) {
      return 0.3 + 6. * point[0];
    };
    for (const auto &[text, place] :
         {std::pair<std::string, Place>("if(x < 0.13, 0, 1)", crack),
          std::pair<std::string, Place>("0.3 + 6*x", rising)})
      {
        const Values scene =
          small + Values{"Contact law/Stepped/Factor=" + text};
        const Scene<2> nodal(parameters_of(scene));
        const double   least = least_functional(nodal, 1., place);
        section("times ", text);
        for (const std::vector<std::string> &settings :
             std::vector<std::vector<std::string>>{
               {"Solver/Method=automatic"},
               {"Solver/Method=energy bundle", "Solver/Prove=true"},
               {"Solver/Method=majorise minimise", "Solver/Search=full"}})
          {
            const SolveResult result = run(scene, settings);
            check(settings.back(),
                  std::abs(result.functional / least - 1.),
                  tolerance);
          }
      }

    // A crack that is no part of the contact boundary, and does not close. Its
    // end is between faces, and so are the points of the rules.
    const Values cracked = {"Mesh/Cells=16, 2",
                            "Loads/Traction top=0; 0.35",
                            "Contact law/Law=stepped",
                            "Contact law/Tangential displacement=free",
                            "Contact law/Stepped/Stiffnesses=210, 40",
                            "Contact law/Stepped/Thresholds=0.001, 0.004"};
    for (const std::string rule : {"midpoint", "gauss 3"})
      {
        const Values with_rule =
          cracked + Values{"Contact law/Quadrature=" + rule};
        const SolveResult one =
          run(with_rule, {"Contact law/Stepped/Factor=if(x < 0.15, 0, 1)"});
        const SolveResult other = run(with_rule,
                                      {"Parts/glued=bottom: x > 0.15",
                                       "Boundary conditions/Contact "
                                       "boundary=glued"});
        check(rule + ", a crack beside a boundary without contact",
              std::abs(one.functional / other.functional - 1.),
              tolerance);
      }

    // A body that hardly deforms, moved off by d: J is the integral of factor
    // times j_1, whose energies are e_2 = 150/2 0.001^2 and more.
    for (const auto &[d, energy] :
         {std::make_pair(0.0008, 200. / 2. * 0.0008 * 0.0008),
          std::make_pair(0.002,
                         150. / 2. * 0.001 * 0.001 + 50. / 2. * 0.002 * 0.002),
          std::make_pair(0.005,
                         150. / 2. * 0.001 * 0.001 + 50. / 2. * 0.003 * 0.003)})
      {
        const SolveResult result =
          run({"Mesh/Cells=8, 1",
               "Material/Young modulus=1e7",
               "Boundary conditions/Clamped boundaries=",
               "Boundary conditions/Displacement top=0; " + std::to_string(d),
               "Contact law/Law=stepped",
               "Contact law/Stepped/Stiffnesses=200, 50",
               "Contact law/Stepped/Thresholds=0.001, 0.003"},
              {"Contact law/Stepped/Factor=5*x"});
        // The mean of 5 x over 0.4 is 1.
        check("moved off, the integral of the law",
              std::abs(result.functional / (0.4 * energy) - 1.),
              1e-5);
      }
  }



  void
  test_load_path()
  {
    const Parameters parameters =
      parameters_of(with(small,
                         {"Load path/Factors=0:0.1:2, 2:-0.1:0.5",
                          "Load path/Global branch=prove"}));
    const Scene<2>        scene = scene_of<2>(parameters);
    const FollowedPath<2> path  = follow_load_path<2>(
      parameters.load_path,
      settings_of(parameters, scene),
      scene,
      {},
      [](const auto &...) {},
      nullptr);
    const auto        &steps  = path.steps;
    const SolveResult &result = path.result;

    double       gap = 0., sum = 0.;
    bool         all_global = true, partly_broken = false, named = true;
    unsigned int with_change = 0;
    for (const LoadPathStep<2> &step : steps)
      {
        if (step.factor > 0.)
          {
            const double least = least_functional(scene, step.factor);
            raise(gap, std::abs(step.global->functional / least - 1.));
            all_global = all_global && step.global->minimum == "global";
          }
        for (const auto &state : {step.state, *step.global})
          {
            named = named && state.other_parts.size() == 1 &&
                    state.other_parts[0].first == "partly_broken_1";
            const double other = state.other_parts[0].second;
            raise(sum,
                  std::abs(state.contact_part + state.bonded_part +
                           state.broken_part + other - 1.));
            partly_broken = partly_broken || other > 0.;
          }
        with_change += step.change_factor.has_value();
      }
    section("load path");
    check("success", result.status == SolverStatus::success);
    check("the least J on the global branch", gap, tolerance);
    check("called global", all_global);
    check("parts by name", named);
    check("of all nodes", sum, 1e-12);
    check("partly broken ones among them", partly_broken);
    check("changes of bonds", with_change > 1);
  }
} // namespace



int
main(int argc, char *argv[])
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  print_figures = argc > 1;
  test_methods();
  test_quadratures();
  test_one_step();
  test_places();
  test_load_path();
}
