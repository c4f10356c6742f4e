// SPDX-License-Identifier: LGPL-2.1-or-later
// Bounds of random small scenes beside the least J that a search finds on a
// mesh four times as fine: with quadratic displacements, which are of the
// continuous problem and know nothing of equilibrated stresses. Meshes are of
// rectangles, of other quadrilaterals, and bisected at random. No bound may be
// above that, nor one of a mesh with more cells cut, which is handed what the
// first one knows, and the parts of a gap, none of them below zero, are
// together as large as the gap. Arguments: the number of scenes, the first one.

#include "random_bounds.h"

using namespace Debond;

namespace
{
  struct RandomScene
  {
    Values          values, coarse, fine;
    CertificateKind kind = CertificateKind::global;
  };



  std::string
  point(const double x, const double y)
  {
    return text(x) + ',' + text(y);
  }



  /// A box, a sheared one or any convex quadrilateral, with the names of its
  /// left, right, bottom and top.
  std::vector<std::string>
  set_body(Generator   &random,
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
        for (const auto &[cells, factor] : {std::make_pair(&scene.coarse, 1u),
                                            std::make_pair(&scene.fine, 4u)})
          cells->push_back("Mesh/Cells=" + std::to_string(factor * nx) + ',' +
                           std::to_string(factor * ny));
        return {"left", "right", "bottom", "top"};
      }
    const bool   is_sheared = random.uniform(0., 1.) < 0.5;
    const double x          = random.uniform(-0.3, 0.3) * height;
    const double y          = height * random.uniform(0.6, 1.);
    const double narrower   = is_sheared ? 0. : random.uniform(0., 0.4);
    scene.values =
      scene.values +
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



  /// Loads, laws, materials and supports of all kinds; loads are linear on
  /// sides and constant in cells.
  RandomScene
  draw(const unsigned int number)
  {
    Generator    random(number);
    const double length = random.choice<double>({1e-3, 1., 1e3});
    const double stress = random.choice<double>({1., 1e3, 1e9});
    const double width  = length * random.choice<double>({0.4, 1.2});
    const double height = length * random.choice<double>({0.03, 0.1, 0.4});

    RandomScene                    scene;
    const std::vector<std::string> sides =
      set_body(random, width, height, scene);
    const std::vector<std::string> clamps =
      random.choice<std::vector<std::string>>(
        {{sides[0]}, {sides[1]}, {sides[0], sides[1]}, {sides[3]}});
    const bool  from_top = clamps[0] == sides[3];
    std::string clamped  = clamps[0];
    for (unsigned int k = 1; k < clamps.size(); ++k)
      clamped += ", " + clamps[k];
    const auto load = [&]() {
      return random.choice<double>({-1., 1.}) * random.magnitude(-3., 0.) *
             stress * height / length;
    };
    const double a = random.magnitude(-1., 3.) * stress / length;
    const double M = random.magnitude(-4., -2.) * length;
    scene.values =
      scene.values +
      Values{"Boundary conditions/Clamped boundaries=" + clamped,
             "Boundary conditions/Contact boundary=" + sides[2],
             "Material/Young modulus=" + text(69. * stress),
             "Material/Poisson ratio=" + text(random.uniform(0., 0.49)),
             "Material/Hypothesis=" +
               random.choice<std::string>({"plane stress", "plane strain"}),
             "Contact law/Tangential displacement=" +
               random.choice<std::string>({"fixed", "free"}),
             "Contact law/Quadrature=gauss 8",
             "Loads/Traction top=",
             "Loads/Traction " + (from_top ? sides[1] : sides[3]) + '=' +
               text(load()) + "; " + text(load()) + '+' +
               text(load() / length) + (from_top ? "*y" : "*x"),
             "Loads/Body force=0; " +
               text(random.uniform(-1., 1.) * stress / length),
             "Solver/Method=automatic",
             "Solver/Proof/Maximum nodes=200"};
    const std::string law = random.choice<std::string>(
      {"winkler", "winkler", "winkler", "stepped", "none", "unbreakable"});
    scene.values.push_back("Contact law/Law=" +
                           (law == "unbreakable" ? "winkler" : law));
    if (law == "stepped")
      scene.values =
        scene.values + Values{"Contact law/Stepped/Stiffnesses=" + text(a) +
                                ',' + text(a / 3.),
                              "Contact law/Stepped/Thresholds=" + text(M) +
                                ',' + text(2. * M)};
    else if (law != "none")
      scene.values =
        scene.values + Values{"Contact law/Bond stiffness=" + text(a),
                              "Contact law/Bond threshold=" +
                                text(law == "unbreakable" ? 1e6 * length : M)};
    if (law == "unbreakable" || law == "none")
      scene.kind = CertificateKind::fixed_state;
    return scene;
  }



  void
  test(const unsigned int number, BoundCounts &counts)
  {
    const RandomScene random     = draw(number);
    const Parameters  parameters = parameters_of(
      random.values + random.coarse +
      Values{number % 2 == 0 ? "Mesh/Degree=1" : "Mesh/Degree=2"});
    const auto  scene = coarse_scene<2>(parameters, number, {0, 0, 1, 2, 3});
    Certificate certificate, finer_certificate;
    try
      {
        const SolveResult result = solved(parameters, *scene);
        if (!can_be_verified(result.status))
          {
            ++counts.unsolved;
            return;
          }
        const auto certify = [&](const CertificateKind kind,
                                 const auto           &of,
                                 const DofVector      &u,
                                 const Certificate    *earlier) {
          return Certifier(kind, of).certify(
            *of,
            u,
            parameters.solver.proof,
            []() { return true; },
            earlier,
            true);
        };
        certificate = certify(random.kind, scene, result.u, nullptr);
        counts.add_parts(
          certify(CertificateKind::fixed_state, scene, result.u, nullptr));
        // The contact sides are those of the coarser one or parts of them.
        const auto of = cut_scene<2>(parameters, number, {1, 1, 2, 3, 4});
        const SolveResult on_finer = solved(parameters, *of);
        if (!can_be_verified(on_finer.status))
          {
            ++counts.unsolved;
            return;
          }
        finer_certificate = certify(random.kind, of, on_finer.u, &certificate);
      }
    catch (const EquilibriumError &error)
      {
        ++counts.refused[error.what()];
        return;
      }
    const Parameters fine_parameters =
      parameters_of(random.values + random.fine + Values{"Mesh/Degree=2"});
    const Scene<2>    fine_scene(fine_parameters);
    const SolveResult fine = solved(fine_parameters, fine_scene);
    if (!can_be_verified(fine.status))
      {
        ++counts.unsolved;
        return;
      }

    const double scale = std::abs(certificate.upper);
    counts.distances.push_back((fine.functional - certificate.lower) / scale);
    counts.distances.push_back((fine.functional - finer_certificate.lower) /
                               scale);
    const double upper =
      std::min({fine.functional, certificate.upper, finer_certificate.upper});
    for (const double lower : {certificate.lower, finer_certificate.lower})
      counts.add_bound(number, lower, upper, random.values + random.coarse);
  }
} // namespace



int
main(int argc, char *argv[])
{
  const unsigned int n     = argc > 1 ? std::stoul(argv[1]) : 60;
  const unsigned int first = argc > 2 ? std::stoul(argv[2]) : 0;

  BoundCounts counts;
  for (unsigned int number = first; number < first + n; ++number)
    test(number, counts);
  // Of a body of 40:1, in which elimination loses 3e-7 of J.
  if (argc == 1)
    test(1628, counts);
  counts.check_all(n, counts.distances.size());
  if (argc > 1)
    counts.print(counts.distances.size());
}
