// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The estimated error of J beside errors that are known otherwise: states that
// P1 elements reproduce, displacements with closed forms (the error of J is
// half of the energy of what is missing), and the paper's benchmark beside its
// J on fine meshes. And meshes that are refined: J falls, targets are met or
// not met with a word.

#include <debond/check/displacement_error.h>
#include <debond/input/expression.h>
#include <debond/program/run.h>
#include <debond/solve/adaptive_loop.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>

#include "../check.h"
#include "solved.h"

using namespace Debond;

namespace
{
  using Json = nlohmann::json;



  /// A scene, its solution and the estimate.
  template <int dim>
  struct Solved
  {
    explicit Solved(const Parameters &p)
      : parameters(p)
      , scene(parameters)
    {
      result   = solved(parameters, scene);
      estimate = estimate_error<dim>({scene.problem(),
                                      scene.adhesion(),
                                      scene.conditions(),
                                      scene.supports(),
                                      scene.loads()},
                                     result.u,
                                     result.functional);
    }

    explicit Solved(const Values &values)
      : Solved(parameters_of(values))
    {}

    /// By the error for a displacement in closed form: half of the energy of
    /// what is missing.
    double
    ratio(const std::string &exact) const
    {
      const DisplacementError error =
        displacement_error(scene.problem(),
                           result.u,
                           *make_function<dim>(exact,
                                               parameters.loads.constants));
      return estimate.functional /
             (error.energy_norm * error.energy_norm * error.exact_energy);
    }

    const Parameters parameters;
    const Scene<dim> scene;
    SolveResult      result;
    ErrorEstimate    estimate;
  };



  void
  check_ratio(const std::string &name,
              const double       ratio,
              const double       factor = 1.25)
  {
    check(name + ", off by a factor of", std::max(ratio, 1. / ratio), factor);
  }



  const Values no_contact = {"Contact law/Law=none",
                             "Boundary conditions/Contact boundary="};

  /// Loads and supports of many kinds, and one strain everywhere, or one in
  /// each layer.
  void
  check_constant_strain()
  {
    const auto check_exact = [](const std::string &name, const auto &solved) {
      check(name + ", estimate", solved.estimate.relative(), 1e-20);
    };
    const Values pulled =
      with(no_contact,
           {"Mesh/Cells=8, 4",
            "Boundary conditions/Clamped boundaries=",
            "Boundary conditions/Roller boundaries=left, bottom",
            "Loads/Traction top=",
            "Loads/Traction right=3; 0"});
    check_exact("pulled by a traction", Solved<2>(pulled));
    check_exact("pulled by a displacement",
                Solved<2>(with(pulled,
                               {"Loads/Traction right=",
                                "Boundary conditions/Displacement right="
                                "0.001; free"})));
    check_exact("layers, pulled by a displacement, heated",
                Solved<2>(with(pulled,
                               {"Parts/upper=y > 0.02",
                                "Material/Young modulus upper=7",
                                "Material/Poisson ratio=0",
                                "Material/Thermal expansion=1e-5",
                                "Loads/Temperature change=20",
                                "Loads/Traction right=",
                                "Boundary conditions/Displacement right="
                                "0.001; free"})));
    const Values on_foundation = {"Boundary conditions/Clamped boundaries=",
                                  "Boundary conditions/Roller boundaries=left",
                                  "Contact law/Tangential displacement=free"};
    const auto   moved         = [&](const std::string &top) {
      return with(on_foundation,
                  {"Loads/Traction top=",
                   "Boundary conditions/Displacement top=free; " + top});
    };
    check_exact("pressed on the foundation", Solved<2>(moved("-0.0001")));
    check_exact("pulled on its bonds", Solved<2>(moved("0.001")));
    check_exact("torn off its bonds", Solved<2>(moved("0.01")));
    check_exact("pressed through a gap",
                Solved<2>(
                  with(moved("-0.0003"), {"Contact law/Initial gap=0.0002"})));
    check_exact("pulled on bonds of half the stiffness",
                Solved<2>(with(moved("0.001"),
                               {"Contact law/Bond stiffness=34.5 + 0 * x"})));
    check_exact("3D",
                Solved<3>(with(
                  no_contact,
                  {"Dimension=3",
                   "Mesh/Lengths=1, 1, 2",
                   "Mesh/Cells=2, 2, 3",
                   "Boundary conditions/Clamped boundaries=",
                   "Boundary conditions/Roller boundaries=left, bottom, back",
                   "Loads/Traction top=",
                   "Loads/Traction front=0; 0; 2"})));
  }



