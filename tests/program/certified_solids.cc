// SPDX-License-Identifier: LGPL-2.1-or-later
// Bounds of random small solids with given branches of the law beside the least
// J on a mesh twice as fine, with quadratic displacements, which know nothing
// of equilibrated stresses: boxes and sheared boxes clamped at an end, at both,
// at the top or at the side, some with tetrahedra bisected at random. No bound
// may be above that, and the parts of a gap, none of them below zero, are
// together as large as the gap. Then two bodies whose J is known, what units
// change, and how the gap falls. Arguments: the number of scenes, the first
// one.

#include "random_bounds.h"

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



  Certificate
  certify(const Parameters                      &parameters,
          const std::shared_ptr<const Scene<3>> &scene,
          const DofVector                       &u)
  {
    return Certifier<3>(CertificateKind::fixed_state, scene)
      .certify(*scene, u, parameters.solver.proof, []() { return true; });
  }



  void
  test(const unsigned int number, BoundCounts &counts, unsigned int &n_bounds)
  {
    const RandomScene random     = draw(number);
    const Parameters  parameters = parameters_of(
      random.values + random.coarse +
      Values{number % 2 == 0 ? "Mesh/Degree=1" : "Mesh/Degree=2"});
    const auto  scene = coarse_scene<3>(parameters, number, {0, 0, 0, 1, 2});
    Certificate certificate;
    try
      {
        const SolveResult result = solved(parameters, *scene);
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
    ++n_bounds;
    counts.add_parts(certificate);
    double upper = certificate.upper;
    if (random.is_convex)
      {
        const Parameters fine_parameters =
          parameters_of(random.values + random.fine + Values{"Mesh/Degree=2"});
        const Scene<3>    fine_scene(fine_parameters);
        const SolveResult fine = solved(fine_parameters, fine_scene);
        if (!can_be_verified(fine.status))
          {
            ++counts.unsolved;
            return;
          }
        upper = std::min(upper, fine.functional);
        counts.distances.push_back((fine.functional - certificate.lower) /
                                   std::abs(certificate.upper));
      }
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
    const SolveResult result    = solved(parameters, *scene);
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

  BoundCounts  counts;
  unsigned int n_bounds = 0;
  for (unsigned int number = first; number < first + n; ++number)
    test(number, counts, n_bounds);
  counts.check_all(n, n_bounds);
  if (argc > 1)
    counts.print(n_bounds);
  test_column();
  test_units();
  test_convergence();
}
