// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The adhesion of linear and quadratic traces: the Bernstein basis, the
// integral against fine sums, its subgradient and curvature against finite
// differences, the allowed forces, the broken zone and the rules that there
// are.

#include <deal.II/base/numbers.h>

#include <debond/certify/exact_energy.h>
#include <debond/check/broken_zone.h>
#include <debond/contact/adhesion_integral.h>
#include <debond/contact/boundary_graph.h>
#include <debond/contact/laws/winkler.h>

#include <cmath>
#include <iostream>
#include <random>

#include "../check.h"

using namespace Debond;

constexpr unsigned int fixed = dealii::numbers::invalid_unsigned_int;



template <std::size_t n>
std::array<double, n>
random_point(std::mt19937 &random)
{
  std::uniform_real_distribution<double> unit(0., 1.);
  std::array<double, n>                  point;
  double                                 sum = 0.;
  for (double &coordinate : point)
    sum += coordinate = -std::log(unit(random));
  for (double &coordinate : point)
    coordinate /= sum;
  return point;
}



template <std::size_t n>
void
test_basis()
{
  std::mt19937 random(1);
  double       sum_error = 0., affine_error = 0.;
  bool         positive = true;
  for (unsigned int trial = 0; trial < 100; ++trial)
    {
      const std::array<double, n> point = random_point<n>(random);
      // An affine function has its values in the middles of edges as
      // coefficients.
      const auto affine = [](const std::array<double, n> &x) {
        double value = 0.3;
        for (unsigned int v = 0; v < n; ++v)
          value += (1. + v * v) * x[v];
        return value;
      };
      const auto basis = bernstein(point, 2);
      double     sum = 0., value = 0.;
      for (unsigned int k = 0; k < basis.size(); ++k)
        {
          std::array<double, n> position = {};
          if (k < n)
            position[k] = 1.;
          else
            for (const unsigned int end : simplex_edges[k - n])
              position[end] = 0.5;
          sum += basis[k];
          positive = positive && basis[k] >= 0.;
          value += basis[k] * affine(position);
        }
      raise(sum_error, std::abs(sum - 1.));
      raise(affine_error, std::abs(value - affine(point)));
    }
  const std::string vertices = std::to_string(n) + " vertices";
  check("basis on " + vertices + ", sum", sum_error, 1e-14);
  check("basis on " + vertices + ", affine functions", affine_error, 1e-14);
  check("basis on " + vertices + ", nowhere negative", positive);
}



/// Beside the values on a fine lattice, which miss the least and the largest
/// one by the square of its width; it is exact on affine functions.
template <std::size_t n>
void
test_range()
{
  constexpr unsigned int                 width = 200;
  std::mt19937                           random(5);
  std::uniform_real_distribution<double> unit(-1., 1.);
  double                                 error = 0., affine_error = 0.;
  for (unsigned int trial = 0; trial < 50; ++trial)
    {
      std::array<double, n_coefficients(n, 2)> quadratic, affine;
      for (double &coefficient : quadratic)
        coefficient = unit(random);
      std::copy_n(quadratic.begin(), n, affine.begin());
      for (unsigned int e = 0; e < n_simplex_edges(n); ++e)
        affine[n + e] =
          0.5 * (affine[simplex_edges[e][0]] + affine[simplex_edges[e][1]]);
      std::pair<double, double> sampled(1e300, -1e300);
      for (unsigned int i = 0; i <= width; ++i)
        for (unsigned int j = 0; j <= (n == 2 ? 0 : width - i); ++j)
          {
            std::array<double, n> point = {};
            point[0]                    = double(i) / width;
            point[n - 2] += n == 2 ? 0. : double(j) / width;
            point[n - 1]     = double(width - i - j) / width;
            const auto basis = bernstein(point, 2);
            double     value = 0.;
            for (unsigned int k = 0; k < basis.size(); ++k)
              value += basis[k] * quadratic[k];
            sampled.first = std::min(sampled.first, value);
            raise(sampled.second, value);
          }
      const auto range = range_on_simplex<n>(quadratic, 2);
      error            = std::max({error,
                                   std::abs(range.first - sampled.first),
                                   std::abs(range.second - sampled.second)});
      const auto ends = std::minmax_element(affine.begin(), affine.begin() + n);
      const auto of_one = range_on_simplex<n>(affine, 1),
                 of_two = range_on_simplex<n>(affine, 2);
      affine_error      = std::max({affine_error,
                                    std::abs(of_one.first - *ends.first),
                                    std::abs(of_one.second - *ends.second),
                                    std::abs(of_two.first - *ends.first),
                                    std::abs(of_two.second - *ends.second)});
    }
  const std::string vertices = std::to_string(n) + " vertices";
  check("range on " + vertices, error, 1e-4);
  check("range on " + vertices + ", affine functions", affine_error, 1e-15);
}



