// SPDX-License-Identifier: LGPL-2.1-or-later

// The adhesive laws and the quadrature rules on the contact boundary, against
// closed formulas and differences.

#include <debond/base/parameter_table.h>
#include <debond/contact/laws/none.h>
#include <debond/contact/laws/stepped.h>
#include <debond/contact/laws/winkler.h>
#include <debond/contact/quadrature.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <stdexcept>

#include "../check.h"

using namespace Debond;



namespace
{
  bool
  equal(const Interval &interval,
        const double    lower,
        const double    upper,
        const double    scale)
  {
    return std::abs(interval.lower - lower) < 1e-14 * scale &&
           std::abs(interval.upper - upper) < 1e-14 * scale;
  }



  /// The law of that name with the default values of its parameters, its
  /// energies in a unit that is smaller by a factor.
  AdhesiveLaw
  default_law(const std::string &name, const double factor)
  {
    LawSection     section;
    ParameterTable table;
    section.bind(table);
    table.assign("Contact law/Law=" + name);
    std::vector<ConvexBranch> branches = section.make_law(table).branches;
    for (ConvexBranch &branch : branches)
      {
        branch.curvature *= factor;
        branch.slope *= factor;
        branch.constant *= factor;
      }
    return AdhesiveLaw(branches);
  }



  /// What every law promises, by differences on a grid that has the kinks:
  /// value, interval, curvature and kinks fit together, and for s <= 0 the law
  /// is the least of its convex quadratic branches.
  void
  test_conformance(const std::string &name, const double factor)
  {
    const AdhesiveLaw law       = default_law(name, factor);
    const bool        has_bonds = law.bond_threshold() > 0.;
    const double      a =
      has_bonds ? law.bond_strength() / law.bond_threshold() : factor;
    const double M      = has_bonds ? law.bond_threshold() : 1.;
    const double energy = a * M * M, strength = a * M, h = 1e-4 * M;
    const auto   kinks = law.kinks();

    // A quadratic by its value, slope and curvature at a point.
    struct Branch
    {
      double centre, value, slope, curvature;

      double
      operator()(const double s) const
      {
        const double d = s - centre;
        return value + slope * d + curvature / 2. * d * d;
      }
    };

    std::vector<double> ends = kinks;
    ends.insert(ends.begin(), -5. * M);
    ends.push_back(3. * M);
    double slope_error = 0., curvature_error = 0., outside = 0., negative = 0.;
    double least_curvature = 0., largest_force = 0.;
    std::vector<Branch> branches;
    for (unsigned int k = 0; k + 1 < ends.size(); ++k)
      {
        const double centre = (ends[k] + ends[k + 1]) / 2.;
        const Branch branch = {centre,
                               law.value(centre),
                               law.clarke_interval(centre).lower,
                               law.curvature(centre)};
        if (ends[k] < 0.)
          branches.push_back(branch);
        least_curvature = std::min(least_curvature, branch.curvature / a);
        for (unsigned int i = 1; i < 40; ++i)
          {
            const double s    = ends[k] + (ends[k + 1] - ends[k]) * i / 40.;
            const double left = law.value(s - h), right = law.value(s + h);
            const double slope      = (right - left) / (2. * h);
            const auto   interval   = law.clarke_interval(s);
            const double difference = (right - 2. * law.value(s) + left);
            slope_error =
              std::max({slope_error,
                        std::abs(interval.lower - slope) / strength,
                        std::abs(interval.upper - slope) / strength});
            raise(curvature_error,
                  std::abs(law.curvature(s) - difference / (h * h)) / a);
            raise(outside, std::abs(branch(s) - law.value(s)) / energy);
            raise(negative, -law.value(s) / energy);
            raise(largest_force, std::abs(interval.lower));
          }
      }

    // One-sided differences of second order at the kinks.
    double jump = 0., at_kinks = 0.;
    for (const double kink : kinks)
      {
        const auto one_sided = [&](const double step) {
          return (-3. * law.value(kink) + 4. * law.value(kink + step) -
                  law.value(kink + 2. * step)) /
                 (2. * step);
        };
        const double left = one_sided(-h), right = one_sided(h);
        const auto   interval = law.clarke_interval(kink);
        at_kinks              = std::max(
          {at_kinks,
                        std::abs(interval.lower - std::min(left, right)) / strength,
                        std::abs(interval.upper - std::max(left, right)) / strength});
        raise(largest_force, -interval.lower);
        for (const double side : {-1e-9, 1e-9})
          raise(jump,
                std::abs(law.value(kink + side * M) - law.value(kink)) /
                  energy);
      }

    // The hull of the slopes nearby, of which differences have no more and, on
    // a fine grid, hardly less.
    double goldstein = 0.;
    for (unsigned int i = 0; i < 60; ++i)
      {
        const double   s = (-2.9 + 0.0507 * i) * M, delta = 0.011 * (i % 9) * M;
        const Interval found  = law.goldstein_interval(s, delta);
        Interval       slopes = {1e300, -1e300};
        for (unsigned int k = 0; k < 400; ++k)
          {
            const double t = s + delta * (2. * k - 399.) / 400.;
            const double slope =
              (law.value(t + 1e-3 * h) - law.value(t - 1e-3 * h)) / (2e-3 * h);
            slopes.lower = std::min(slopes.lower, slope);
            raise(slopes.upper, slope);
          }
        goldstein = std::max({goldstein,
                              std::abs(slopes.lower - found.lower) / strength,
                              std::abs(slopes.upper - found.upper) / strength});
      }

    double above_least = 0.;
    for (unsigned int i = 0; i <= 500; ++i)
      {
        const double s     = -0.01 * i * M;
        double       least = std::numeric_limits<double>::infinity();
        for (const Branch &branch : branches)
          least = std::min(least, branch(s));
        raise(above_least, std::abs(least - law.value(s)) / energy);
      }

    section("Every law: ", name);
    check("kinks in ascending order, the first one at the threshold",
          std::is_sorted(kinks.begin(), kinks.end()) &&
            (kinks.empty() || law.bond_threshold() == -kinks.front()));
    check("jump at the kinks", jump, 1e-8);
    check("negative part", negative, 0.);
    check("value without displacement", std::abs(law.value(0.)), 0.);
    check("Clarke interval away from kinks against differences",
          slope_error,
          1e-8);
    check("Clarke interval at the kinks against differences", at_kinks, 1e-8);
    check("Goldstein interval against the differences nearby", goldstein, 5e-3);
    check("curvature against differences", curvature_error, 1e-4);
    check("concavity of a branch", -least_curvature, 0.);
    check("distance to one quadratic between kinks", outside, 1e-13);
    check("distance to the least of the branches", above_least, 1e-13);
    check("strength and largest force differ by",
          std::abs(largest_force - law.bond_strength()) / strength,
          1e-13);
  }



