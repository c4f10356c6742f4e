// SPDX-License-Identifier: LGPL-2.1-or-later
// Bounds of random small scenes beside the least J that a search finds on a
// finer mesh: with quadratic displacements, which are of the continuous problem
// and know nothing of equilibrated stresses. Plane bodies are rectangles and
// other quadrilaterals, solids boxes and sheared ones, whose bounds are for the
// branches of a state; cells are bisected at random. No bound may be above
// that, nor one of a plane mesh with more cells cut, which is handed what the
// first one knows, and the parts of a gap, none of them below zero, are
// together as large as the gap. Then solids whose J is known, what units
// change, and how the gap falls. Arguments: the number of plane scenes, a fifth
// as many solids, the first one.

#include <debond/certify/certificate.h>
#include <debond/mesh/bisected_body.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "../check.h"
#include "../solved.h"
#include "random.h"

using namespace Debond;

namespace
{
  /// What was found in all scenes.
  struct BoundCounts
  {
    unsigned int        unsolved = 0, above = 0, negative = 0, n_bounds = 0;
    unsigned int        inexact = 0, beyond_reserve = 0; ///< sums of gaps
    std::vector<double> distances; ///< of the bound from the least J found

    std::map<std::string, unsigned int> refused; ///< by reason

    /// Of a certificate with the branches as they are.
    void
    add_parts(const Certificate &certificate)
    {
      const double scale = std::abs(certificate.upper);
      double       sum   = 0.;
      for (const double gap : certificate.gaps)
        {
          sum += gap;
          negative += gap < -1e-12 * scale;
        }
      const double error = std::abs(certificate.upper - certificate.lower -
                                    certificate.reserve - sum);
      inexact += error > 1e-10 * scale;
      beyond_reserve += error > certificate.reserve;
    }

    /// A bound above @p upper is one too many.
    void
    add_bound(const unsigned int number,
              const double       lower,
              const double       upper,
              const Values      &values)
    {
      if (lower <= upper)
        return;
      ++above;
      std::cout << "scene " << number << ": " << text(lower) << " is above "
                << text(upper) << '\n';
      for (const std::string &value : values)
        std::cout << "  " << value << '\n';
    }

    /// Of @p n scenes.
    void
    check_all(const std::string &name, const unsigned int n)
    {
      section(name);
      check("bounds above what is found", above, 0);
      check("parts of a gap below zero", negative, 0);
      check("their sum is the gap but for the reserve for rounding",
            beyond_reserve,
            0);
      check("more than 1e-10 of J beside it", inexact, n / 5);
      check("most scenes have one", n_bounds > n / 2);
      if (!print_figures)
        return;
      std::sort(distances.begin(), distances.end());
      std::cout << n_bounds << " bounds, " << unsolved << " not solved; "
                << distances.size() << " beside finer meshes, below by "
                << distances.front() << " at least, "
                << distances[distances.size() / 2] << " in the median\n";
      for (const auto &[reason, times] : refused)
        std::cout << times << " refused: " << reason << '\n';
    }
  };



  class Unsolved
  {};



  using Times = std::vector<unsigned int>;

  /// With each cell cut as often as a random one of @p times says.
  template <int dim>
  std::shared_ptr<const Scene<dim>>
  cut_scene(const Parameters  &parameters,
            const unsigned int number,
            const Times       &times)
  {
    const BisectedBody<dim> whole(
      std::dynamic_pointer_cast<const Body<dim>>(parameters.body));
    Generator                 random(number + 1000000);
    std::vector<unsigned int> of_cells;
    for (unsigned int k = 0; k < whole.n_cells(); ++k)
      of_cells.push_back(random.choice(times));
    return std::make_shared<const Scene<dim>>(parameters,
                                              whole.refined(of_cells));
  }



  struct RandomScene
  {
    Values          values, coarse, fine;
    CertificateKind kind = CertificateKind::global;

    /// Whether J with the branches of a state is J.
    bool is_convex = true;
  };



  std::string
  point(const double x, const double y)
  {
    return text(x) + ',' + text(y);
  }



  /// A box, a sheared one or any convex quadrilateral, with the names of its
  /// left, right, bottom and top.
  std::vector<std::string>
  set_plane(Generator   &random,
            const double length,
            const double height,
            RandomScene &scene)
  {
    const unsigned int ny = random.choice<unsigned int>({1, 2});
    if (random.uniform(0., 1.) < 0.7)
      {
        const unsigned int nx = 2 * random.choice<unsigned int>({1, 2, 3});
        scene.values.push_back("Mesh/Lengths=" + text(length) + ',' +
                               text(height));
        for (const unsigned int factor : {1, 4})
          (factor == 1 ? scene.coarse : scene.fine)
            .push_back("Mesh/Cells=" + std::to_string(factor * nx) + ',' +
                       std::to_string(factor * ny));
        return {"left", "right", "bottom", "top"};
      }
    const bool   is_sheared = random.uniform(0., 1.) < 0.5;
    const double x          = random.uniform(-0.3, 0.3) * height;
    const double y          = height * random.uniform(0.6, 1.);
    const double narrower   = is_sheared ? 0. : random.uniform(0., 0.4);
    scene.values +=
      Values{"Mesh/Source=generator",
             "Mesh/Generator=general_cell",
             "Mesh/Arguments=" + point(0., 0.) + ';' + point(length, 0.) + ';' +
               point(x, height) + ';' +
               point(x + length * (1. - narrower), is_sheared ? height : y) +
               ": true"};
    scene.coarse.push_back("Mesh/Refinements=" + std::to_string(ny));
    scene.fine.push_back("Mesh/Refinements=" + std::to_string(ny + 2));
    return {"0", "1", "2", "3"};
  }



