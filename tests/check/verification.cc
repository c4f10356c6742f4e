// SPDX-License-Identifier: LGPL-2.1-or-later
// The verification of a solution against cases in which the distance to the
// contact law is known in closed form.

#include <deal.II/lac/full_matrix.h>

#include <debond/check/verification.h>
#include <debond/contact/laws/none.h>
#include <debond/contact/laws/winkler.h>
#include <debond/mesh/box.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "../check.h"

using namespace Debond;



namespace
{
  /**
   * A body clamped at both ends with one contact node (four in 3D), whose
   * normal displacements can be prescribed.
   */
  template <int dim>
  struct Body
  {
    dealii::Triangulation<dim>           mesh;
    std::unique_ptr<ElasticProblem<dim>> problem;

    /// @p pressure: of a pull upwards on the top, in units of E / 1000, with a
    /// push to the right.
    Body(const double young_modulus, const double pressure)
    {
      make_box<dim>({{{2., 1., 1.}}, {{2, 1, 1}}, 0.}, mesh);
      const auto &names = box_sides<dim>();
      problem           = std::make_unique<ElasticProblem<dim>>(
        mesh,
        BoundaryConditions{{names.at("left"), names.at("right")},
                           {names.at("bottom")},
                           TangentialDisplacement::fixed});
      std::vector<double> traction(dim, 0.);
      traction[1] = pressure * young_modulus / 1000.;
      traction[0] = traction[1] / 4.;
      Loads<dim> loads;
      loads.tractions[names.at("top")] = {
        {std::make_shared<dealii::Functions::ConstantFunction<dim>>(traction)}};
      problem->assemble(Material{young_modulus,
                                 0.3,
                                 Material::Hypothesis::plane_strain},
                        loads);
    }

    /// The equilibrium with the normal displacement s at every contact node.
    DofVector
    equilibrium(const double s) const
    {
      dealii::FullMatrix<double> matrix;
      matrix.copy_from(problem->matrix());
      DofVector rhs = problem->load();
      for (const auto dof : problem->unknowns().contact().normal_dofs())
        {
          for (unsigned int j = 0; j < matrix.n(); ++j)
            matrix(dof, j) = 0.;
          matrix(dof, dof) = 1.;
          rhs(dof)         = s;
        }
      matrix.gauss_jordan();
      DofVector u(rhs.size());
      matrix.vmult(u, rhs);
      return u;
    }

    /// Of the first contact node: the force on it is linear in its
    /// displacement.
    double
    displacement_without_contact() const
    {
      const auto force = [this](const double s) {
        return check_law(equilibrium(s), "none", 0., 1.).nodes[0].normal_force;
      };
      return force(0.) / (force(0.) - force(-1.)) * -1.;
    }

    Verification<dim>
    check_law(const DofVector   &u,
              const std::string &name,
              const double       a,
              const double       M,
              const std::string &rule = "nodal") const
    {
      const AdhesiveLaw law(
        (name == "none" ? no_adhesion() : winkler_law(a, M)).pieces);
      const ContactQuadrature<dim> quadrature(
        ContactQuadratureParameters::parse(rule));
      const AdhesionIntegral<dim> adhesion(
        problem->unknowns().contact().boundary(), law, quadrature);
      return verify(*problem, adhesion, u);
    }
  };



  bool
  near(const double value, const double expected)
  {
    return std::abs(value - expected) < 1e-10 * std::abs(expected);
  }



