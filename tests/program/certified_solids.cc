// SPDX-License-Identifier: LGPL-2.1-or-later
// Bounds of random small solids with given branches of the law beside the least
// J on a mesh twice as fine, with quadratic displacements, which know nothing
// of equilibrated stresses: boxes and sheared boxes clamped at an end, at both,
// at the top or at the side, some with tetrahedra bisected at random. No bound
// may be above that, and the parts of a gap, none of them below zero, are
// together as large as the gap. Then two bodies whose J is known, what units
// change, and how the gap falls. Arguments: the number of scenes, the first
// one.

#include <debond/mesh/bisected_body.h>
#include <debond/solve/certificate.h>
#include <debond/solve/method_choice.h>
#include <debond/solve/solve.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "../check.h"
#include "generator.h"
#include "parameters_of.h"

using namespace Debond;

namespace
{
  struct RandomScene
  {
    Values values, coarse, fine;

    /// Whether J with the branches of a state is J.
    bool is_convex = true;
  };



  /// The names of left, right, bottom, top and front.
  std::vector<std::string>
  set_body(Generator   &random,
           const double length,
           const double height,
           const double width,
           RandomScene &scene)
  {
    if (random.uniform(0., 1.) < 0.7)
      {
        const unsigned int nx = random.choice<unsigned int>({1, 2, 3});
        const unsigned int nz = random.choice<unsigned int>({1, 2});
        scene.values.push_back("Mesh/Lengths=" + text(length) + ',' +
                               text(height) + ',' + text(width));
        for (const auto &[cells, factor] : {std::make_pair(&scene.coarse, 1u),
                                            std::make_pair(&scene.fine, 2u)})
          cells->push_back("Mesh/Cells=" + std::to_string(factor * nx) + ',' +
                           std::to_string(factor) + ',' +
                           std::to_string(factor * nz));
        return {"left", "right", "bottom", "top", "front"};
      }
    // Sheared along x and z, so that the bottom stays where it is.
    const double x = random.uniform(-0.5, 0.5) * height;
    const double z = random.uniform(-0.5, 0.5) * height;
    std::string  points;
    for (unsigned int k = 0; k < 8; ++k)
      points += (k > 0 ? ";" : "") + text((k & 1) * length + (k >> 1 & 1) * x) +
                ',' + text((k >> 1 & 1) * height) + ',' +
                text((k >> 2) * width + (k >> 1 & 1) * z);
    scene.values = scene.values + Values{"Mesh/Source=generator",
                                         "Mesh/Generator=general_cell",
                                         "Mesh/Arguments=" + points + ": true"};
    scene.coarse.push_back("Mesh/Refinements=0");
    scene.fine.push_back("Mesh/Refinements=1");
    return {"0", "1", "2", "3", "4"};
  }



  RandomScene
  draw(const unsigned int number)
  {
    Generator    random(number);
    const double unit   = random.choice<double>({1e-3, 1., 1e3});
    const double stress = random.choice<double>({1., 1e3, 1e9});
    const double length = unit * random.choice<double>({0.4, 1.2});
    const double height = unit * random.choice<double>({0.1, 0.4});
    const double width  = unit * random.choice<double>({0.1, 0.5});

    RandomScene                    scene;
    const std::vector<std::string> names =
      set_body(random, length, height, width, scene);
    const std::vector<unsigned int> clamps =
      random.choice<std::vector<unsigned int>>({{0}, {0, 1}, {3}, {4}});
    std::string clamped = names[clamps[0]];
    if (clamps.size() > 1)
      clamped += ", " + names[clamps[1]];
    const std::string loaded = names[clamps[0] == 3 ? 1 : 3];
    const auto        load   = [&]() {
      return random.choice<double>({-1., 1.}) * random.magnitude(-3., 0.) *
             stress * height / unit;
    };
    const std::string law = random.choice<std::string>(
      {"unbreakable", "unbreakable", "none", "broken", "winkler"});
    const double a  = random.magnitude(-1., 3.) * stress / unit;
    const double M  = law == "unbreakable" ? 1e6 * unit :
                      law == "broken"      ? 0. :
                                             random.magnitude(-4., -2.) * unit;
    scene.is_convex = law != "winkler" && law != "broken";
    scene.values =
      scene.values +
      Values{"Dimension=3",
             "Boundary conditions/Clamped boundaries=" + clamped,
             "Boundary conditions/Contact boundary=" + names[2],
             "Material/Young modulus=" + text(69. * stress),
             "Material/Poisson ratio=" + text(random.uniform(0., 0.49)),
             "Contact law/Tangential displacement=" +
               random.choice<std::string>({"fixed", "free"}),
             "Contact law/Quadrature=gauss 5",
             "Loads/Traction top=",
             "Loads/Traction " + loaded + '=' + text(load()) + "; " +
               text(load()) + '+' + text(load() / unit) + "*z; " + text(load()),
             "Loads/Body force=0; " +
               text(random.uniform(-1., 1.) * stress / unit) + "; 0",
             "Solver/Method=automatic"};
    if (law == "none")
      scene.values.push_back("Contact law/Law=none");
    else
      scene.values =
        scene.values +
        Values{"Contact law/Bond stiffness=" + text(a),
               "Contact law/Bond threshold=" + text(M > 0. ? M : 1e-9 * unit)};
    return scene;
  }



