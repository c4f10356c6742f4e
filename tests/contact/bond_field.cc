// SPDX-License-Identifier: LGPL-2.1-or-later
// Two faces that meet in a node, each with bonds of its own, against the sum of
// the faces' energies.

#include <debond/contact/adhesion_integral.h>
#include <debond/contact/laws/softening.h>
#include <debond/contact/laws/winkler.h>

#include <cmath>

#include "../check.h"

using namespace Debond;

namespace
{
  constexpr double a_1 = 2., M_1 = 0.5, a_2 = 3., M_2 = 0.2;
  constexpr double length_1 = 1., length_2 = 0.5;



  /// Faces from 0 to length_1 to length_1 + length_2 with ids 1 and 2.
  ContactBoundary<2>
  two_faces()
  {
    ContactBoundary<2> boundary;
    for (const double x : {0., length_1, length_1 + length_2})
      {
        ContactBoundary<2>::Node node = {};
        node.position                 = dealii::Point<2>(x, 0.);
        boundary.nodes.push_back(node);
      }
    for (unsigned int f = 0; f < 2; ++f)
      {
        ContactBoundary<2>::Face face = {};
        face.nodes                    = {{f, f + 1}};
        face.vertices                 = {
                          {boundary.nodes[f].position, boundary.nodes[f + 1].position}};
        face.measure = f == 0 ? length_1 : length_2;
        face.id      = f + 1;
        boundary.faces.push_back(face);
      }
    return boundary;
  }



  BondField<2>
  field(const AdhesiveLaw &law, const double a, const double M)
  {
    const auto constant = [](const double value) {
      return std::make_shared<const dealii::Functions::ConstantFunction<2>>(
        value);
    };
    return {law,
            {"", nullptr, nullptr, nullptr},
            {{2, {"second", constant(a), constant(M), nullptr}}}};
  }



  double
  j(const double a, const double M, const double s)
  {
    return 0.5 * a * std::min(s * s, M * M);
  }
} // namespace



int
main(int argc, char **)
{
  print_figures                     = argc > 1;
  const ContactBoundary<2> boundary = two_faces();
  const AdhesiveLaw        law(winkler_law(a_1, M_1).pieces);
  const BondField<2> two = field(law, a_2, M_2), equal = field(law, a_1, M_1);
  const auto         rule = [&](const std::string &name) {
    return ContactQuadrature<2>(ContactQuadratureParameters::parse(name));
  };
  const ContactQuadrature<2> nodal = rule("nodal");

  Eigen::VectorXd s(3);
  const auto      traces = [&](const double scale) {
    for (unsigned int i = 0; i < 3; ++i)
      s(i) = -scale * (1. + 0.3 * i);
  };
  const auto by_vertices = [&] {
    return length_1 / 2. * (j(a_1, M_1, s(0)) + j(a_1, M_1, s(1))) +
           length_2 / 2. * (j(a_2, M_2, s(1)) + j(a_2, M_2, s(2)));
  };
  const auto relative = [](const double value, const double expected) {
    return std::abs(value / expected - 1.);
  };

  {
    const AdhesionIntegral<2> phi(boundary, law, nodal, &two);
    check("nodes have a law each", phi.points().is_nodal());
    traces(0.01);
    check("nodal energy of bonds that hold",
          relative(phi.value(s), by_vertices()),
          1e-14);
    traces(10.);
    check("of broken ones", relative(phi.value(s), by_vertices()), 1e-14);
    const BondScale bonds = phi.points().bonds_at(1);
    const double    a     = (length_1 * a_1 + length_2 * a_2) / 1.5,
                 G = (length_1 * a_1 * M_1 * M_1 + length_2 * a_2 * M_2 * M_2) /
                     3.;
    check("threshold where they meet",
          relative(bonds.length * M_1, std::sqrt(2. * G / a)),
          1e-14);
    check("which is the faces'",
          phi.points().list()[1].bonds.length == bonds.length);
    check("the second one's alone",
          relative(phi.points().bonds_at(2).length * M_1, M_2),
          1e-14);
  }
  {
    const AdhesionIntegral<2> phi(boundary, law, nodal, &equal);
    const AdhesionIntegral<2> one(boundary, law, nodal);
    traces(0.3);
    check("equal bonds, to the last bit", phi.value(s) == one.value(s));
  }
  {
    // k (1 - x) as it is written, with rounding at its end: zero. More than
    // that is negative.
    const auto below_zero = [&law](const double value) {
      return BondField<2>(
        law,
        {"",
         std::make_shared<dealii::ScalarFunctionFromFunctionObject<2>>(
           [value](const dealii::Point<2> &) { return value; }),
         nullptr,
         nullptr},
        {});
    };
    check("a stiffness that rounding makes negative is none",
          below_zero(-2e-16 * a_1).at({1., 0.}, 0).energy == 0.);
    bool is_refused = false;
    try
      {
        below_zero(-1e-9 * a_1).at({1., 0.}, 0);
      }
    catch (const BondFieldError &)
      {
        is_refused = true;
      }
    check("a negative one is refused", is_refused);
  }
  // A bilinear law of stiffness K and strength N that takes G, from one that
  // takes less: the traction falls to 0 at 2 G / N. The damage of an opening d
  // is 1 - N (2 G / N - d) / (2 G / N - N / K) / (K d).
  {
    const double      K = 50., N = 2., G = 0.3, first = N / K, end = 2. * G / N;
    const double      less = 0.1;
    const AdhesiveLaw base(bilinear_law({K, N, less}).pieces);
    const AdhesiveLaw longer =
      base.with_tail((G - N * first / 2.) / (less - N * first / 2.));
    const auto traction = [&](const double d) {
      return N * (end - d) / (end - first);
    };
    check("what it takes", relative(longer.pieces().largest_value(), G), 1e-13);
    check("its end", relative(longer.bond_threshold(), end), 1e-13);
    for (const double d : {0.05, 0.1, 0.25})
      {
        check("traction", relative(-longer.derivative(-d), traction(d)), 1e-13);
        check("damage",
              relative(longer.damage(-d), 1. - traction(d) / (K * d)),
              1e-13);
        const double there = base.reached_as(longer, -d);
        check("the same damage on the shorter one",
              relative(base.damage(there), longer.damage(-d)),
              1e-13);
        check("and back", relative(longer.reached_as(base, there), -d), 1e-12);
      }
    check("without damage there is nothing to be carried over",
          base.reached_as(longer, -0.5 * first) == -0.5 * first);
  }
}