  void
  test_law_violation(const double young_modulus)
  {
    section("Distance to the law, E = ", young_modulus);
    const Body<2> pulled(young_modulus, 1.);
    const auto   &node =
      pulled.problem->unknowns().contact().boundary().nodes.at(0);
    const double scale = young_modulus * node.measure;
    check("there is one contact node",
          pulled.problem->unknowns().contact().boundary().nodes.size() == 1);

    // A pulled node that the bonds hold back at s: any force can be put on
    // the graph by the choice of a.
    const double s = -1e-4;
    const auto   u = pulled.equilibrium(s);
    const double force =
      pulled.check_law(u, "none", 0., 1.).nodes[0].normal_force;
    const double a = force / (s * node.measure);
    check("the bonds have to pull", force < -1e-5 * scale);

    const auto bonded = pulled.check_law(u, "winkler", a, -2. * s);
    check("a bonded node on the graph",
          bonded.law_violation < 1e-13 &&
            bonded.nodes[0].state == BondState::bonded &&
            near(bonded.nodes[0].allowed_force.lower, force) &&
            near(bonded.nodes[0].allowed_force.upper, force));

    // The law asks for (1 + e) times the force. M = 2 |s|, so that the force of
    // the node is the scale F, and L = F / (a measure) = |s| / (1 + e):
    // displacements within delta L and forces within delta F close the gap at
    // delta = e / 2.
    bool expected = true;
    for (const double e : {1e-8, 1e-3, 0.048, 0.2})
      expected &=
        std::abs(
          pulled.check_law(u, "winkler", a * (1. + e), -2. * s).law_violation -
          e / 2.) < 1e-13;
    check("a bonded node off the graph by a known distance", expected);

    // The same however far M is above all displacements.
    expected = true;
    for (const double M : {1e-3, 1., 1e6, 1e12})
      {
        const auto wrong = pulled.check_law(u, "winkler", 1.048 * a, M);
        const auto right = pulled.check_law(u, "winkler", a, M);
        expected &= std::abs(wrong.law_violation - 0.024) < 1e-12 &&
                    wrong.error() > 1e-3 && right.error() < 1e-12;
      }
    check("a bond force 4.8 % off is never accepted", expected);

    // Bonds that bear next to nothing beside the reactions, broken, but with
    // the force of a bond left: that is off by all that they bear, unless they
    // bear less than rounding.
    const double free_s = pulled.displacement_without_contact();
    expected            = true;
    for (const double strength : {1e-3, 1e-6, 1e-9})
      {
        const double F    = strength * std::abs(force);
        const double M    = -free_s / 10.;
        const auto   rest = pulled.check_law(pulled.equilibrium(free_s),
                                           "winkler",
                                           F / (M * node.measure),
                                           M);
        const auto   off =
          pulled.check_law(pulled.equilibrium(free_s + strength * (s - free_s)),
                           "winkler",
                           F / (M * node.measure),
                           M);
        expected &= rest.law_violation < 1e-3 && rest.error() < 1e-3 &&
                    std::abs(off.law_violation - 1.) < 1e-3;
      }
    check("weak bonds: a force left over as large as theirs is not accepted",
          expected);
    const auto below_rounding =
      pulled.check_law(pulled.equilibrium(free_s), "winkler", 1e-25 * a, -s);
    check("bonds weaker than rounding are not the judge of it",
          below_rounding.law_violation < 1e-3);

    // Bonds that break a little before s: the force is one of those at -M. The
    // bonds bear twice the force, which is the scale: L = M / (2 (1 - e)).
    expected = true;
    for (const double e : {1e-12, 1e-8, 1e-3, 0.1})
      {
        const auto broken =
          pulled.check_law(u, "winkler", 2. * a, -s * (1. - e));
        expected &= std::abs(broken.law_violation - 2. * e) < 1e-14 &&
                    broken.nodes[0].state ==
                      (e < 1e-6 ? BondState::kink : BondState::broken) &&
                    broken.nodes[0].allowed_force.upper == 0.;
      }
    check("a node beyond the kink by a known distance", expected);

    const auto kink = pulled.check_law(u, "winkler", 2. * a, -s);
    check("a node on the kink has an interval",
          kink.law_violation == 0. && kink.nodes[0].state == BondState::kink &&
            near(kink.nodes[0].allowed_force.lower, 2. * force) &&
            kink.nodes[0].allowed_force.upper == 0.);

    // Far beyond the kink the law allows no force, and the kink is too far
    // away to help: the force itself is the distance.
    const double M   = -s / 10.;
    const auto   far = pulled.check_law(u, "winkler", a * s / (-0.01 * M), M);
    check("a node far beyond the kink by a known distance",
          near(far.law_violation, 1.) &&
            far.nodes[0].state == BondState::broken);

    // Held at zero against a pull, F, while the bonds give at most twice delta
    // F for a distance delta.
    const auto   held = pulled.equilibrium(0.);
    const double pull =
      -pulled.check_law(held, "none", 0., 1.).nodes[0].normal_force;
    const double M_held = 1e-4;
    const double a_held = pull / (0.1 * M_held * node.measure);
    check("a node in contact that is pulled by a known distance",
          near(pulled.check_law(held, "winkler", a_held, M_held).law_violation,
               0.5));

    // Pressed on the foundation: on the graph at 0, off it by the distance
    // from 0 on either side.
    const Body<2> pressed(young_modulus, -1.);
    const auto    at_zero = pressed.equilibrium(0.);
    const double  push =
      pressed.check_law(at_zero, "none", 0., 1.).nodes[0].normal_force;
    check("the foundation has to push", push > 1e-5 * scale);
    // The bonds bear half of the push.
    const double a_pressed = push / (2. * M_held * node.measure);
    const auto   in_contact =
      pressed.check_law(at_zero, "winkler", a_pressed, M_held);
    check("a node in contact on the graph",
          in_contact.law_violation == 0. && in_contact.penetration == 0. &&
            in_contact.nodes[0].state == BondState::contact &&
            in_contact.nodes[0].allowed_force.lower == 0. &&
            std::isinf(in_contact.nodes[0].allowed_force.upper));

    expected = true;
    for (const double e : {1e-15, 1e-8, 1e-2})
      for (const double sign : {-1., 1.})
        {
          const double distance = sign * e * M_held;
          const auto   off = pressed.check_law(pressed.equilibrium(distance),
                                             "winkler",
                                             a_pressed,
                                             M_held);
          expected &= near(off.law_violation, e) &&
                      off.penetration == std::max(0., distance) &&
                      off.count(e < 1e-3 || sign > 0. ? BondState::contact :
                                                        BondState::bonded) == 1;
        }
    check("gap and penetration under pressure by a known distance", expected);

    // Without adhesion displacements and forces are measured by the largest
    // ones.
    check("without adhesion, on the graph",
          pressed.check_law(at_zero, "none", 0., 1.).law_violation == 0.);
    const DofVector penetrating = pressed.equilibrium(1e-5);
    const auto off_by_little = pressed.check_law(penetrating, "none", 0., 1.);
    check("without adhesion, off the graph",
          near(pulled.check_law(u, "none", 0., 1.).law_violation, 1.) &&
            near(pulled.check_law(held, "winkler", 0., 1.).law_violation, 1.) &&
            near(off_by_little.law_violation,
                 1e-5 / penetrating.linfty_norm()));
  }