  struct Counts
  {
    unsigned int        unsolved = 0, above = 0, negative = 0;
    unsigned int        inexact = 0, beyond_reserve = 0; ///< sums of gaps
    std::vector<double> distances, widths;

    std::map<std::string, unsigned int> refused; ///< by reason
  };



  SolveResult
  solution(const Parameters &parameters, const Scene<3> &scene)
  {
    return solve(choose_method(parameters, parameters.solver),
                 parameters.solver,
                 scene);
  }



  Certificate
  certify(const Parameters                      &parameters,
          const std::shared_ptr<const Scene<3>> &scene,
          const DofVector                       &u)
  {
    return Certifier<3>(CertificateKind::fixed_state, scene)
      .certify(*scene, u, parameters.solver.proof, []() { return true; });
  }



  /// On the mesh as it is, or with cells cut at random.
  std::shared_ptr<const Scene<3>>
  coarse_scene(const Parameters &parameters, const unsigned int number)
  {
    if (number % 3 != 0)
      return std::make_shared<const Scene<3>>(parameters);
    const BisectedBody<3> whole(
      std::dynamic_pointer_cast<const Body<3>>(parameters.body));
    Generator                 random(number + 1000000);
    std::vector<unsigned int> times;
    for (unsigned int k = 0; k < whole.n_cells(); ++k)
      times.push_back(random.choice<unsigned int>({0, 0, 0, 1, 2}));
    return std::make_shared<const Scene<3>>(parameters,
                                            whole.refined(times),
                                            MatrixStorage::serial);
  }



  void
  test(const unsigned int number, Counts &counts)
  {
    const RandomScene random     = draw(number);
    const Parameters  parameters = parameters_of(
      random.values + random.coarse +
      Values{number % 2 == 0 ? "Mesh/Degree=1" : "Mesh/Degree=2"});
    const auto  scene = coarse_scene(parameters, number);
    Certificate certificate;
    try
      {
        const SolveResult result = solution(parameters, *scene);
        if (!can_be_verified(result.status))
          {
            ++counts.unsolved;
            return;
          }
        certificate = certify(parameters, scene, result.u);
      }
    catch (const EquilibriumError &error)
      {
        ++counts.refused[error.what()];
        return;
      }
    const double scale = std::abs(certificate.upper);
    counts.widths.push_back(certificate.width());
    double sum = 0.;
    for (const double gap : certificate.gaps)
      {
        sum += gap;
        counts.negative += gap < -1e-12 * scale;
      }
    const double error = std::abs(certificate.upper - certificate.lower -
                                  certificate.reserve - sum);
    counts.inexact += error > 1e-10 * scale;
    counts.beyond_reserve += error > certificate.reserve;

    double upper = certificate.upper;
    if (random.is_convex)
      {
        const Parameters fine_parameters =
          parameters_of(random.values + random.fine + Values{"Mesh/Degree=2"});
        const Scene<3>    fine_scene(fine_parameters);
        const SolveResult fine = solution(fine_parameters, fine_scene);
        if (!can_be_verified(fine.status))
          {
            ++counts.unsolved;
            return;
          }
        upper = std::min(upper, fine.functional);
        counts.distances.push_back((fine.functional - certificate.lower) /
                                   scale);
      }
    if (!(certificate.lower <= upper))
      {
        ++counts.above;
        std::cout << "scene " << number << ": " << text(certificate.lower)
                  << " is above " << text(upper) << '\n';
        for (const std::string &value : random.values + random.coarse)
          std::cout << "  " << value << '\n';
      }
  }



  Certificate
  certificate_of(const Values &values)
  {
    const Parameters parameters = parameters_of(values + Values{"Dimension=3"});
    const auto       scene      = std::make_shared<const Scene<3>>(parameters);
    const SolveResult result    = solution(parameters, *scene);
    return certify(parameters, scene, result.u);
  }