/// Two lines, or two triangles with a common edge; one node is held.
template <int dim>
ContactBoundary<dim>
make_boundary(const unsigned int degree = 2)
{
  ContactBoundary<dim> boundary;
  boundary.degree = degree;
  boundary.faces.resize(2);
  auto &first = boundary.faces[0], &second = boundary.faces[1];
  if constexpr (dim == 2)
    {
      first.nodes       = {{0, 1}};
      first.edge_nodes  = {{2}};
      second.nodes      = {{1, fixed}};
      second.edge_nodes = {{3}};
    }
  else
    {
      first.nodes       = {{0, 1, 2}};
      first.edge_nodes  = {{3, 4, 5}};
      second.nodes      = {{2, 1, fixed}};
      second.edge_nodes = {{4, 6, 7}};
    }
  first.measure  = 0.2;
  second.measure = 0.3;
  boundary.nodes.resize(degree == 1 ? dim : dim == 2 ? 4 : 8);
  for (auto &face : boundary.faces)
    {
      if (degree == 1)
        face.edge_nodes.fill(fixed);
      for (const unsigned int node : face.nodes)
        if (node != fixed)
          boundary.nodes[node].measure += face.measure / dim;
    }
  return boundary;
}



/// int j_1 by a very fine sum.
template <int dim>
double
fine_sum(const ContactBoundary<dim>  &boundary,
         const AdhesionIntegral<dim> &integral,
         const AdhesiveLaw           &law,
         const Eigen::VectorXd       &s)
{
  const unsigned int n   = dim == 2 ? 100000 : 600;
  double             sum = 0.;
  for (const auto &face : boundary.faces)
    if constexpr (dim == 2)
      for (unsigned int i = 0; i < n; ++i)
        {
          const double x = (i + 0.5) / n;
          sum += face.measure / n *
                 law.value(integral.points().trace(face, {{1. - x, x}}, s));
        }
    else
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; i + j < n; ++j)
          for (unsigned int side = 0; side < (i + j + 1 < n ? 2u : 1u); ++side)
            {
              const double x = (i + (1. + side) / 3.) / n;
              const double y = (j + (1. + side) / 3.) / n;
              sum += face.measure / (n * n) *
                     law.value(
                       integral.points().trace(face, {{1. - x - y, x, y}}, s));
            }
  return sum;
}



/// @p tolerance: of the value, 0 if the rule is for sums over nodes.
template <int dim>
void
test_integral(const unsigned int degree,
              const std::string &rule,
              const double       tolerance)
{
  const double                 a = 69., M = 0.002;
  const ContactBoundary<dim>   boundary = make_boundary<dim>(degree);
  const AdhesiveLaw            law(winkler_law(a, M).pieces);
  const ContactQuadrature<dim> quadrature(
    ContactQuadratureParameters::parse(rule), degree);
  const AdhesionIntegral<dim> integral(boundary, law, quadrature);
  const unsigned int          n     = boundary.nodes.size();
  const double                scale = a * M * boundary.faces[0].measure;

  std::mt19937                           random(7);
  std::uniform_real_distribution<double> number(-2.5, 0.);
  double value_error = 0., exact_error = 0., gradient_error = 0.,
         curvature_error = 0.;
  bool intervals_hold = true, goldstein_holds = true;
  for (unsigned int trial = 0; trial < (dim == 2 ? 20 : 5); ++trial)
    {
      Eigen::VectorXd s(n);
      for (double &entry : s)
        entry = M * number(random);
      if (tolerance > 0.)
        {
          const double sum = fine_sum(boundary, integral, law, s);
          raise(value_error, std::abs(integral.value(s) - sum) / (scale * M));
          if constexpr (dim == 2)
            raise(exact_error,
                  std::abs(exact_energy(integral, boundary, law, s) - sum) /
                    (scale * M));
        }

      const Eigen::VectorXd             xi        = integral.subgradient(s);
      const Eigen::SparseMatrix<double> curvature = integral.curvature(s);
      const std::vector<Interval> clarke = integral.force_intervals(s, 0.);
      const std::vector<Interval> goldstein =
        integral.force_intervals(s, 0.2 * M);
      for (unsigned int sample = 0; sample < 10; ++sample)
        {
          Eigen::VectorXd near = s;
          for (double &entry : near)
            entry += 0.2 * M * (number(random) + 1.25) / 1.25;
          const Eigen::VectorXd of_near = integral.subgradient(near);
          for (unsigned int i = 0; i < n; ++i)
            goldstein_holds =
              goldstein_holds &&
              goldstein[i].lower <= of_near(i) + 1e-14 * scale &&
              of_near(i) <= goldstein[i].upper + 1e-14 * scale;
        }
      for (unsigned int i = 0; i < n; ++i)
        {
          const double    h     = 1e-6 * M;
          Eigen::VectorXd right = s, left = s;
          right(i) += h;
          left(i) -= h;
          raise(gradient_error,
                std::abs((integral.value(right) - integral.value(left)) /
                           (2. * h) -
                         xi(i)) /
                  scale);
          const Eigen::VectorXd xi_right = integral.subgradient(right);
          const Eigen::VectorXd xi_left  = integral.subgradient(left);
          for (unsigned int j = 0; j < n; ++j)
            raise(curvature_error,
                  std::abs((xi_right(j) - xi_left(j)) / (2. * h) -
                           curvature.coeff(j, i)) /
                    (scale / M));
          intervals_hold = intervals_hold &&
                           clarke[i].lower <= xi(i) + 1e-12 * scale &&
                           xi(i) <= clarke[i].upper + 1e-12 * scale;
          goldstein_holds = goldstein_holds &&
                            goldstein[i].lower <= clarke[i].lower &&
                            clarke[i].upper <= goldstein[i].upper;
        }
    }
  const std::string name = std::to_string(dim) + "D, degree " +
                           std::to_string(degree) + ", " + rule + ": ";
  check(name + "int j_1 against a fine sum", value_error, tolerance);
  check(name + "its exact value in 2D", exact_error, 1e-8);
  check(name + "subgradient against differences", gradient_error, 1e-6);
  // Where no point changes its piece.
  check(name + "curvature against differences", curvature_error, 1e-6);
  check(name + "the subgradient is allowed", intervals_hold);
  check(name + "within a radius all subgradients near by are", goldstein_holds);
}



