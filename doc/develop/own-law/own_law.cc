// SPDX-License-Identifier: LGPL-2.1-or-later
// A block on a foundation, with a law of its own: bonds of 100 that turn into
// bonds of 50 before they break. Its top is lifted by 0.03, its sides slide, so
// that all is known: s = -E d / (E + 50) = -0.02.

#include <deal.II/base/function.h>

#include <debond/contact/adhesion_integral.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/mesh/box.h>
#include <debond/optimization/majorise/condensed_problem.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <string>

using namespace Debond;

int
main()
{
  // The mesh: a deal.II triangulation of simplices.
  dealii::Triangulation<2> mesh;
  make_box<2>({{{1., 1.}}, {{8, 8}}}, mesh);
  const auto &sides = box_sides<2>();

  // What resists: unknowns, supports, A and f.
  BoundaryConditions conditions;
  conditions.contact                 = {sides.at("bottom")};
  conditions.tangential_displacement = TangentialDisplacement::free;
  const double lift                  = 0.03;
  Supports<2>  supports;
  for (const std::string side : {"left", "right"})
    supports.displacements.push_back(
      {side, {sides.at(side)}, /*is_roller=*/true});
  supports.displacements.push_back(
    {"top",
     {sides.at("top")},
     false,
     {{false, true}},
     std::make_shared<dealii::Functions::ConstantFunction<2>>(lift, 2)});
  ElasticProblem<2> problem(mesh, conditions, supports);
  Material          material;
  material.young_modulus = 100.;
  material.poisson_ratio = 0.;
  problem.assemble(material, Loads<2>());

  // What happens at the contact boundary: pieces of the law from s = 0
  // downwards, {curvature, slope, end, name}.
  const AdhesiveLaw          law({{100., 0., -0.01, "glued"},
                                  {50., 0., -0.06, "torn"},
                                  {0., 0., no_end, "broken"}});
  const ContactSpace<2>     &contact = problem.unknowns().contact();
  const ContactQuadrature<2> quadrature(
    {ContactQuadratureParameters::Rule::nodal});
  const AdhesionIntegral<2> bonds(contact.boundary(), law, quadrature);

  // What contact sees of the body: 1/2 s'S s - g's + c_0.
  const Condensation condensed = condense_to_contact(problem, bonds);

  // How it is minimised, from rest.
  Eigen::VectorXd  s = contact.at_rest();
  CondensedProblem minimised(condensed_problem(condensed, bonds), s);
  const auto       result = MajoriseMinimise({}).minimize(minimised);
  const double     J      = result.functional + condensed.energy_at_zero();
  std::cout << to_string(result.status) << ", s = " << s.mean() << ", J = " << J
            << std::endl;
  return result.status == SolverStatus::success &&
             std::abs(s.mean() + 0.02) < 1e-10 && std::abs(J - 0.0175) < 1e-10 ?
           0 :
           1;
}