  /// A free node that is not in equilibrium shows in the residual and in the
  /// balance of forces.
  void
  test_residual(const double young_modulus)
  {
    section("Residual, E = ", young_modulus);
    const Body<2>   body(young_modulus, 1.);
    const auto     &unknowns = body.problem->unknowns();
    const double    a = young_modulus / 10., M = 1e-3;
    const DofVector u = body.equilibrium(-M / 2.);
    check("free nodes are in equilibrium",
          body.check_law(u, "winkler", a, M).equilibrium_residual,
          1e-13);

    const auto       &normals = unknowns.contact().normal_dofs();
    std::vector<bool> is_free(unknowns.n_dofs());
    for (unsigned int i = 0; i < is_free.size(); ++i)
      is_free[i] =
        !unknowns.is_constrained(i) &&
        std::find(normals.begin(), normals.end(), i) == normals.end();
    const auto dof =
      std::find(is_free.begin(), is_free.end(), true) - is_free.begin();
    DofVector wrong = u;
    wrong(dof) += 1e-2 * M;
    DofVector forces(u.size());
    body.problem->matrix().vmult(forces, wrong);
    forces -= body.problem->load();
    const DofVector reactions = body.problem->fields().residual(wrong);
    double          free = 0., supported = 0.;
    for (unsigned int i = 0; i < is_free.size(); ++i)
      raise(is_free[i] ? free : supported,
            std::abs(is_free[i] ? forces(i) : reactions(i)));
    const auto off = body.check_law(wrong, "winkler", a, M);
    check("a free node that is not shows in the residual",
          near(off.equilibrium_residual, free / supported) &&
            off.equilibrium_residual > 1e-3);
    check("and in the balance", off.force_imbalance > 1e-5);
    wrong(dof) = std::nan("");
    print_error([&] { body.check_law(wrong, "winkler", a, M); });
  }



} // namespace



int
main()
{
  for (const double young_modulus : {69., 6.9e10})
    {
      test_law_violation(young_modulus);
      test_residual(young_modulus);
    }
}