  void
  check_closed_forms()
  {
    const Values square = with(no_contact,
                               {"Mesh/Lengths=1, 1",
                                "Mesh/Cells=6, 6",
                                "Material/Young modulus=2",
                                "Material/Poisson ratio=0",
                                "Boundary conditions/Clamped boundaries=bottom",
                                "Loads/Traction top="});
    check_ratio("own weight",
                Solved<2>(with(square, {"Loads/Body force=0; -3"}))
                  .ratio("0; -1.5*(y - y^2/2)"));
    check_ratio("sheared by a body force",
                Solved<2>(
                  with(square,
                       {"Loads/Body force=1; 0",
                        "Boundary conditions/Displacement left=free; 0",
                        "Boundary conditions/Displacement right=free; 0"}))
                  .ratio("y - y^2/2; 0"));
    check_ratio("heated unevenly between walls",
                Solved<2>(
                  with(square,
                       {"Material/Thermal expansion=1e-3",
                        "Boundary conditions/Clamped boundaries=",
                        "Boundary conditions/Displacement left=0; 0",
                        "Boundary conditions/Displacement right=0; 0",
                        "Boundary conditions/Displacement bottom=free; 0",
                        "Boundary conditions/Displacement top=free; 0",
                        "Loads/Temperature change=x"}))
                  .ratio("1e-3*(x^2 - x)/2; 0"));
    for (const std::string name :
         {"smooth-2d", "incompressible-2d", "smooth-3d", "incompressible-3d"})
      {
        const Parameters p = parameters_of_file(
          SOURCE_DIR "/../../prm/verification/" + name + ".prm");
        const std::string &exact = p.verification.exact_displacement;
        check_ratio(name,
                    p.dimension == 2 ? Solved<2>(p).ratio(exact) :
                                       Solved<3>(p).ratio(exact),
                    1.8);
      }
  }



  /// By what J falls on finer meshes.
  double
  ratio_on_finer_meshes(const Values &values)
  {
    const auto levels =
      refined<2>(
        parameters_of(with(values, {"Accuracy/Maximum unknowns=8000"})))
        .levels;
    const double J = levels.front().functional;
    return levels.front().estimated_error * std::abs(J) /
           (J - levels.back().functional);
  }



  /// Layers of different stiffness, on stretched cells and on stiff bonds.
  void
  check_layers()
  {
    const Values beam = with(no_contact,
                             {"Mesh/Lengths=6, 0.5",
                              "Mesh/Cells=24, 8",
                              "Boundary conditions/Clamped boundaries=left",
                              "Parts/upper=y > 0.125",
                              "Material/Young modulus=40",
                              "Material/Young modulus upper=1",
                              "Material/Poisson ratio=0",
                              "Loads/Traction top="});
    // The neutral axis is at 0.4296875 / 5.375.
    check_ratio("bending of two layers, cells of 4:1",
                Solved<2>(
                  with(beam,
                       {"Loads/Traction right=if(y < 0.125, -0.4, -0.01) * "
                        "(y - 0.4296875 / 5.375); 0"}))
                  .ratio("-0.01*x*(y - 0.4296875/5.375); 0.005*x^2"),
                1.6);
    check_ratio("shear of two layers, quadratic, cells of 4:1",
                ratio_on_finer_meshes(with(beam,
                                           {"Mesh/Degree=2",
                                            "Mesh/Cells=12, 4",
                                            "Material/Poisson ratio=0.3",
                                            "Contact law/Quadrature=gauss 8",
                                            "Loads/Traction right=0; 0.001"})),
                1.6);
    const Values soft = {"Mesh/Lengths=1, 1",
                         "Mesh/Cells=4, 4",
                         "Parts/soft=x > 0.5",
                         "Material/Young modulus=1",
                         "Material/Young modulus soft=0.002",
                         "Material/Poisson ratio=0.2",
                         "Contact law/Bond stiffness=5",
                         "Contact law/Bond threshold=1",
                         "Contact law/Quadrature=gauss 8",
                         "Loads/Traction top=",
                         "Loads/Traction bottom=0; 0.000001"};
    check_ratio("soft layer on stiff bonds", ratio_on_finer_meshes(soft), 1.6);
    // Without what bonds resist by more than 10.
    check_ratio("the same, quadratic",
                ratio_on_finer_meshes(with(soft, {"Mesh/Degree=2"})),
                3.);
  }



