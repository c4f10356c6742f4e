// SPDX-License-Identifier: LGPL-2.1-or-later
// Which loads pull strips and plates off, beside closed forms: the foundation
// bears a resultant that presses within its boundary, and a body comes off by
// turning about the edge that it presses beyond.

#include <debond/check/coming_off.h>
#include <debond/solve/scene.h>

#include <cmath>
#include <string>
#include <vector>

#include "../check.h"
#include "../program/parameters_of.h"

using namespace Debond;

namespace
{
  constexpr double tolerance = 1e-9;

  /// A length and a modulus in some units.
  struct Units
  {
    std::string name;
    double      length, modulus;
  };



  template <int dim>
  std::optional<ComingOff<dim>>
  of(const Values &assignments, const double load_factor = 1.)
  {
    const Scene<dim> scene(parameters_of(assignments));
    return coming_off(scene.problem(), scene.law(), load_factor);
  }



  /// The motion at the middle of the contact boundary and what the loads do, of
  /// which terms as large as @p work_of_all may cancel.
  template <int dim>
  void
  check_motion(const std::string                   &name,
               const std::optional<ComingOff<dim>> &off,
               const double                         translation,
               const std::vector<double>           &rotation,
               const double                         work,
               const double                         work_of_all)
  {
    if (!off)
      {
        check(name, false);
        return;
      }
    double largest = 1.,
           error   = std::abs(off->motion.translation[1] - translation);
    for (unsigned int d = 0; d < dim; ++d)
      if (d != 1)
        error = std::max(error, std::abs(off->motion.translation[d]));
    for (const double value : rotation)
      largest = std::max(largest, std::abs(value));
    for (unsigned int i = 0; i < rotation.size(); ++i)
      error =
        std::max(error,
                 std::abs(off->motion.rotation[i] - rotation[i]) / largest);
    check(name + ", motion", error, tolerance);
    check(name + ", work", std::abs(off->work - work) / work_of_all, tolerance);
    check(name + ", not towards the foundation",
          off->towards_foundation,
          tolerance);
  }



  /// A strip 100 times as long as high, which nothing but bonds holds.
  Values
  strip(const Units &units)
  {
    const double L = units.length;
    return {"Dimension=2",
            "Mesh/Lengths=" + text(L) + ", " + text(0.01 * L),
            "Mesh/Cells=50, 1",
            "Material/Young modulus=" + text(70. * units.modulus),
            "Boundary conditions/Clamped boundaries=",
            "Boundary conditions/Contact boundary=bottom",
            "Contact law/Tangential displacement=fixed",
            "Contact law/Bond stiffness=" +
              text(100. * units.modulus / units.length),
            "Contact law/Bond threshold=" + text(1e-5 * L)};
  }



  void
  test_strip(const Units &units)
  {
    std::cout << "== Strip, " << units.name << std::endl;
    const double L = units.length, p = 1e-3 * units.modulus;
    const Values scene = strip(units);
    const auto   top   = [](const std::string &pressure) {
      return Values{"Loads/Traction top=0; " + pressure};
    };
    // Its resultant presses with p L, `part` of the half from the middle.
    const auto pressed_at = [&](const double part) {
      return top(text(-p) + "*(1 + " + text(6. * part / L) + "*(x - " +
                 text(0.5 * L) + "))");
    };

    check_motion(
      "pulled at the top", of<2>(scene + top(text(p))), 1., {0.}, p * L, p * L);
    check_motion("a third of the load",
                 of<2>(scene + top(text(p)), 1. / 3.),
                 1.,
                 {0.},
                 p * L / 3.,
                 p * L);
    check("pulled the other way",
          !of<2>(scene + top(text(p)), -1.).has_value());
    for (const double part : {0., 0.9, -0.99999})
      check("pressed at " + text(part) + " of the half",
            !of<2>(scene + pressed_at(part)).has_value());
    for (const double part : {1.00001, 1.5, -3.})
      check_motion("pressed at " + text(part) + " of the half",
                   of<2>(scene + pressed_at(part)),
                   0.5,
                   {(part < 0. ? 1. : -1.) / L},
                   0.5 * p * L * (std::abs(part) - 1.),
                   p * L);
    // The moment about the end on which it would turn is zero.
    check("lifted at its end as it is pressed",
          !of<2>(scene + top(text(-p)) +
                 Values{"Loads/Traction right=0; " + text(49.999 * p)})
             .has_value());
    check("lifted at its end a little more",
          of<2>(scene + top(text(-p)) +
                Values{"Loads/Traction right=0; " + text(50.001 * p)})
            .has_value());
    check("drawn along the foundation",
          !of<2>(scene + Values{"Loads/Traction top=" + text(p) + "; 0"} +
                 Values{"Loads/Traction bottom=" + text(-p) + "; " + text(-p)})
             .has_value());

    // With its left end between rollers it can only be lifted.
    const Values guided =
      scene + Values{"Boundary conditions/Roller boundaries=left"};
    check("guided and pressed beyond its end",
          !of<2>(guided + pressed_at(1.5)).has_value());
    check_motion("guided and pulled at its end",
                 of<2>(guided + Values{"Loads/Traction right=0; " + text(p)}),
                 1.,
                 {0.},
                 0.01 * p * L,
                 p * L);
    check("clamped at its end",
          !of<2>(scene + top(text(p)) +
                 Values{"Boundary conditions/Clamped boundaries=right"})
             .has_value());
    check("without a load", !of<2>(scene).has_value());
  }



