// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Where a certificate says that all displacements with J at most some value
// are: displacements that other loads lead to, whose J of the scene is that
// value, have to be there, and some of them near the ends of the intervals.
// Their J is not below the bound either.

#include <debond/certify/certificate.h>
#include <debond/solve/minimum/method_choice.h>
#include <debond/solve/minimum/solve.h>

#include <cmath>
#include <map>

#include "../check.h"
#include "../solved.h"

using namespace Debond;

namespace
{
  DofVector
  solution(const Values &values)
  {
    const Parameters parameters = parameters_of(values);
    const Scene<2>   scene(parameters);
    return solved(parameters, scene).u;
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
          certifier.certify(u, {}, Interruption::by_signal());
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
                                 place(first, side.linear()),
                                 place(last, side.linear())});
            if (!side.piece)
              continue;
            ++n_certain;
            for (const double value : {first, last})
              n_wrong += scene->law().pieces().index(value) != *side.piece;
          }
      }
    std::cout << name << std::endl;
    check("  J is not below the bound", is_below);
    check("  displacements are in their intervals", farthest <= 1. + 1e-9);
    check("  some are in the outer half", farthest > 0.5);
    check("  some sides are certain", n_certain > 0);
    check("  bonds are on the certain branches", n_wrong == 0);
  }



  /// The best bounds of two meshes, in whichever order they come.
  void
  test_intersection()
  {
    const auto certificate = [](const double lower, const double upper) {
      Certificate result;
      result.lower = lower;
      result.upper = upper;
      return result;
    };
    bool is_narrowest = true;
    for (const auto &[first, second] :
         {std::make_pair(certificate(-4., -2.), certificate(-3., -1.)),
          std::make_pair(certificate(-3., -1.), certificate(-4., -2.))})
      {
        Certificate later = second;
        intersect(later, first);
        is_narrowest = is_narrowest && later.lower == -3. && later.upper == -2.;
      }
    bool is_kept = true;
    for (const bool is_first : {true, false})
      for (const bool is_state : {true, false})
        {
          Certificate  earlier = certificate(-3., -2.);
          Certificate  later   = certificate(-4., -1.);
          Certificate &other   = is_first ? earlier : later;
          if (is_state)
            other.minimum = CertifiedMinimum::fixed_state;
          else
            other.loads_are_exact = false;
          intersect(later, earlier);
          is_kept = is_kept && later.lower == -4. && later.upper == -1.;
        }
    std::cout << "intervals of two meshes\n";
    check("  the best bounds are kept", is_narrowest);
    check("  not those for another number", is_kept);
  }
} // namespace



int
main()
{
  test_intersection();
  const Values benchmark = {"Loads/Traction top=0; if(x<0.2,0.69,-0.345)",
                            "Contact law/Quadrature=gauss 8",
                            "Solver/Method=automatic"};
  const Values loads     = {"Loads/Body force=0; 0",
                            "Loads/Body force=0; 2",
                            "Loads/Body force=0; -2",
                            "Loads/Body force=0; if(x<0.1,-5,5)",
                            "Loads/Traction right=0; 0.1"};
  test("benchmark", benchmark + Values{"Mesh/Cells=40, 4"}, loads);
  const Values strip       = {"Mesh/Lengths=100, 4",
                              "Material/Young modulus=210000",
                              "Material/Poisson ratio=0.3",
                              "Boundary conditions/Clamped boundaries=left",
                              "Contact law/Bond stiffness=100",
                              "Contact law/Bond threshold=0.1",
                              "Contact law/Tangential displacement=free",
                              "Contact law/Quadrature=gauss 8",
                              "Loads/Traction top=",
                              "Loads/Traction right=0; 3",
                              "Solver/Method=automatic"};
  const Values strip_loads = {"Loads/Body force=0; 0",
                              "Loads/Traction right=0; 4",
                              "Loads/Traction right=0; 2",
                              "Loads/Traction right=0; -3",
                              "Loads/Body force=0; if(x<50,-0.1,0.1)"};
  test("strip held at one end",
       strip + Values{"Mesh/Cells=25, 1"},
       strip_loads);
}
