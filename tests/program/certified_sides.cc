// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Where a certificate says that all displacements with J at most some value
// are: displacements that other loads lead to, whose J of the scene is that
// value, have to be there, and some of them near the ends of the intervals.
// Their J is not below the bound either. On a mesh four times as fine they are
// not linear on the sides: how far they are from it, and what is known of the
// parts of sides.

#include <debond/solve/certificate.h>
#include <debond/solve/method_choice.h>
#include <debond/solve/solve.h>

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <sstream>

#include "../check.h"
#include "solved.h"

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



  /// u_nu between two points of a straight line with nodes, linear between
  /// them.
  class Trace
  {
  public:
    /// @p values by the distance from the first point.
    explicit Trace(const std::map<double, double> &values)
      : values(values)
    {}

    /// What CertifiedSide has an interval for, exactly; the ends are those of
    /// the part.
    struct Part
    {
      double                mean, deviation;
      std::array<double, 2> at_ends;
    };

    Part
    between(const double first, const double last) const
    {
      // Simpson's rule is exact for products of two linear functions.
      const double        half   = 0.5 * (last - first);
      const double        middle = 0.5 * (first + last);
      double              mean = 0., slope = 0., squared = 0.;
      std::vector<double> places = {first};
      for (const auto &[place, value] : values)
        if (place > first + 1e-9 * half && place < last - 1e-9 * half)
          places.push_back(place);
      places.push_back(last);
      for (unsigned int i = 1; i < places.size(); ++i)
        for (const auto &[part, weight] : {std::make_pair(0., 1.),
                                           std::make_pair(0.5, 4.),
                                           std::make_pair(1., 1.)})
          {
            const double x = places[i - 1] + part * (places[i] - places[i - 1]);
            const double share = weight / 6. * (places[i] - places[i - 1]);
            mean += share * value(x) / (2. * half);
            slope += 3. * share * value(x) * (x - middle) / half / (2. * half);
            squared += share * value(x) * value(x);
          }
      squared -= 2. * half * (mean * mean + slope * slope / 3.);
      return {mean,
              std::sqrt(std::max(squared, 0.)),
              {{mean - slope, mean + slope}}};
    }

  private:
    double
    value(const double x) const
    {
      auto after = values.lower_bound(x);
      if (after == values.begin())
        return after->second;
      if (after == values.end())
        return values.rbegin()->second;
      const auto   before = std::prev(after);
      const double part = (x - before->first) / (after->first - before->first);
      return before->second + part * (after->second - before->second);
    }

    std::map<double, double> values;
  };



  /// How far a trace is outside of what a side has, relative to the size of its
  /// values; and how near it is to the end of the deviation's interval.
  struct Excess
  {
    double outside = 0., of_deviation = 0.;

    void
    add(const Trace::Part &part, const CertifiedSide &side)
    {
      const auto outside_of = [&](const double    value,
                                  const Interval &interval) {
        const double size = std::abs(value) + 1e-300;
        outside           = std::max({outside,
                                      (interval.lower - value) / size,
                                      (value - interval.upper) / size});
      };
      outside_of(part.mean, side.mean);
      for (unsigned int k = 0; k < 2; ++k)
        outside_of(part.at_ends[k], side.at_ends[k]);
      of_deviation = std::max(of_deviation, part.deviation / side.deviation);
    }
  };



  /// Lemma 4 (b) on functions that are linear between many points of a side.
  void
  test_parts()
  {
    std::mt19937_64 engine(5);
    const auto      uniform = [&](const double a, const double b) {
      return a + (b - a) * (static_cast<double>(engine() >> 11) * 0x1p-53);
    };
    const dealii::Point<2>     origin(3., -2.);
    const dealii::Tensor<1, 2> along({0.8, -0.6});
    Excess                     excess;
    double                     sharpest = 0.;
    for (unsigned int trial = 0; trial < 3000; ++trial)
      {
        const double             length = std::pow(10., uniform(-3., 3.));
        std::map<double, double> values;
        const double             jump = uniform(0., 1.);
        for (unsigned int i = 0; i <= 64; ++i)
          values[length * i / 64.] =
            -3. +
            (trial % 2 == 0 ? uniform(-1., 1.) : (i < 64. * jump ? -1. : 1.)) +
            1e-2 * uniform(-1., 1.);
        const Trace       trace(values);
        const Trace::Part whole = trace.between(0., length);
        CertifiedSide     side;
        const bool        is_reversed = trial % 3 == 0;
        const auto        point       = [&](const double part) {
          return dealii::Point<2>(origin + part * length * along);
        };
        side.ends      = {{point(is_reversed), point(!is_reversed)}};
        side.mean      = {whole.mean, whole.mean};
        side.deviation = whole.deviation;
        for (unsigned int k = 0; k < 2; ++k)
          {
            const double at_end = whole.at_ends[is_reversed ? 1 - k : k];
            side.at_ends[k]     = {at_end, at_end};
          }
        const double  a     = trial % 5 == 0 ? 0. : uniform(0., 0.5);
        const double  b     = trial % 7 == 0 ? 1. : uniform(0.5, 1.);
        const auto    part  = trace.between(a * length, b * length);
        CertifiedSide other = side;
        other.ends          = {{point(2.), point(3.)}};
        const CertifiedSide known =
          known_between({{point(a), point(b)}}, {other, side});
        excess.add(part, known);
        for (unsigned int k = 0; k < 2; ++k)
          sharpest =
            std::max(sharpest, place(part.at_ends[k], known.at_ends[k]));
      }
    std::cout << "parts of sides\n";
    check("  they are where the side says", excess.outside <= 1e-9);
    check("  deviations, too", excess.of_deviation <= 1. + 1e-9);
    check("  some are near the ends", sharpest > 0.8);
  }



  /// Displacements of a finer mesh, which are not linear on the sides. @p
  /// clamped: vertices at the bottom that are no contact nodes.
  void
  test_halves(const std::string         &name,
              const Values              &scene_values,
              const std::string         &cells,
              const std::string         &finer_cells,
              const std::vector<double> &clamped,
              const Values              &loads)
  {
    const Parameters parameters =
      parameters_of(scene_values + Values{"Mesh/Cells=" + cells});
    const auto       scene = std::make_shared<const Scene<2>>(parameters);
    const Certifier  certifier(CertificateKind::global, scene);
    const Parameters finer =
      parameters_of(scene_values + Values{"Mesh/Cells=" + finer_cells});
    const Scene<2> fine_scene(finer);
    const auto    &contact = fine_scene.problem().unknowns().contact();

    Excess       whole, halves;
    unsigned int n_narrower = 0;
    for (const std::string &load : loads)
      {
        const DofVector u =
          solution(scene_values + Values{"Mesh/Cells=" + finer_cells, load});
        std::map<double, double> values;
        const Eigen::VectorXd    s = contact.trace(u);
        for (unsigned int i = 0; i < s.size(); ++i)
          values[contact.boundary().nodes[i].position[0]] = s(i);
        for (const double x : clamped)
          values[x] = 0.;
        const Trace trace(values);
        Certificate certificate;
        for (const bool is_second : {false, true})
          {
            const Certificate earlier = certificate;
            certificate               = certifier.certify(
              fine_scene,
              u,
              {},
              []() { return true; },
              is_second ? &earlier : nullptr,
              true);
            if (is_second)
              for (unsigned int i = 0; i < certificate.sides.size(); ++i)
                n_narrower +=
                  certificate.sides[i].deviation < earlier.sides[i].deviation;
          }
        for (const CertifiedSide &side : certificate.sides)
          {
            const double a = side.ends[0][0], b = side.ends[1][0];
            const auto   at = [&](const double from, const double to) {
              Trace::Part part =
                trace.between(std::min(from, to), std::max(from, to));
              if (to < from)
                std::swap(part.at_ends[0], part.at_ends[1]);
              return part;
            };
            whole.add(at(a, b), side);
            const auto half = [&](const double from, const double to) {
              halves.add(at(from, to),
                         known_between({{dealii::Point<2>(from, 0.),
                                         dealii::Point<2>(to, 0.)}},
                                       certificate.sides));
            };
            half(a, 0.5 * (a + b));
            half(0.5 * (a + b), b);
          }
      }
    std::cout << name << std::endl;
    check("  displacements of a finer mesh are in their intervals",
          whole.outside <= 1e-9);
    check("  and on halves of sides", halves.outside <= 1e-9);
    check("  they are not farther from linear ones", whole.of_deviation <= 1.);
    check("  some are nearly as far", whole.of_deviation > 0.05);
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
        const DofVector   u           = solution(scene_values + Values{load});
        const Certificate certificate = certifier.certify(
          *scene, u, {}, []() { return true; }, nullptr, false);
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
  test_parts();
  const Values benchmark = {"Loads/Traction top=0; if(x<0.2,0.69,-0.345)",
                            "Contact law/Quadrature=gauss 8",
                            "Solver/Method=automatic"};
  const Values loads     = {"Loads/Body force=0; 0",
                            "Loads/Body force=0; 2",
                            "Loads/Body force=0; -2",
                            "Loads/Body force=0; if(x<0.1,-5,5)",
                            "Loads/Traction right=0; 0.1"};
  test("benchmark", benchmark + Values{"Mesh/Cells=40, 4"}, loads);
  // Loads in waves as long as the sides of the coarse mesh bend the lower side
  // of the body there.
  const Values waves =
    loads + Values{"Loads/Body force=0; if(y<0.005,2000*sin(314.16*x),0)",
                   "Loads/Body force=0; if(y<0.005,400*cos(314.16*x),0)"};
  test_halves(
    "benchmark, sides of 20 mm", benchmark, "20, 2", "80, 8", {0., 0.4}, waves);
  test_halves("stiff bonds",
              benchmark + Values{"Contact law/Bond stiffness=690"},
              "20, 2",
              "80, 8",
              {0., 0.4},
              waves);

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
  test_halves(
    "the same, sides of 8 mm", strip, "12, 1", "48, 4", {0.}, strip_loads);
}