  void
  test_stepped()
  {
    section("Stepped law");
    const AdhesiveLaw law(
      stepped_law({30., 20., 4.}, {0.1, 0.2, 0.5}).branches);
    // Areas below the sawteeth.
    check("energy of three steps is the area below the force",
          std::abs(law.value(-0.1) / 0.15 - 1.) < 1e-14 &&
            std::abs(law.value(-0.2) / (0.15 + 0.3) - 1.) < 1e-14 &&
            std::abs(law.value(-9.) / (0.45 + 0.42) - 1.) < 1e-14);
    check("kinks at the thresholds",
          law.kinks() == std::vector<double>({-0.5, -0.2, -0.1, 0.}));
    check("force jumps from step to step",
          equal(law.clarke_interval(-0.1), -3., -2., 1.) &&
            equal(law.clarke_interval(-0.2), -4., -0.8, 1.) &&
            equal(law.clarke_interval(-0.5), -2., 0., 1.));
    check("threshold is the last one, strength the largest force",
          law.bond_threshold() == 0.5 &&
            std::abs(law.bond_strength() - 4.) < 1e-15);
    check("branches by name",
          law.name(0) == "bonded" && law.name(1) == "partly broken (1)" &&
            law.name(2) == "partly broken (2)" && law.name(3) == "broken" &&
            law.is_loose(3) && !law.is_loose(2));
    check("Goldstein interval across two steps",
          equal(law.goldstein_interval(-0.15, 0.1), -4., -0.8, 1.));

    const AdhesiveLaw one(stepped_law({69.}, {0.002}).branches);
    const AdhesiveLaw winkler(winkler_law(69., 0.002).branches);
    bool              same = one.kinks() == winkler.kinks();
    for (unsigned int i = 0; i < 100; ++i)
      same &= one.value(-5e-5 * i) == winkler.value(-5e-5 * i);
    check("one step is Winkler's law", same);

    LawSection     section;
    ParameterTable table;
    section.bind(table);
    for (const std::string entry : {"Law=stepped",
                                    "Stepped/Stiffnesses=69, 70",
                                    "Stepped/Thresholds=1, 2"})
      table.assign("Contact law/" + entry);
    section.make_law(table);
    for (const std::string &line : table.errors)
      std::cout << line << std::endl;
  }