  /// The names of left, right, bottom, top and front.
  std::vector<std::string>
  set_solid(Generator   &random,
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
        for (const unsigned int factor : {1, 2})
          (factor == 1 ? scene.coarse : scene.fine)
            .push_back("Mesh/Cells=" + std::to_string(factor * nx) + ',' +
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
    scene.values += Values{"Mesh/Source=generator",
                           "Mesh/Generator=general_cell",
                           "Mesh/Arguments=" + points + ": true"};
    scene.coarse.push_back("Mesh/Refinements=0");
    scene.fine.push_back("Mesh/Refinements=1");
    return {"0", "1", "2", "3", "4"};
  }



  /// Loads, laws, materials and supports of all kinds; loads are linear on
  /// sides and constant in cells.
  template <int dim>
  RandomScene
  draw(const unsigned int number)
  {
    constexpr bool is_solid = dim == 3;
    Generator      random(number);
    const double   unit   = random.choice<double>({1e-3, 1., 1e3});
    const double   stress = random.choice<double>({1., 1e3, 1e9});
    const double   length = unit * random.choice<double>({0.4, 1.2});
    const double   height =
      unit * random.choice(is_solid ? std::vector<double>{0.1, 0.4} :
                                      std::vector<double>{0.03, 0.1, 0.4});

    RandomScene              scene;
    std::vector<std::string> sides;
    if (is_solid)
      {
        const double width = unit * random.choice<double>({0.1, 0.5});
        sides              = set_solid(random, length, height, width, scene);
      }
    else
      sides = set_plane(random, length, height, scene);
    const bool                      is_box = sides[0] == "left";
    const std::vector<unsigned int> clamps =
      random.choice<std::vector<unsigned int>>(
        {{0}, {is_solid ? 4u : 1u}, {0, 1}, {3}});
    std::string clamped = sides[clamps[0]];
    // What is prescribed is linear, too, and leads away from the foundation.
    Generator  prescribed(number + 2000000);
    const auto small = [&]() { return prescribed.magnitude(-5., -3.); };
    const bool is_clamped =
      clamps.size() > 1 && prescribed.uniform(0., 1.) < 0.5;
    const bool is_moved = clamps.size() > 1 && !is_clamped;
    if (is_clamped)
      clamped += ", " + sides[clamps[1]];
    if (is_moved)
      scene.values.push_back("Boundary conditions/Displacement " +
                             sides[clamps[1]] + '=' + text(small() * unit) +
                             '-' + text(small()) + "*y; " +
                             text(small() * unit) + '+' + text(small()) + "*y" +
                             (is_solid ? "; 0" : ""));
    if (prescribed.uniform(0., 1.) < 0.3)
      scene.values.push_back("Contact law/Initial gap=" + text(small() * unit) +
                             '+' + text(small()) + "*x");
    const bool from_top = clamps[0] == 3;
    const auto load     = [&]() {
      return random.choice<double>({-1., 1.}) * random.magnitude(-3., 0.) *
             stress * height / unit;
    };
    const double      a     = random.magnitude(-1., 3.) * stress / unit;
    const double      M     = random.magnitude(-4., -2.) * unit;
    const std::string along = is_solid ? "*z; " + text(load()) :
                              from_top ? "*y" :
                                         "*x";
    scene.values += Values{
      "Dimension=" + std::to_string(dim),
      "Boundary conditions/Clamped boundaries=" + clamped,
      "Boundary conditions/Contact boundary=" + sides[2],
      "Material/Young modulus=" + text(69. * stress),
      "Material/Poisson ratio=" + text(random.uniform(0., 0.49)),
      "Material/Hypothesis=" +
        random.choice<std::string>({"plane stress", "plane strain"}),
      "Contact law/Tangential displacement=" +
        random.choice<std::string>({is_moved ? "free" : "fixed", "free"}),
      std::string("Contact law/Quadrature=gauss ") + (is_solid ? "5" : "8"),
      "Loads/Traction top=",
      "Loads/Traction " + sides[from_top ? 1 : 3] + '=' + text(load()) + "; " +
        text(load()) + '+' + text(load() / unit) + along,
      "Loads/Body force=0; " + text(random.uniform(-1., 1.) * stress / unit) +
        (is_solid ? "; 0" : ""),
      "Solver/Method=automatic",
      "Solver/Proof/Maximum nodes=200"};
    using Names           = std::vector<std::string>;
    const std::string law = random.choice(
      is_solid ?
        Names{"unbreakable", "unbreakable", "none", "broken", "winkler"} :
        Names{"winkler", "winkler", "winkler", "curve", "none", "unbreakable"});
    scene.values.push_back(
      "Contact law/Law=" +
      (law == "unbreakable" || law == "broken" ? "winkler" : law));
    if (law == "curve")
      scene.values +=
        Values{"Contact law/Curve=0:0, " + text(M) + ':' + text(a * M) + ", " +
               text(M) + ':' + text(a * M / 3.) + ", " + text(2. * M) + ':' +
               text(a * M * 2. / 3.) + ", " + text(2. * M) + ":0"};
    else if (law != "none")
      scene.values += Values{"Contact law/Bond stiffness=" +
                               (is_solid || law == "broken" || !is_box ||
                                    prescribed.uniform(0., 1.) < 0.7 ?
                                  text(a) :
                                  "if(x < " + text(length / 2.) + ", " +
                                    text(a) + ", " + text(a / 3.) + ')'),
                             "Contact law/Bond threshold=" +
                               text(law == "unbreakable" ? 1e6 * unit :
                                    law == "broken"      ? 1e-9 * unit :
                                                           M)};
    if (is_solid || law == "unbreakable" || law == "none")
      scene.kind = CertificateKind::fixed_state;
    scene.is_convex = !is_solid || law == "unbreakable" || law == "none";
    return scene;
  }



  template <int dim>
  void
  test(const unsigned int number, BoundCounts &counts)
  {
    constexpr bool    is_solid   = dim == 3;
    const RandomScene random     = draw<dim>(number);
    const Parameters  parameters = parameters_of(
      random.values + random.coarse +
      Values{number % 2 == 0 ? "Mesh/Degree=1" : "Mesh/Degree=2"});
    const auto scene =
      number % 3 == 0 ?
        cut_scene<dim>(parameters,
                       number,
                       is_solid ? Times{0, 0, 0, 1, 2} : Times{0, 0, 1, 2, 3}) :
        std::make_shared<const Scene<dim>>(parameters);
    std::vector<Certificate> certificates;
    double                   upper;
    try
      {
        // On a mesh, with what an earlier certificate knows.
        const auto certify = [&](const CertificateKind kind,
                                 const auto           &of,
                                 const Certificate    *earlier) {
          const Solution result = solved(parameters, *of);
          if (!can_be_verified(result.status))
            throw Unsolved();
          return Certifier<dim>(kind, of).certify(result.u,
                                                  parameters.solver.proof,
                                                  Interruption::by_signal(),
                                                  earlier);
        };
        certificates.push_back(certify(random.kind, scene, nullptr));
        upper = certificates[0].upper;
        counts.add_parts(certify(CertificateKind::fixed_state, scene, nullptr));
        // The contact sides are those of the coarser one or parts of them.
        if (!is_solid)
          certificates.push_back(
            certify(random.kind,
                    cut_scene<dim>(parameters, number, {1, 1, 2, 3, 4}),
                    &certificates[0]));
        upper = std::min(upper, certificates.back().upper);
        if (random.is_convex)
          {
            const Parameters fine_parameters = parameters_of(
              random.values + random.fine + Values{"Mesh/Degree=2"});
            const Solution fine =
              solved(fine_parameters, Scene<dim>(fine_parameters));
            if (!can_be_verified(fine.status))
              throw Unsolved();
            for (const Certificate &certificate : certificates)
              counts.distances.push_back((fine.functional - certificate.lower) /
                                         std::abs(certificates[0].upper));
            upper = std::min(upper, fine.functional);
          }
      }
    catch (const EquilibriumError &error)
      {
        ++counts.refused[error.what()];
        return;
      }
    catch (const Unsolved &)
      {
        ++counts.unsolved;
        return;
      }
    counts.n_bounds += certificates.size();
    for (const Certificate &certificate : certificates)
      counts.add_bound(number,
                       certificate.lower,
                       upper,
                       random.values + random.coarse);
  }



  Certificate
  certificate_of(const Values &values)
  {
    const Parameters parameters = parameters_of(values + Values{"Dimension=3"});
    const auto       scene      = std::make_shared<const Scene<3>>(parameters);
    const Solution   result     = solved(parameters, *scene);
    return Certifier<3>(CertificateKind::fixed_state, scene)
      .certify(result.u, parameters.solver.proof, Interruption::by_signal());
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
  print_figures            = argc > 1;
  const unsigned int n     = argc > 1 ? std::stoul(argv[1]) : 60;
  const unsigned int first = argc > 2 ? std::stoul(argv[2]) : 0;

  BoundCounts plane, solid;
  for (unsigned int number = first; number < first + n; ++number)
    test<2>(number, plane);
  // Of a body of 40:1, in which elimination loses 3e-7 of J.
  if (argc == 1)
    test<2>(1628, plane);
  for (unsigned int number = first; number < first + n / 5; ++number)
    test<3>(number, solid);
  plane.check_all("plane", n);
  solid.check_all("solid", n / 5);
  test_column();
  test_units();
  test_convergence();
}
