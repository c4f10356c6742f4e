// SPDX-License-Identifier: LGPL-2.1-or-later
// Two faces that meet in a node, each with bonds of its own, against the sum of
// the faces' energies. Bonds that vary with the exact rule, against sampling of
// what it stands for and against the bonds themselves.

#include <debond/contact/adhesion_integral.h>
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
  field(const double a, const double M)
  {
    const auto constant = [](const double value) {
      return std::make_shared<const dealii::Functions::ConstantFunction<2>>(
        value);
    };
    return {a_1,
            M_1,
            {"", nullptr, nullptr},
            {{2, {"second", constant(a), constant(M)}}}};
  }



  double
  j(const double a, const double M, const double s)
  {
    return 0.5 * a * std::min(s * s, M * M);
  }



  /// Bonds that vary with the place, relative to a_1 and M_1.
  template <int dim>
  double
  stiffness_at(const dealii::Point<dim> &point)
  {
    return 2. + std::sin(3. * point[0]) + (dim == 3 ? point[dim - 1] : 0.);
  }

  template <int dim>
  double
  threshold_at(const dealii::Point<dim> &point)
  {
    return 0.2 + 0.1 * point[0] * point[0];
  }



  template <int dim>
  BondField<dim>
  varying_field()
  {
    const auto function = [](double (*f)(const dealii::Point<dim> &)) {
      return std::make_shared<
        const dealii::ScalarFunctionFromFunctionObject<dim>>(f);
    };
    return {a_1,
            M_1,
            {"", function(&stiffness_at<dim>), function(&threshold_at<dim>)},
            {}};
  }



  /// n faces from 0 to 1, or 2 n^2 triangles of a unit square.
  template <int dim>
  ContactBoundary<dim>
  uniform_boundary(const unsigned int n)
  {
    ContactBoundary<dim> boundary;
    const unsigned int   rows = dim == 2 ? 1 : n + 1;
    for (unsigned int j = 0; j < rows; ++j)
      for (unsigned int i = 0; i <= n; ++i)
        {
          typename ContactBoundary<dim>::Node node = {};
          node.position[0]                         = double(i) / n;
          if (dim == 3)
            node.position[dim - 1] = double(j) / n;
          boundary.nodes.push_back(node);
        }
    const auto add = [&](const std::array<unsigned int, dim> &nodes) {
      typename ContactBoundary<dim>::Face face = {};
      face.nodes                               = nodes;
      for (unsigned int k = 0; k < dim; ++k)
        face.vertices[k] = boundary.nodes[nodes[k]].position;
      face.measure = dim == 2 ? 1. / n : 0.5 / (n * n);
      boundary.faces.push_back(face);
    };
    for (unsigned int i = 0; i < n; ++i)
      if constexpr (dim == 2)
        add({{i, i + 1}});
      else
        for (unsigned int j = 0; j < n; ++j)
          {
            const unsigned int corner = j * (n + 1) + i, above = corner + n + 1;
            add({{corner, corner + 1, above + 1}});
            add({{corner, above, above + 1}});
          }
    return boundary;
  }



  template <int dim>
  Eigen::VectorXd
  varying_trace(const ContactBoundary<dim> &boundary)
  {
    Eigen::VectorXd s(boundary.nodes.size());
    for (unsigned int i = 0; i < s.size(); ++i)
      {
        const auto &x = boundary.nodes[i].position;
        s(i)          = -0.4 * x[0] - (dim == 3 ? 0.1 * x[dim - 1] : 0.);
      }
    return s;
  }



  /// The energy by midpoints of n^(dim - 1) pieces of each face.
  template <int dim>
  double
  sampled(const ContactBoundary<dim> &boundary,
          const Eigen::VectorXd      &s,
          const unsigned int          n)
  {
    double sum = 0.;
    for (const auto &face : boundary.faces)
      {
        const auto add = [&](const std::array<double, 3> &shape,
                             const double                 weight) {
          double             trace = 0.;
          dealii::Point<dim> point;
          for (unsigned int k = 0; k < dim; ++k)
            {
              trace += shape[k] * s(face.nodes[k]);
              point += shape[k] * face.vertices[k];
            }
          sum += face.measure * weight *
                 j(stiffness_at(point), threshold_at(point), trace);
        };
        for (unsigned int i = 0; i < n; ++i)
          if constexpr (dim == 2)
            add({{(i + 0.5) / n, 1. - (i + 0.5) / n, 0.}}, 1. / n);
          else
            for (unsigned int l = 0; i + l < n; ++l)
              {
                const double weight = 1. / (n * n), third = 1. / 3.;
                const auto   at = [&](const double p, const double q) {
                  add({{p / n, q / n, 1. - (p + q) / n}}, weight);
                };
                at(i + third, l + third);
                if (i + l + 1 < n)
                  at(i + 2. * third, l + 2. * third);
              }
      }
    return sum;
  }



  template <int dim>
  void
  test_varying_bonds()
  {
    std::cout << "Bonds that vary, " << dim << "D\n";
    const AdhesiveLaw            law(winkler_law(a_1, M_1).branches);
    const BondField<dim>         field = varying_field<dim>();
    const ContactQuadrature<dim> gauss(
      ContactQuadratureParameters::parse("gauss 7"));
    double error = 0.;
    for (const unsigned int n : {4u, 8u, 16u})
      {
        const ContactBoundary<dim>  boundary = uniform_boundary<dim>(n);
        const AdhesionIntegral<dim> phi(boundary, law, gauss, &field);
        const Eigen::VectorXd       s     = varying_trace(boundary);
        const double                value = phi.value(s);
        // The trace is linear, and the sum that of the bonds themselves.
        error = std::abs(
          value / sampled(boundary, s, (dim == 2 ? 32000 : 512) / n) - 1.);
        if (n > 4)
          continue;
        const Eigen::VectorXd xi         = phi.subgradient(s);
        double                difference = 0., largest = 0.;
        for (unsigned int i = 0; i < s.size(); ++i)
          {
            constexpr double step  = 1e-6;
            Eigen::VectorXd  above = s, below = s;
            above(i) += step;
            below(i) -= step;
            difference =
              std::max(difference,
                       std::abs((phi.value(above) - phi.value(below)) /
                                  (2. * step) -
                                xi(i)));
            largest = std::max(largest, std::abs(xi(i)));
          }
        check("derivative beside differences", difference / largest, 1e-6);
      }
    check("error beside sampling on the finest", error, 1e-3);
  }
} // namespace