  void
  test_laws()
  {
    for (const std::string &name : law_names())
      for (const double factor : {1., 1e9})
        test_conformance(name, factor);

    test_stepped();
    section("Other laws");
    const AdhesiveLaw none(no_adhesion().branches);
    check("without adhesion there is no force",
          none.value(-1.) == 0. && none.value(1.) == 0. &&
            equal(none.goldstein_interval(-1., 5.), 0., 0., 1e-300) &&
            none.curvature(-1.) == 0. && none.kinks().empty() &&
            none.bond_threshold() == 0. && none.bond_strength() == 0.);
    const AdhesiveLaw loose(winkler_law(0., 0.002).branches);
    check("bonds without stiffness count as no adhesion",
          loose.bond_threshold() == 0. && loose.bond_strength() == 0.);

    // Three meet at the kink, of which one is nowhere the least.
    const AdhesiveLaw three({{0., 0., 2.L, "far"},
                             {4., 0., 0.L, "near"},
                             {0., 0., 3.L, "above"},
                             {0., -1., 1.L, "line"}});
    check("branches by name, in their order from 0",
          three.branches().size() == 2 && three.name(0) == "near" &&
            three.name(1) == "far" && three.branches()[1].upper == -1.);

    print_error([] { winkler_law(-1., 0.002); });
    print_error([] { winkler_law(69., 0.); });
    print_error([] { winkler_law(std::nan(""), 1.); });
    print_error([] { winkler_law(69., INFINITY); });
    print_error([] { AdhesiveLaw({}); });
    print_error([] { AdhesiveLaw({{-5., 0., 0.L, "softening"}}); });
    print_error([] { AdhesiveLaw({{1., INFINITY, 0.L, "steep"}}); });
    print_error([] { AdhesiveLaw({{1., 0., 1.L, "high"}}); });
    print_error([] { AdhesiveLaw({{1., 0.5, 0.L, "pushing"}}); });
  }



  void
  test_parse()
  {
    section("Names of rules");
    using Parameters = ContactQuadratureParameters;
    check("nodal", Parameters::parse("nodal").rule == Parameters::Rule::nodal);
    check("midpoint",
          Parameters::parse("midpoint").rule == Parameters::Rule::midpoint);
    check("gauss 12",
          Parameters::parse("gauss 12").rule == Parameters::Rule::gauss &&
            Parameters::parse("gauss 12").gauss_points == 12);
    for (const std::string text : {"",
                                   "Nodal",
                                   "exact",
                                   "gauss",
                                   "gauss 0",
                                   "gauss -1",
                                   "gauss 2x",
                                   "gauss 100"})
      print_error([&] { Parameters::parse(text); });
    print_error([] { ContactQuadrature<3>(Parameters::parse("gauss 8")); });
    print_error([] { ContactQuadrature<2>({Parameters::Rule::gauss, 0}); });
  }



  /// The mean over a simplex of a product of powers of the barycentric
  /// coordinates: n! prod p_k! / (n + sum p_k)! in n dimensions.
  template <int dim>
  double
  mean_of_monomial(const std::array<unsigned int, dim> &powers)
  {
    unsigned int sum     = dim - 1;
    double       product = std::tgamma(dim);
    for (const unsigned int power : powers)
      {
        sum += power;
        product *= std::tgamma(power + 1.);
      }
    return product / std::tgamma(sum + 1.);
  }



  template <int dim>
  bool
  integrates_degree(const ContactQuadrature<dim> &quadrature,
                    const unsigned int            degree)
  {
    bool exact = true;
    for (unsigned int i = 0; i <= degree; ++i)
      for (unsigned int j = 0; i + j <= degree; ++j)
        {
          std::array<unsigned int, dim> powers = {};
          powers[0]                            = i;
          powers[1]                            = j;
          if (dim == 3)
            powers[dim - 1] = degree - i - j;
          else if (i + j != degree)
            continue;

          double mean = 0.;
          for (const auto &point : quadrature.points())
            {
              double monomial = 1.;
              for (unsigned int k = 0; k < dim; ++k)
                monomial *= std::pow(point.barycentric[k], powers[k]);
              mean += point.weight * monomial;
            }
          exact &= std::abs(mean / mean_of_monomial<dim>(powers) - 1.) < 1e-12;
        }
    return exact;
  }



  template <int dim>
  void
  test_quadrature()
  {
    section("Quadrature in ", dim, "D");
    const auto degree_is = [&](const std::string &name, const unsigned int p) {
      const ContactQuadrature<dim> quadrature(
        ContactQuadratureParameters::parse(name));
      bool exact = true;
      for (unsigned int degree = 0; degree <= p; ++degree)
        exact &= integrates_degree<dim>(quadrature, degree);
      check(name + " is exact to degree " + std::to_string(p), exact);
    };
    degree_is("nodal", 1);
    degree_is("midpoint", 1);
    for (unsigned int n = 1; n <= 7; ++n)
      degree_is("gauss " + std::to_string(n), 2 * n - 1);
  }
} // namespace



int
main()
{
  test_laws();
  test_parse();
  test_quadrature<2>();
  test_quadrature<3>();
}
