// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Where a certificate says that all displacements with J at most some value
// are: displacements that other loads lead to, whose J of the scene is that
// value, have to be there, and some of them near the ends of the intervals.
// Their J is not below the bound either.

#include <debond/solve/certificate.h>
#include <debond/solve/method_choice.h>
#include <debond/solve/solve.h>

#include <cmath>
#include <map>
#include <sstream>

#include "../check.h"
#include "parameters_of.h"

using namespace Debond;

namespace
{
  DofVector
  solution(const Values &values)
  {
    const Parameters parameters = parameters_of(values);
    const Scene<2>   scene(parameters);
    return solve(choose_method(parameters, parameters.solver),
                 parameters.solver,
                 scene)
      .u;
  }



  /// How far a number is from the middle of an interval, 1 at its ends.
  double
  place(const double value, const Interval &interval)
  {
    return std::abs(2. * value - interval.lower - interval.upper) /
           (interval.upper - interval.lower);
  }



  void
  test(const std::string &name, const Values &scene_values, const Values &loads)
  {
    const Parameters parameters = parameters_of(scene_values);
    const auto       scene      = std::make_shared<const Scene<2>>(parameters);
    const Certifier  certifier(CertificateKind::global, scene);
    const auto      &contact = scene->problem().unknowns().contact();

    double       farthest  = 0.;
    bool         is_below  = true;
    unsigned int n_certain = 0, n_wrong = 0;
    for (const std::string &load : loads)
      {
        const DofVector   u = solution(scene_values + Values{load});
        const Certificate certificate =
          certifier.certify(*scene, u, {}, []() { return true; });
        is_below = is_below && certificate.lower < certificate.upper;

        std::map<double, double> displacements;
        const Eigen::VectorXd    s = contact.trace(u);
        for (unsigned int i = 0; i < s.size(); ++i)
          displacements[contact.boundary().nodes[i].position[0]] = s(i);
        for (const CertifiedSide &side : certificate.sides)
          {
            // What is clamped is no contact node.
            const auto at = [&](const dealii::Point<2> &end) {
              const auto node = displacements.lower_bound(end[0] - 1e-9);
              return node == displacements.end() ||
                         node->first > end[0] + 1e-9 ?
                       0. :
                       node->second;
            };
            const double first = at(side.ends[0]), last = at(side.ends[1]);
            farthest = std::max({farthest,
                                 place(0.5 * (first + last), side.mean),
                                 place(first, side.linear),
                                 place(last, side.linear)});
            if (!side.piece)
              continue;
            ++n_certain;
            for (const double value : {first, last})
              n_wrong += scene->law().branches().index(value) != *side.piece;
          }
      }
    std::cout << name << std::endl;
    check("  J is not below the bound", is_below);
    check("  displacements are in their intervals", farthest <= 1. + 1e-9);
    check("  some are in the outer half", farthest > 0.5);
    check("  some sides are certain", n_certain > 0);
    check("  bonds are on the certain branches", n_wrong == 0);
  }
} // namespace



int
main()
{
  const Values benchmark = {"Mesh/Cells=40, 4",
                            "Loads/Traction top=0; if(x<0.2,0.69,-0.345)",
                            "Contact law/Quadrature=exact",
                            "Solver/Method=automatic"};
  test("benchmark",
       benchmark,
       {"Loads/Body force=0; 0",
        "Loads/Body force=0; 2",
        "Loads/Body force=0; -2",
        "Loads/Body force=0; if(x<0.1,-5,5)",
        "Loads/Traction right=0; 0.1"});
  test("strip held at one end",
       {"Mesh/Lengths=100, 4",
        "Mesh/Cells=25, 1",
        "Material/Young modulus=210000",
        "Material/Poisson ratio=0.3",
        "Boundary conditions/Clamped boundaries=left",
        "Contact law/Bond stiffness=100",
        "Contact law/Bond threshold=0.1",
        "Contact law/Tangential displacement=free",
        "Contact law/Quadrature=exact",
        "Loads/Traction top=",
        "Loads/Traction right=0; 3",
        "Solver/Method=automatic"},
       {"Loads/Body force=0; 0",
        "Loads/Traction right=0; 4",
        "Loads/Traction right=0; 2",
        "Loads/Traction right=0; -3",
        "Loads/Body force=0; if(x<50,-0.1,0.1)"});
}
