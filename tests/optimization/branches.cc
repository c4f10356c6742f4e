// SPDX-License-Identifier: LGPL-2.1-or-later
// The search and the proof with any number of branches, against enumeration of
// all choices of a branch for each unknown, by a solver of its own in long
// double: for each choice the minimum of the convex problem is above J's, and
// one of them is it. Takes the number of problems.

#include <deal.II/lac/full_matrix.h>

#include <debond/optimization/global/branch_and_bound.h>
#include <debond/optimization/global/branch_search.h>
#include <debond/optimization/global/convex_envelope.h>
#include <debond/optimization/global/node_bound.h>
#include <debond/optimization/majorise/condensed_problem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>
#include <stdexcept>

#include "../check.h"
#include "enumeration.h"

using namespace Debond;

namespace
{
  using Vector = Eigen::VectorXd;

  constexpr double infinity = std::numeric_limits<double>::infinity();



  class Random
  {
  public:
    double
    operator()(const double lower, const double upper)
    {
      return std::uniform_real_distribution<double>(lower, upper)(engine);
    }

    unsigned int
    integer(const unsigned int lower, const unsigned int upper)
    {
      return std::uniform_int_distribution<unsigned int>(lower, upper)(engine);
    }

  private:
    std::mt19937_64 engine{20261122};
  };



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
        const PiecewiseEnergy f        = any_branches(random);
        const BranchList      branches = branches_of(f);
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
            raise(worst,
                  double(std::abs(f.value(s) - least_branch(branches, s))));
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
        const BranchList list = branches_of(
          k % 2 == 0 ? any_branches(random) : stepped(random, 1 + k % 4));
        const BranchEnergy   f     = {k % 3 == 0 ? 0. : random(0., 1.), list};
        const double         lower = -random(0., 5.);
        const double         upper = k % 5 == 0 ? 0. : lower * random(0., 1.);
        const ConvexEnvelope envelope(f, lower, upper);
        raise(most_parts, static_cast<unsigned int>(envelope.parts.size()));

        const auto value = [&](const double s) {
          return double(least_branch(list, s)) + 0.5 * f.convexity * s * s;
        };
        constexpr unsigned int n_points = 50;
        const double           h        = (upper - lower) / n_points;
        std::vector<double>    values;
        for (unsigned int i = 0; i <= n_points; ++i)
          values.push_back(value(lower + h * i));
        const double r     = random(-3., 3.);
        double       least = infinity;
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
                const double e    = 1e-6;
                BranchEnergy more = f, less = f;
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



  struct Problem
  {
    LongMatrix              S_long;
    Eigen::MatrixXd         S;
    Vector                  g;
    std::vector<BranchList> lists;
    SeparableBranches       phi;

    long double
    value(const Vector &s) const
    {
      long double sum = 0.;
      for (unsigned int i = 0; i < s.size(); ++i)
        {
          long double force = -g(i);
          for (unsigned int j = 0; j < s.size(); ++j)
            force += 0.5L * S_long(i, j) * s(j);
          sum += force * s(i) + least_branch(lists[i], s(i));
        }
      return sum;
    }
  };



  Problem
  random_problem(Random            &random,
                 const unsigned int n,
                 const bool         is_stepped,
                 const bool         has_any_coupling)
  {
    LongMatrix S(n, n);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j <= i; ++j)
        S(i, j) = S(j, i) = -std::exp(-double(i - j)) * random(0.7, 1.3);
    for (unsigned int i = 0; i < n; ++i)
      S(i, i) = 0.05 - (S.row(i).sum() - S(i, i));
    if (has_any_coupling)
      {
        const LongMatrix B =
          LongMatrix::NullaryExpr(n, n, [&]() { return random(-1., 1.); });
        S = B * B.transpose() + 0.02L * LongMatrix::Identity(n, n);
      }

    Problem p = {
      S, Eigen::MatrixXd(n, n), Vector(n), {}, SeparableBranches({})};
    const PiecewiseEnergy common = stepped(random, random.integer(1, 3));
    for (unsigned int i = 0; i < n; ++i)
      {
        // Of a law, each unknown has a multiple.
        p.phi.f.push_back(
          is_stepped ? common.scaled(std::pow(2., random.integer(0, 4)) / 4.) :
                       any_branches(random));
        p.lists.push_back(branches_of(p.phi.f.back()));
        p.g(i) = random(-2.2, 0.8);
        for (unsigned int j = 0; j < n; ++j)
          {
            p.S(i, j)      = double(S(i, j));
            p.S_long(i, j) = p.S(i, j);
          }
      }
    return p;
  }



  NeighbourGraph
  chain(const unsigned int n)
  {
    NeighbourGraph graph(n);
    for (unsigned int i = 1; i < n; ++i)
      {
        graph[i - 1].insert(i);
        graph[i].insert(i - 1);
      }
    return graph;
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
        const Problem p = random_problem(random, n, is_stepped, k % 5 == 0);
        LongVector    s_min;
        LongVector    g(n);
        for (unsigned int i = 0; i < n; ++i)
          g(i) = p.g(i);
        const long double minimum =
          enumerated_minimum(p.S_long, g, p.lists, s_min);
        const double tolerance =
          1e-10 * std::max(1., std::abs(double(minimum)));
        // Constants are kept such that kinks are doubles.
        const double rounding = 1e-15;

        BranchAndBoundParameters parameters;
        parameters.tolerance = tolerance;
        const auto proof =
          branch_and_bound(parameters, {p.S, p.g, p.phi}, Vector::Zero(n));
        not_proved += proof.status != ProofStatus::proved;
        above += proof.lower > minimum + rounding;
        wrong += std::abs(proof.upper - minimum) > tolerance ||
                 std::abs(p.value(proof.s) - minimum) > tolerance;
        branched += proof.nodes > 1;

        parameters.maximum_nodes = 1;
        const auto stopped =
          branch_and_bound(parameters, {p.S, p.g, p.phi}, Vector::Zero(n));
        interrupted += stopped.status == ProofStatus::node_limit;
        above += stopped.lower > minimum + rounding;
        // The box must not lose the minimum.
        const NodeBound node_bound(p.S, p.g, p.phi);
        const double    best   = double(minimum) + tolerance;
        ProofNode       node   = *node_bound.root(best);
        const auto      result = node_bound.bound(node, best, 0.);
        for (unsigned int i = 0; i < n; ++i)
          lost += result.unknown && (s_min(i) < node.lower(i) - 1e-9 ||
                                     s_min(i) > node.upper(i) + 1e-9);
        above += node.bound > minimum + rounding;
        const Eigen::VectorXd at_minimum  = s_min.cast<double>();
        const double          certificate = node_bound.bound_at(at_minimum);
        above += certificate > minimum + rounding;
        certified += certificate > minimum - tolerance;

        Vector                 s = Vector::Zero(n);
        const MajoriseMinimise method({});
        CondensedProblem       problem(p.S, p.g, p.phi, s);
        method.minimize(problem);
        if (is_stepped)
          {
            const auto search =
              search_branches({{p.S, p.g, p.phi}, p.phi, chain(n), method},
                              {},
                              s);
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
