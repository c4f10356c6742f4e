// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Pressures and total forces of a scene: resultants, dead loads, several loads
// on one boundary, and what is refused.

#include <deal.II/base/tensor.h>

#include <cmath>
#include <iostream>
#include <stdexcept>

#include "../check.h"
#include "solved.h"

using namespace Debond;
using dealii::Tensor;

namespace
{
  const Values bar = {"Mesh/Cells=20, 4"};

  Tensor<1, 2>
  load(const Values &values, const LoadFactors factors = 1.)
  {
    const Scene<2> scene(parameters_of(with(bar, values)));
    return scene.problem().fields().total_load(factors);
  }

  void
  check_load(const std::string  &name,
             const Values       &values,
             const Tensor<1, 2> &expected,
             const LoadFactors   factors = 1.)
  {
    check(name, (load(values, factors) - expected).norm(), 1e-14);
  }

  void
  refused(const Values &values)
  {
    try
      {
        load(values);
        std::cout << "NO ERROR" << std::endl;
      }
    catch (const std::exception &error)
      {
        std::cout << error.what() << std::endl;
      }
  }
} // namespace



int
main(int argc, char **)
{
  print_figures = argc > 1;
  const Tensor<1, 2> force({0.3, -0.7});
  check_load("a total force", {"Loads/Force top=0.3; -0.7"}, force);
  check_load("a part's",
             {"Parts/patch=top: x > 0.1 && x < 0.3",
              "Loads/Force patch=0.3; -0.7"},
             force);
  // 0.4 long, 0.04 high.
  check_load("a pressure presses",
             {"Loads/Pressure top=2"},
             Tensor<1, 2>({0., -0.8}));
  check_load("one that varies",
             {"Loads/Pressure right=y"},
             Tensor<1, 2>({-0.0008, 0.}));
  check_load("all of a boundary add up",
             {"Loads/Pressure top=2",
              "Loads/Force top=0.3; -0.7",
              "Loads/Traction top=1; 1"},
             force + Tensor<1, 2>({0.4, 0.4 - 0.8}));
  check_load("dead ones have no factor",
             {"Loads/Force top=0.3; -0.7",
              "Loads/Pressure right=y",
              "Load path/Factors=0, 1, 2",
              "Load path/Dead loads=top"},
             force + 2. * Tensor<1, 2>({-0.0008, 0.}),
             2.);
  refused({"Loads/Force top=x; 0"});
  refused({"Loads/Force top=1"});
  refused({"Loads/Pressure top=1; 0"});
  refused({"Loads/Pressure lid=1"});
}