  /// Turned by an angle, it does the same in its own directions.
  void
  test_turned(const Units &units, const double degrees)
  {
    std::cout << "== Turned by " << degrees << ", " << units.name << std::endl;
    const double angle = degrees * std::acos(-1.) / 180.,
                 p     = 1e-3 * units.modulus;
    const auto off     = of<2>(
      strip(units) + Values{"Mesh/Rotation=" + text(degrees),
                            "Loads/Traction top=" + text(-p * std::sin(angle)) +
                              "; " + text(p * std::cos(angle))});
    check("comes off", off.has_value());
    if (!off)
      return;
    check("along its normal",
          std::hypot(off->motion.translation[0] + std::sin(angle),
                     off->motion.translation[1] - std::cos(angle)),
          tolerance);
    check("work", std::abs(off->work / (p * units.length) - 1.), tolerance);
  }



  /// A plate of 1 x 0.02 x 0.5 whose lower side is the foundation's.
  void
  test_plate(const Units &units)
  {
    std::cout << "== Plate, " << units.name << std::endl;
    const double L = units.length, p = 1e-3 * units.modulus, area = 0.5 * L * L;
    const Values scene = {"Dimension=3",
                          "Mesh/Lengths=" + text(L) + ", " + text(0.02 * L) +
                            ", " + text(0.5 * L),
                          "Mesh/Cells=6, 1, 4",
                          "Material/Young modulus=" + text(70. * units.modulus),
                          "Boundary conditions/Clamped boundaries=",
                          "Boundary conditions/Contact boundary=bottom",
                          "Contact law/Law=none",
                          "Contact law/Tangential displacement=fixed"};
    const auto   top   = [](const std::string &pressure) {
      return Values{"Loads/Traction top=0; " + pressure + "; 0"};
    };
    /// The resultant presses at these parts of the half length and width.
    const auto pressed_at = [&](const double along, const double across) {
      return top(text(-p) + "*(1 + " + text(6. * along / L) + "*(x - " +
                 text(0.5 * L) + ") + " + text(12. * across / L) + "*(z - " +
                 text(0.25 * L) + "))");
    };

    check_motion("pulled at the top",
                 of<3>(scene + top(text(p))),
                 1.,
                 {0., 0., 0.},
                 p * area,
                 p * area);
    for (const double across : {0.5, -0.999})
      check("pressed at " + text(across) + " of the half width",
            !of<3>(scene + pressed_at(0., across)).has_value());
    // About x, the far side in z goes up if the other is pressed.
    for (const double across : {1.001, -2.})
      check_motion("pressed at " + text(across) + " of the half width",
                   of<3>(scene + pressed_at(0., across)),
                   0.5,
                   {(across > 0. ? 2. : -2.) / L, 0., 0.},
                   0.5 * p * area * (std::abs(across) - 1.),
                   p * area);
    check_motion("pressed at 1.001 of the half length",
                 of<3>(scene + pressed_at(1.001, 0.)),
                 0.5,
                 {0., 0., -1. / L},
                 0.5 * p * area * 0.001,
                 p * area);
    // Near a corner, within and beyond the edges.
    check("pressed at a corner, within",
          !of<3>(scene + pressed_at(0.99, -0.99)).has_value());
    const auto off = of<3>(scene + pressed_at(1.01, -1.01));
    check("pressed at a corner, beyond", off.has_value());
    if (!off)
      return;
    const dealii::Tensor<1, 3> there = off->motion(
      off->motion.centre + dealii::Tensor<1, 3>({0.505 * L, 0., -0.2525 * L}));
    check("what the resultant does along the motion",
          std::abs(-p * area * there[1] / off->work - 1.),
          1e-7);
    for (const double x : {-0.5, 0.5})
      for (const double z : {-0.25, 0.25})
        {
          const double up = off->motion(
            off->motion.centre + dealii::Tensor<1, 3>({x * L, 0., z * L}))[1];
          check("corners do not go down", -up, tolerance);
        }

    // It slides between planes of symmetry, in which it cannot turn.
    const Values sliding =
      scene + Values{"Contact law/Tangential displacement=free",
                     "Boundary conditions/Roller boundaries=left, back"};
    check("between planes of symmetry, pressed beyond its end",
          !of<3>(sliding + pressed_at(3., 0.5)).has_value());
    check_motion("between planes of symmetry, lifted at its end",
                 of<3>(sliding +
                       Values{"Loads/Traction right=0; " + text(p) + "; 0"}),
                 1.,
                 {0., 0., 0.},
                 0.01 * p * L * L,
                 p * area);
    check("clamped along one edge",
          !of<3>(scene + top(text(p)) +
                 Values{"Boundary conditions/Clamped boundaries=back"})
             .has_value());
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;
  for (const Units &units : {Units{"GPa and m", 1., 1.},
                             Units{"Pa and m", 1., 1e9},
                             Units{"MPa and mm", 1e3, 1e3}})
    {
      test_strip(units);
      test_turned(units, 30.);
      test_turned(units, -120.);
      test_plate(units);
    }
}
