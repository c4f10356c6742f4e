// SPDX-License-Identifier: LGPL-2.1-or-later
// The condensed methods on whole scenes: the same steps in all units, and
// stiff, weak, tough and brittle bonds. The values of J on the mesh 40x4 with
// a = 69, 690 and 6900 are those of an independent code (with a = 690 and 6900
// of the intact state, a local minimum); the two methods here differ in all but
// the condensation, and both are checked against the contact law.

#include <debond/check/verification.h>

#include <cmath>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "../check.h"
#include "solved.h"

using namespace Debond;

namespace
{
  struct Run
  {
    SolveResult     result;
    Verification<2> verification;
  };



  /// The paper's benchmark with other entries.
  Run
  run(const Values &assignments)
  {
    const Parameters parameters = parameters_of(
      Values{"Loads/Traction top=0; if(x < 0.2, 0.69, -0.345)"} + assignments);
    const Scene<2> scene = scene_of<2>(parameters);
    Run            run;
    run.result = solved(parameters, scene);
    run.verification =
      verify(scene.problem(), scene.adhesion(), scene.law(), run.result.u);
    return run;
  }



  void
  test_units(const std::string &method)
  {
    // E, a, M, loads in GPa and m, Pa and m, MPa and mm; energies per
    // thickness are GN, N, N.
    const Values gpa = {"Solver/Method=" + method};
    const Values pa =
      with(gpa,
           {"Material/Young modulus=69e9",
            "Contact law/Bond stiffness=69e9",
            "Loads/Traction top=0; if(x < 0.2, 0.69e9, -0.345e9)"});
    const Values mpa = with(gpa,
                            {"Mesh/Lengths=400, 40",
                             "Material/Young modulus=69e3",
                             "Contact law/Bond stiffness=69",
                             "Contact law/Bond threshold=2",
                             "Loads/Traction top=0; if(x < 200, 690, -345)"});

    const Run  reference = run(gpa);
    const auto history   = [](const Run &run) {
      std::vector<double> values;
      for (const auto &step : run.result.bundle_history)
        values.push_back(step.functional);
      for (const auto &step : run.result.majorise_history)
        values.push_back(step.functional);
      return values;
    };
    const std::vector<double> expected = history(reference);
    for (const auto &[name, assignments, unit] :
         {std::make_tuple("Pa and m", pa, 1e9),
          std::make_tuple("MPa and mm", mpa, 1e9)})
      {
        const std::vector<double> values = history(run(assignments));
        double                    error  = 0.;
        for (unsigned int k = 0; k < std::min(values.size(), expected.size());
             ++k)
          raise(error, std::abs(values[k] / (unit * expected[k]) - 1.));
        section(method, " in ", name);
        check("same number of steps", values.size() == expected.size());
        check("same values to 1e-10", error, 1e-10);
      }
  }



  void
  test_hard_laws(const std::string &cells)
  {
    for (const auto &[a, M] : {std::make_pair("69", "0.002"),
                               {"6.9", "0.002"},
                               {"690", "0.002"},
                               {"6900", "0.002"},
                               {"1e5", "2e-4"},
                               {"69", "2e-4"},
                               {"69", "0.01"}})
      for (const std::string method : {"majorise minimise", "energy bundle"})
        {
          const Run r = run({"Solver/Method=" + method,
                             "Mesh/Cells=" + cells,
                             std::string("Contact law/Bond stiffness=") + a,
                             std::string("Contact law/Bond threshold=") + M});
          section(cells, ", a = ", a, ", M = ", M, ", ", method);
          check("success", r.result.status == SolverStatus::success);
          check("iterations", r.result.iterations, 40);
          check("law", r.verification.law_violation, 1e-9);
        }
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;
  test_units("majorise minimise");
  test_units("energy bundle");
  test_hard_laws("40, 4");
  test_hard_laws("160, 16");
}