/// The exact integral where all bonds hold, and where a trace touches the kink.
void
test_touching_kink()
{
  const double               a = 69., M = 0.002;
  ContactBoundary<2>         boundary = make_boundary<2>();
  const AdhesiveLaw          law(winkler_law(a, M).pieces);
  const ContactQuadrature<2> quadrature(
    ContactQuadratureParameters::parse("gauss 8"), 2);
  const AdhesionIntegral<2> integral(boundary, law, quadrature);
  Eigen::VectorXd           s = Eigen::VectorXd::Zero(4);
  // On the first face s = -4 M t (1 - t) with its least value -M in the
  // middle; the second one is closed. int (s/M)^2 = 16 / 30.
  s(2) = -2. * M;
  check("a trace that touches the kink",
        std::abs(exact_energy(integral, boundary, law, s) /
                   (0.5 * a * M * M * 16. / 30. * boundary.faces[0].measure) -
                 1.),
        1e-13);
  // Beyond -M between (1 -+ sqrt(1/2)) / 2 if it is twice as deep.
  s(2) = -4. * M;
  check("the broken zone of a parabola",
        std::abs(broken_zone(boundary, integral, s) /
                   (std::sqrt(0.5) * boundary.faces[0].measure) -
                 1.),
        1e-6);
}



void
test_broken_zone_of_triangle()
{
  const double               M        = 0.002;
  ContactBoundary<3>         boundary = make_boundary<3>();
  const AdhesiveLaw          law(winkler_law(69., M).pieces);
  const ContactQuadrature<3> quadrature(
    ContactQuadratureParameters::parse("gauss 5"), 2);
  const AdhesionIntegral<3> integral(boundary, law, quadrature);
  Eigen::VectorXd           s = Eigen::VectorXd::Zero(8);
  // s = -2 M x: broken where x > 1/2, a quarter of the first face.
  s(1) = -2. * M;
  s(3) = s(4) = -M;
  s(6)        = -M;
  check("the broken zone on a triangle",
        std::abs(
          broken_zone(boundary, integral, s) /
            (0.25 * (boundary.faces[0].measure + boundary.faces[1].measure)) -
          1.),
        1e-10);
}



void
test_refusals()
{
  for (const std::string rule : {"nodal", "midpoint"})
    {
      const auto parameters = ContactQuadratureParameters::parse(rule);
      print_error([&] { ContactQuadrature<2>(parameters, 2); });
      print_error([&] { ContactQuadrature<3>(parameters, 2); });
    }
}



int
main(int argc, char **)
{
  print_figures = argc > 1;
  test_basis<2>();
  test_basis<3>();
  test_basis<4>();
  test_range<2>();
  test_range<3>();
  for (const std::string rule : {"nodal", "midpoint"})
    {
      test_integral<2>(1, rule, 0.);
      test_integral<3>(1, rule, 0.);
    }
  test_integral<2>(1, "gauss 8", 2e-2);
  test_integral<3>(1, "gauss 7", 2e-2);
  test_integral<2>(2, "gauss 8", 2e-2);
  test_integral<3>(2, "gauss 7", 2e-2);
  test_touching_kink();
  test_broken_zone_of_triangle();
  check("neighbours of the common edge",
        neighbours(make_boundary<3>())[4].size() == 7);
  test_refusals();
}
