// SPDX-License-Identifier: LGPL-2.1-or-later

// The adhesive laws and the quadrature rules on the contact boundary, against
// closed formulas and differences.

#include <debond/base/parameter_table.h>
#include <debond/contact/laws/curve.h>
#include <debond/contact/laws/none.h>
#include <debond/contact/laws/softening.h>
#include <debond/contact/laws/winkler.h>
#include <debond/contact/quadrature.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <set>
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



  /// Laws with numbers for the entries that they need.
  const std::vector<std::pair<std::string, std::vector<std::string>>> scenes = {
    {"none", {}},
    {"winkler", {}},
    {"bilinear",
     {"Bond stiffness=100", "Bond strength=1", "Fracture energy=0.02"}},
    {"exponential",
     {"Bond stiffness=100", "Bond strength=1", "Fracture energy=0.02"}},
    {"curve", {"Curve=0:0, 0.1:3, 0.1:2, 0.2:4, 0.2:0.8, 0.5:2, 0.5:0"}},
    {"curve", {"Curve=0:1.1, 1.6363636363636365:0"}},
    {"curve", {"Curve=0:0, 1:1, 2:3, 3:3, 5:2, 5:1, 6:1.5, 8:0.5"}}};

  /// Such a law, its energies in a unit that is smaller by a factor.
  AdhesiveLaw
  law_of(const std::string              &name,
         const std::vector<std::string> &entries,
         const double                    factor)
  {
    LawSection     section;
    ParameterTable table;
    section.bind(table);
    table.assign("Contact law/Law=" + name);
    for (const std::string &entry : entries)
      table.assign("Contact law/" + entry);
    table.take_values();
    std::vector<EnergyPiece> pieces = section.make_law(table).pieces;
    for (const std::string &line : table.errors)
      std::cout << line << std::endl;
    for (EnergyPiece &piece : pieces)
      {
        piece.curvature *= factor;
        piece.slope *= factor;
      }
    return AdhesiveLaw(pieces);
  }



  /// What every law promises, by differences on a grid that has the kinks:
  /// value, interval, second derivative and kinks fit together.
  void
  test_conformance(const std::string &name, const AdhesiveLaw &law)
  {
    const bool   has_bonds = law.bond_threshold() > 0.;
    const double a =
      has_bonds ? law.bond_strength() / law.bond_threshold() : 1.;
    const double M      = has_bonds ? law.bond_threshold() : 1.;
    const double energy = a * M * M, strength = a * M, h = 1e-4 * M;
    const auto   kinks = law.kinks();

    std::vector<double> ends = kinks;
    ends.insert(ends.begin(), -5. * M);
    ends.push_back(3. * M);
    double slope_error = 0., curvature_error = 0., negative = 0.;
    double largest_force = 0.;
    for (unsigned int k = 0; k + 1 < ends.size(); ++k)
      {
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
                  std::abs(law.second_derivative(s) - difference / (h * h)) /
                    a);
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
    check("second derivative against differences", curvature_error, 1e-4);
    check("strength and largest force differ by",
          std::abs(largest_force - law.bond_strength()) / strength,
          1e-2);
  }



  /// The quadratic that touches at s with the slope and curvature of the law is
  /// above it, and a flatter one is not, with and without memory; with a memory
  /// the law is the secant up to it, and what it was beyond.
  void
  test_majorants(const std::string &name, const AdhesiveLaw &law)
  {
    const double M      = law.bond_threshold() > 0. ? law.bond_threshold() : 1.;
    const double energy = std::max(law.value(-4. * M), 1e-300);
    double       below = 0., too_steep = 0., off_secant = 0., off_law = 0.;
    double       off_pieces = 0.;
    bool         is_convex  = true;
    for (const double reached : {0., -0.1 * M, -0.45 * M, -0.83 * M, -2. * M})
      {
        const double          taken = law.value(0., reached);
        const PiecewiseEnergy after = law.pieces().after(reached);
        for (unsigned int i = 1; i <= 200; ++i)
          {
            const double s = -0.0201 * i * M, value = law.value(s, reached);
            if (s > reached)
              off_secant =
                std::max({off_secant,
                          std::abs(law.derivative(s, reached) -
                                   law.derivative(reached) * (s / reached)) *
                            M / energy,
                          std::abs(value - taken -
                                   0.5 * s * law.derivative(s, reached)) /
                            energy});
            else
              raise(off_law, std::abs(value - law.value(s)) / energy);
            const double slope     = law.derivative(s, reached),
                         curvature = law.curvature(s, reached);
            raise(off_pieces,
                  (std::abs(after.value(s) + taken - value) +
                   M * std::abs(after[after.index(s)].derivative(s) - slope)) /
                    energy);
            is_convex = is_convex && curvature >= 0.;
            // The least curvature that is enough, on a fine grid.
            double needed = std::max(0., law.second_derivative(s, reached));
            for (unsigned int k = 0; k <= 4000; ++k)
              {
                const double t = -0.0025 * k * M, d = t - s;
                const double excess = law.value(t, reached) - value - slope * d;
                raise(below, (excess - 0.5 * curvature * d * d) / energy);
                if (std::abs(d) > 1e-3 * M)
                  raise(needed, 2. * excess / (d * d));
              }
            raise(too_steep, (curvature - needed) * M * M / energy);
          }
      }
    section("Majorants and memory: ", name);
    check("curvatures are not negative", is_convex);
    check("the law above the quadratic", below, 1e-13);
    check("a flatter one would do", too_steep, 2e-2);
    check("distance to the secant below what was reached", off_secant, 1e-13);
    check("distance to the law beyond", off_law, 0.);
    check("distance of the pieces with this memory", off_pieces, 1e-13);
  }



  void
  test_curve()
  {
    section("Curve with drops");
    const AdhesiveLaw law(curve_law({{0., 0.},
                                     {0.1, 3.},
                                     {0.1, 2.},
                                     {0.2, 4.},
                                     {0.2, 0.8},
                                     {0.5, 2.},
                                     {0.5, 0.}})
                            .pieces);
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

    const AdhesiveLaw one(
      curve_law({{0., 0.}, {0.002, 0.138}, {0.002, 0.}}).pieces);
    const AdhesiveLaw winkler(winkler_law(69., 0.002).pieces);
    bool              same = one.kinks() == winkler.kinks();
    for (unsigned int i = 0; i < 100; ++i)
      same &= std::abs(one.value(-5e-5 * i) - winkler.value(-5e-5 * i)) <=
              1e-15 * winkler.value(-1.);
    check("one step is Winkler's law", same);
  }



  /// Energies and damage by hand.
  void
  test_softening()
  {
    section("Softening laws");
    const AdhesiveLaw bilinear(bilinear_law({100., 1., 0.02}).pieces);
    check("the strength is at strength / stiffness, nothing at 2 energy / "
          "strength",
          bilinear.derivative(-0.01) == -1. &&
            bilinear.pieces()[2].upper == -0.04 && bilinear.is_loose(2));
    check("half of the traction half way down",
          std::abs(bilinear.derivative(-0.025) + 0.5) < 1e-15);
    check("all bonds take the fracture energy",
          std::abs(bilinear.value(-1.) / 0.02 - 1.) < 1e-14);
    check("damage 1 - secant / stiffness",
          bilinear.damage(-0.01) == 0. &&
            std::abs(bilinear.damage(-0.025) - 0.8) < 1e-14 &&
            bilinear.damage(-0.05) == 1.);
    const AdhesiveLaw exponential(exponential_law({100., 1., 0.02}).pieces);
    // strength exp(-(opening - 0.01) / 0.015), 0.015 = 0.02 - 0.005.
    check("the traction falls to 1/e at an opening of 0.025",
          std::abs(exponential.derivative(-0.025) + std::exp(-1.)) < 1e-15);
    check("exponential bonds take it in the end, and are not quite broken",
          std::abs(exponential.value(-10.) / 0.02 - 1.) < 1e-14 &&
            !exponential.is_loose(1) && exponential.damage(-0.025) < 1.);
    check("energy at 1/e",
          std::abs(exponential.value(-0.025) /
                     (0.005 + 0.015 * (1. - std::exp(-1.))) -
                   1.) < 1e-14);
    print_error([] { bilinear_law({100., 1., 0.004}); });
    print_error([] { exponential_law({100., 0., 0.004}); });
  }



  void
  test_laws()
  {
    std::set<std::string> names;
    for (const auto &[name, entries] : scenes)
      {
        names.insert(name);
        for (const double factor : {1., 1e9})
          {
            const AdhesiveLaw law = law_of(name, entries, factor);
            test_conformance(name, law);
            test_majorants(name, law);
          }
      }
    check("all kinds of laws are among them",
          names.size() == law_names().size());

    test_curve();
    test_softening();
    section("Other laws");
    const AdhesiveLaw none(no_adhesion().pieces);
    check("without adhesion there is no force",
          none.value(-1.) == 0. && none.value(1.) == 0. &&
            equal(none.goldstein_interval(-1., 5.), 0., 0., 1e-300) &&
            none.curvature(-1.) == 0. && none.kinks().empty() &&
            none.bond_threshold() == 0. && none.bond_strength() == 0.);
    const AdhesiveLaw loose(winkler_law(0., 0.002).pieces);
    check("bonds without stiffness count as no adhesion",
          loose.bond_threshold() == 0. && loose.bond_strength() == 0.);

    print_error([] { winkler_law(-1., 0.002); });
    print_error([] { winkler_law(69., 0.); });
    print_error([] { winkler_law(std::nan(""), 1.); });
    print_error([] { winkler_law(69., INFINITY); });
    print_error([] { AdhesiveLaw({}); });
    print_error([] { AdhesiveLaw({{-5., 0., no_end, "falling"}}); });
    print_error([] { AdhesiveLaw({{1., INFINITY, no_end, "steep"}}); });
    print_error([] { AdhesiveLaw({{1., 0., -1., "short"}}); });
    print_error([] {
      AdhesiveLaw({{1., -0.5, -1., "soft"}, {1., 1.5, no_end, "pushing"}});
    });
    print_error([] {
      AdhesiveLaw({{1., 0., -1., "soft"}, {2., 0., no_end, "stiff"}});
    });
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
