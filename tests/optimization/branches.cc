// SPDX-License-Identifier: LGPL-2.1-or-later
// The search and the proof with any number of branches, against enumeration.
// Takes the number of problems.

#include <debond/optimization/global/branch_and_bound.h>
#include <debond/optimization/global/convex_envelope.h>
#include <debond/optimization/global/node_bound.h>
#include <debond/optimization/majorise/condensed_problem.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <stdexcept>

#include "../check.h"
#include "random_problems.h"

using namespace Debond;

namespace
{
  PiecewiseEnergy
  stepped(Random &random, const unsigned int n_steps)
  {
    std::vector<EnergyPiece> steps;
    double                   a = std::pow(10., random(-1., 1.)), M = 0.;
    for (unsigned int k = 0; k < n_steps; ++k)
      {
        M += random(0.1, 0.9);
        steps.push_back({a, 0., -M, std::to_string(k)});
        a *= random(0.1, 0.9);
      }
    steps.push_back({0., 0., no_end, "broken"});
    return PiecewiseEnergy(steps);
  }



  /// Any pieces of convex branches of which f is the least, two at least:
  /// the search has kinks in common.
  PiecewiseEnergy
  any_branches(Random &random)
  {
    while (true)
      {
        std::vector<EnergyPiece> pieces;
        double                   pull = random(0., 0.5), s = 0.;
        for (unsigned int k = random.integer(1, 4) + 1; k > 0; --k)
          {
            const double c   = random.integer(0, 2) == 0 ? 0. : random(0., 5.);
            const double end = k > 1 ? s - random(0.05, 0.8) : no_end;
            pieces.push_back({c, -pull - c * s, end, std::to_string(k)});
            // Now and then it pushes a little.
            pull = (pull + c * (s - end)) * random(-0.1, 1.);
            s    = end;
          }
        try
          {
            const PiecewiseEnergy f(pieces);
            if (!f.softens())
              return f;
          }
        catch (const std::invalid_argument &)
          {}
      }
  }



  /// f is the least of the branches, the pieces follow each other, multiples
  /// are multiples.
  void
  test_minimum(Random &random)
  {
    double       worst = 0., worst_multiple = 0., worst_jump = 0.;
    unsigned int most_pieces = 0;
    for (unsigned int k = 0; k < 3000; ++k)
      {
        const PiecewiseEnergy f = any_branches(random);
        raise(most_pieces, f.size());
        const double          factor = random(0.1, 10.);
        const PiecewiseEnergy more   = f.scaled(factor);
        for (unsigned int p = 1; p < f.size(); ++p)
          {
            const double above = f[p - 1].value(f[p].upper);
            const double below = f[p].value(f[p].upper);
            raise(worst_jump, std::abs(below - above) / (1. + above));
          }
        for (unsigned int i = 0; i < 200; ++i)
          {
            const double s = -0.02 * i;
            raise(worst, double(std::abs(f.value(s) - least_branch(f, s))));
            raise(worst_multiple,
                  std::abs(more.value(s) - factor * f.value(s)) / factor);
          }
      }

    section("minimum of branches");
    check("their least value", worst, 1e-13);
    check("its multiples", worst_multiple, 1e-13);
    check("no jumps", worst_jump, 1e-13);
    check("up to five pieces", most_pieces >= 5);
  }



  /// On a fine grid: not above the least of all chords, which is the envelope,
  /// and below it by at most the square of the distance.
  void
  test_envelope(Random &random)
  {
    double       worst = 0., worst_least = 0., worst_spread = 0.;
    unsigned int most_parts = 0;
    for (unsigned int k = 0; k < 600; ++k)
      {
        const PiecewiseEnergy energy =
          k % 2 == 0 ? any_branches(random) : stepped(random, 1 + k % 4);
        ShiftedEnergy f = {k % 3 == 0 ? 0. : random(0., 1.), {}};
        for (unsigned int p = 0; p < energy.size(); ++p)
          f.pieces.push_back(energy[p]);
        const double         lower = -random(0., 5.);
        const double         upper = k % 5 == 0 ? 0. : lower * random(0., 1.);
        const ConvexEnvelope envelope(f, lower, upper);
        raise(most_parts, static_cast<unsigned int>(envelope.parts.size()));

        const auto value = [&](const double s) {
          return double(least_branch(energy, s)) + 0.5 * f.convexity * s * s;
        };
        constexpr unsigned int n_points = 50;
        const double           h        = (upper - lower) / n_points;
        std::vector<double>    values;
        for (unsigned int i = 0; i <= n_points; ++i)
          values.push_back(value(lower + h * i));
        const double r     = random(-3., 3.);
        double       least = std::numeric_limits<double>::infinity();
        for (unsigned int i = 0; i <= n_points; ++i)
          {
            const double s     = lower + h * i;
            double       chord = values[i];
            for (unsigned int a = 0; a < i; ++a)
              for (unsigned int b = i + 1; b <= n_points; ++b)
                chord = std::min(chord,
                                 (values[a] * (b - i) + values[b] * (i - a)) /
                                   (b - a));
            const double below = chord - envelope.value(s);
            worst              = std::max({worst, -below, below - 20. * h * h});
            least              = std::min(least, r * s + values[i]);

            if (f.convexity > 0.1)
              {
                const double  e    = 1e-6;
                ShiftedEnergy more = f, less = f;
                more.convexity += e;
                less.convexity -= e;
                const double derivative =
                  (ConvexEnvelope(more, lower, upper).value(s) -
                   ConvexEnvelope(less, lower, upper).value(s)) /
                  (2. * e);
                raise(worst_spread,
                      std::abs(derivative - 0.5 * s * s -
                               0.5 * envelope.spread(s)));
              }
          }
        const double found = double(f.least(r, lower, upper));
        worst_least =
          std::max({worst_least, found - least, least - found - 20. * h * h});
      }
    section("envelope");
    check("the least of all chords", worst, 1e-12);
    check("least values of r s + f(s)", worst_least, 1e-12);
    check("spread against differences", worst_spread, 1e-3);
    check("up to seven parts", most_parts >= 7);
  }