int
main(int argc, char **)
{
  print_figures                     = argc > 1;
  const ContactBoundary<2> boundary = two_faces();
  const AdhesiveLaw        law(winkler_law(a_1, M_1).branches);
  const BondField<2>       two = field(a_2, M_2), equal = field(a_1, M_1);
  const auto               rule = [&](const std::string &name) {
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
    check("nodes have a law each", phi.is_separable());
    traces(0.01);
    check("nodal energy of bonds that hold",
          relative(phi.value(s), by_vertices()),
          1e-14);
    traces(10.);
    check("of broken ones", relative(phi.value(s), by_vertices()), 1e-14);
    const BondScale bonds = phi.bonds_at(1);
    const double    a     = (length_1 * a_1 + length_2 * a_2) / 1.5,
                 G = (length_1 * a_1 * M_1 * M_1 + length_2 * a_2 * M_2 * M_2) /
                     3.;
    check("threshold where they meet",
          relative(bonds.stretch * M_1, std::sqrt(2. * G / a)),
          1e-14);
    check("which is the faces'",
          phi.bonds_at(boundary.faces[1], 0).stretch == bonds.stretch &&
            phi.bonds_at(boundary.faces[0], 1).stretch == bonds.stretch);
    check("the second one's alone",
          relative(phi.bonds_at(2).stretch * M_1, M_2),
          1e-14);
  }
  {
    const AdhesionIntegral<2> phi(boundary, law, nodal, &equal);
    const AdhesionIntegral<2> one(boundary, law, nodal);
    traces(0.3);
    check("equal bonds, to the last bit", phi.value(s) == one.value(s));
  }
  test_varying_bonds<2>();
  test_varying_bonds<3>();
  {
    // k (1 - x) as it is written, with rounding at its end: zero. More than
    // that is negative.
    const auto below_zero = [](const double value) {
      return BondField<2>(
        a_1,
        M_1,
        {"",
         std::make_shared<dealii::ScalarFunctionFromFunctionObject<2>>(
           [value](const dealii::Point<2> &) { return value; }),
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
}