  /// The paper's benchmark, in three systems of units and turned.
  void
  check_benchmark()
  {
    // On refined meshes by two programs, and by degree 2.
    constexpr double J     = -5.91510e-04;
    const Values    turned = {"Loads/Traction top=0; if(x < 0.2, 0.69, -0.345)",
                              "Contact law/Quadrature=gauss 8"};
    const Solved<2> benchmark(turned);
    check_ratio("benchmark",
                benchmark.estimate.functional /
                  (benchmark.result.functional - J),
                1.1);
    const Solved<2> finer(with(turned, {"Mesh/Cells=80, 8"}));
    check_ratio("80x8",
                finer.estimate.functional / (finer.result.functional - J),
                1.1);
    double sum = 0.;
    for (const double part : benchmark.estimate.cells)
      sum += part;
    check("parts add up",
          std::abs(sum / benchmark.estimate.functional - 1.),
          1e-12);
    const Solved<2> pascal(Values{"Material/Young modulus=69e9",
                                  "Contact law/Bond stiffness=69e9",
                                  "Loads/Traction top="
                                  "0; if(x < 0.2, 0.69e9, -0.345e9)",
                                  "Contact law/Quadrature=gauss 8"});
    check("in Pa, relative change of the estimate",
          std::abs(pascal.estimate.relative() / benchmark.estimate.relative() -
                   1.),
          1e-9);
  }



  /// J on each mesh, which exact quadrature makes a minimum over more and more
  /// displacements.
  void
  check_refinement(const std::string &name, const Values &values)
  {
    const Parameters parameters    = parameters_of(values);
    const auto [levels, shortfall] = [&]() {
      const auto outcome = [](const auto &refined) {
        return std::make_pair(refined.levels, refined.result.shortfall);
      };
      return parameters.dimension == 2 ? outcome(refined<2>(parameters)) :
                                         outcome(refined<3>(parameters));
    }();

    bool falls = true, is_estimated = true, grows = true;
    for (unsigned int k = 1; k < levels.size(); ++k)
      {
        falls        = falls && levels[k].functional < levels[k - 1].functional;
        is_estimated = is_estimated && levels[k].estimated_error <
                                         levels[k - 1].estimated_error;
        grows = grows && levels[k].unknowns > 1.2 * levels[k - 1].unknowns &&
                levels[k].unknowns < 6. * levels[k - 1].unknowns;
      }
    section(name);
    check("  several meshes", levels.size() >= 3);
    check("  J falls on each", falls);
    check("  so does the estimate", is_estimated);
    check("  meshes grow, and not too much at once", grows);
    check("  the last one is made for the target",
          levels.back().estimated_error > 0.4 * parameters.accuracy.target);
    check("  nothing is short", shortfall.empty());
  }



  void
  check_loop()
  {
    const Values base = {"Loads/Traction top=0; if(x < 0.2, 0.69, -0.345)",
                         "Contact law/Quadrature=gauss 8",
                         "Accuracy/Target=3e-3"};
    check_refinement("benchmark", base);
    check_refinement("energy bundle",
                     with(base, {"Solver/Method=energy bundle"}));
    check_refinement("free to slide, a = 690",
                     with(base,
                          {"Contact law/Bond stiffness=690",
                           "Contact law/Tangential displacement=free",
                           "Accuracy/Target=1e-2"}));
    check_refinement("bar in 3D",
                     {"Dimension=3",
                      "Mesh/Lengths=0.4, 0.04, 0.04",
                      "Mesh/Cells=10, 1, 1",
                      "Loads/Traction top=0; if(x < 0.2, 0.69, -0.345); 0",
                      "Contact law/Quadrature=gauss 7",
                      "Accuracy/Maximum unknowns=6000"});
  }



  /// Of a run of the whole program.
  void
  check_run(const Values      &values,
            const ExitCode     expected,
            const std::string &status)
  {
    std::ostringstream log, errors;
    auto *const        before = std::cerr.rdbuf(errors.rdbuf());
    const ExitCode     code   = run<2>(parameters_of(values), log, false);
    std::cerr.rdbuf(before);
    std::ifstream file("results/summary.json");
    const Json    summary = Json::parse(file);
    check("exit code", code == expected);
    check("status " + status, summary["status"] == status);
    check("numbers of the last mesh",
          summary["degrees_of_freedom"] ==
              summary["levels"].back()["unknowns"] &&
            summary["functional"] == summary["levels"].back()["functional"] &&
            summary["estimated_error"] ==
              summary["levels"].back()["estimated_error"]);
    const std::string message = summary["message"];
    std::cout << message << std::endl;
  }
} // namespace



int
main(int argc, char **)
{
  print_figures = argc > 1;
  check_constant_strain();
  check_closed_forms();
  check_layers();
  check_benchmark();
  check_loop();

  const Values small = {"Mesh/Cells=20, 2",
                        "Loads/Traction top=0; if(x < 0.2, 0.69, -0.345)",
                        "Output/Directory=results",
                        "Output/Machine details=false"};
  check_run(with(small, {"Accuracy/Target=2e-2"}),
            ExitCode::success,
            "success");
  check_run(with(small,
                 {"Accuracy/Target=1e-3", "Accuracy/Maximum unknowns=1000"}),
            ExitCode::not_converged,
            "not accurate enough");
}