  /// A column that hangs from its top, pulled up from its foundation or pressed
  /// onto it by a body force: displacements are quadratic and stresses linear,
  /// so that there is no gap, and J is known.
  void
  test_column()
  {
    const double E = 5., H = 0.5;
    for (const auto &[f, a] : {std::make_pair(0.01, 20.),
                               std::make_pair(-0.01, 20.),
                               std::make_pair(0.01, 0.),
                               std::make_pair(-0.01, 0.)})
      {
        const Certificate certificate =
          certificate_of({"Mesh/Lengths=0.3,0.5,0.2",
                          "Mesh/Cells=2,1,1",
                          "Mesh/Degree=2",
                          "Material/Young modulus=5",
                          "Material/Poisson ratio=0",
                          "Boundary conditions/Clamped boundaries=top",
                          "Contact law/Tangential displacement=free",
                          a > 0. ? "Contact law/Bond stiffness=" + text(a) :
                                   "Contact law/Law=none",
                          "Contact law/Bond threshold=1",
                          "Contact law/Quadrature=gauss 5",
                          "Loads/Traction top=",
                          "Loads/Body force=0; " + text(f) + "; 0",
                          "Solver/Method=automatic"});
        // The displacement at the bottom, and the stress.
        const double u     = f > 0. ? f * H * H / (2. * (E + a * H)) : 0.;
        const double sigma = f > 0. ? a * u : 0.5 * f * H;
        const double sum =
          u * H + sigma * H * H / (2. * E) - f * H * H * H / (6. * E);
        const double J = -0.5 * 0.3 * 0.2 * f * sum;
        check("column, force " + text(f) + ", stiffness " + text(a),
              std::abs(certificate.upper / J - 1.) +
                std::abs(certificate.lower / J - 1.),
              1e-7);
      }
  }



  Values
  bar(const unsigned int n)
  {
    return {"Mesh/Lengths=0.4,0.1,0.1",
            "Mesh/Cells=" + std::to_string(4 * n) + ',' + std::to_string(n) +
              ',' + std::to_string(n),
            "Loads/Traction top=0; if(x<0.2, 0.69, -0.345); 0",
            "Contact law/Quadrature=gauss 5",
            "Solver/Method=automatic"};
  }



  /// The same bar in other units takes the same interval.
  void
  test_units()
  {
    const Certificate one = certificate_of(bar(1));
    const Certificate other =
      certificate_of({"Mesh/Lengths=400,100,100",
                      "Mesh/Cells=4,1,1",
                      "Material/Young modulus=69e9",
                      "Contact law/Bond stiffness=69e6",
                      "Contact law/Bond threshold=2",
                      "Loads/Traction top=0; if(x<200, 0.69e9, -0.345e9); 0",
                      "Contact law/Quadrature=gauss 5",
                      "Solver/Method=automatic"});
    check("units do not matter",
          std::abs(one.width() / other.width() - 1.),
          1e-6);
    check("nor does the number of unknowns",
          one.n_unknowns == other.n_unknowns);
  }



  void
  test_convergence()
  {
    const Values quadratic = {"Mesh/Degree=2"};
    const double coarse    = certificate_of(bar(1) + quadratic).width();
    const double fine      = certificate_of(bar(2) + quadratic).width();
    check("the gap falls on a mesh twice as fine", fine / coarse, 0.4);
  }
} // namespace



int
main(int argc, char *argv[])
{
  const unsigned int n     = argc > 1 ? std::stoul(argv[1]) : 12;
  const unsigned int first = argc > 2 ? std::stoul(argv[2]) : 0;
  print_figures            = argc > 1;

  Counts counts;
  for (unsigned int number = first; number < first + n; ++number)
    test(number, counts);
  check("bounds above what is found", counts.above, 0);
  check("parts of a gap below zero", counts.negative, 0);
  check("their sum is the gap but for the reserve for rounding",
        counts.beyond_reserve,
        0);
  check("more than 1e-10 of J beside it", counts.inexact, n / 5);
  check("most scenes have one", counts.widths.size() > n / 2);
  if (argc > 1)
    {
      std::sort(counts.distances.begin(), counts.distances.end());
      std::sort(counts.widths.begin(), counts.widths.end());
      std::cout << counts.widths.size() << " bounds, " << counts.unsolved
                << " not solved; " << counts.distances.size()
                << " beside finer meshes, below by " << counts.distances.front()
                << " at least, "
                << counts.distances[counts.distances.size() / 2]
                << " in the median; " << counts.negative << " negative parts, "
                << counts.inexact << " inexact sums, " << counts.beyond_reserve
                << " beyond the reserve\n";
      for (const auto &[reason, times] : counts.refused)
        std::cout << times << " refused: " << reason << '\n';
    }
  test_column();
  test_units();
  test_convergence();
}