  Problem
  random_problem(Random            &random,
                 const unsigned int n,
                 const bool         is_stepped,
                 const bool         any_coupling)
  {
    Problem               p      = {random_matrix(random, n, any_coupling),
                                    Vector::NullaryExpr(n, [&]() { return random(-2.2, 0.8); }),
                                    SeparableEnergy({})};
    const PiecewiseEnergy common = stepped(random, random.integer(1, 3));
    // Of a law, each unknown has a multiple.
    for (unsigned int i = 0; i < n; ++i)
      p.phi.f.push_back(
        is_stepped ? common.scaled(std::pow(2., random.integer(0, 4)) / 4.) :
                     any_branches(random));
    return p;
  }



  void
  test_bounds(Random &random, const unsigned int n_problems)
  {
    unsigned int above = 0, not_proved = 0, wrong = 0, lost = 0,
                 wrong_search = 0;
    unsigned int certified = 0, branched = 0, n_stepped = 0, found = 0;
    unsigned int interrupted = 0;
    for (unsigned int k = 0; k < n_problems; ++k)
      {
        const bool         is_stepped = k % 2 == 0;
        const unsigned int n          = 2 + k % 3;
        const Problem     p = random_problem(random, n, is_stepped, k % 5 == 0);
        LongVector        s_min;
        const long double minimum = p.enumerated_minimum(s_min);
        const double      tolerance =
          1e-10 * std::max(1., std::abs(double(minimum)));
        // Constants are kept such that kinks are doubles.
        const double rounding = 1e-15;

        BranchAndBoundParameters parameters;
        parameters.tolerance = tolerance;
        const auto proof     = branch_and_bound(parameters, p, Vector::Zero(n));
        not_proved += proof.status != ProofStatus::proved;
        above += proof.lower > minimum + rounding;
        wrong += std::abs(proof.upper - minimum) > tolerance ||
                 std::abs(p.value(proof.s) - minimum) > tolerance;
        branched += proof.nodes > 1;

        parameters.maximum_nodes = 1;
        const auto stopped = branch_and_bound(parameters, p, Vector::Zero(n));
        interrupted += stopped.status == ProofStatus::node_limit;
        above += stopped.lower > minimum + rounding;
        // The box must not lose the minimum.
        const NodeBound node_bound(p);
        const double    best   = double(minimum) + tolerance;
        ProofNode       node   = *node_bound.root(best);
        const auto      result = node_bound.bound(node, best, 0.);
        for (unsigned int i = 0; i < n; ++i)
          lost += result.unknown && (s_min(i) < node.lower(i) - 1e-9 ||
                                     s_min(i) > node.upper(i) + 1e-9);
        above += node.bound > minimum + rounding;
        const Eigen::VectorXd at_minimum = s_min.cast<double>();
        const double certificate = node_bound.bound_at(at_minimum).value;
        above += certificate > minimum + rounding;
        certified += certificate > minimum - tolerance;

        Vector                 s = Vector::Zero(n);
        const MajoriseMinimise method({});
        CondensedProblem       problem(p, s);
        method.minimize(problem);
        if (is_stepped)
          {
            const auto search =
              search_branches({p, p.phi, chain(n), method}, {}, s);
            wrong_search +=
              !search.complete || search.failures > 0 ||
              std::abs(search.functional - p.value(s)) > tolerance ||
              search.functional < minimum - tolerance;
            ++n_stepped;
            found += search.functional < minimum + tolerance;
          }
      }
    section("bounds on ", n_problems, " problems");
    check("never above the enumerated minimum", above == 0);
    check("the minimum proved", not_proved == 0);
    check("and found", wrong == 0);
    check("never outside the shrunk box", lost == 0);
    check("some need more than one node", branched > n_problems / 100);
    check("some stopped after one node", interrupted > n_problems / 100);
    check("two of three are certified", certified > n_problems / 3 * 2);
    check("search with steps: values as points say", wrong_search == 0);
    check("the minimum in 49 of 50", found > 0.98 * n_stepped);
  }
} // namespace



int
main(int argc, char *argv[])
{
  print_figures = argc > 1;
  Random random;
  test_minimum(random);
  test_envelope(random);
  test_bounds(random, argc > 1 ? std::stoul(argv[1]) : 2000);
}
