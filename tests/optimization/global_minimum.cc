// SPDX-License-Identifier: LGPL-2.1-or-later
// The search over bond states and the proof by branch and bound, against
// enumeration of all bond states of small problems: for each, the minimum of
// the convex problem with these states is above J's, and one of them is it.

#include <deal.II/lac/full_matrix.h>

#include <debond/optimization/bond_search.h>
#include <debond/optimization/bound_qp.h>
#include <debond/optimization/branch_and_bound.h>
#include <debond/optimization/condensed_problem.h>
#include <debond/optimization/convex_envelope.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>

using namespace Debond;

namespace
{
  using Vector = dealii::Vector<double>;

  // Whether to print the figures behind the verdicts; any argument does it.
  bool print_figures = false;

  const char *
  verdict(const bool good)
  {
    return good ? "yes" : "NO";
  }



  struct Problem
  {
    Eigen::MatrixXd            S_eigen;
    dealii::FullMatrix<double> S;
    Vector                     g;
    SeparableBonds             bonds;

    double
    value(const Vector &s) const
    {
      return 0.5 * S.matrix_norm_square(s) - g * s + bonds.value(s);
    }
  };



  /// Coupled neighbours as on a contact boundary, or any coupling.
  Problem
  random_problem(std::mt19937_64 &engine, const unsigned int n, const bool any)
  {
    std::uniform_real_distribution<double> uniform(-1., 1.);
    Eigen::MatrixXd                        S(n, n);
    if (any)
      {
        const Eigen::MatrixXd B =
          Eigen::MatrixXd::NullaryExpr(n, n, [&]() { return uniform(engine); });
        S = B * B.transpose() + 0.02 * Eigen::MatrixXd::Identity(n, n);
      }
    else
      {
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j <= i; ++j)
            S(i, j) = S(j, i) =
              -std::exp(-double(i - j)) * (1. + 0.3 * uniform(engine));
        for (unsigned int i = 0; i < n; ++i)
          S(i, i) = 0.05 - (S.row(i).sum() - S(i, i));
      }
    Problem p = {
      S,
      dealii::FullMatrix<double>(n, n),
      Vector(n),
      SeparableBonds(Eigen::VectorXd::NullaryExpr(
                       n, [&]() { return std::pow(10., uniform(engine)); }),
                     0.5 + 0.4 * uniform(engine))};
    for (unsigned int i = 0; i < n; ++i)
      {
        p.g(i) = 1.5 * uniform(engine) - 0.7;
        for (unsigned int j = 0; j < n; ++j)
          p.S(i, j) = S(i, j);
      }
    return p;
  }



  /// The least value of all bond states' convex problems.
  double
  enumerated_minimum(const Problem &p)
  {
    const unsigned int    n = p.g.size();
    const Eigen::VectorXd g = Eigen::Map<const Eigen::VectorXd>(p.g.begin(), n);
    double                least = std::numeric_limits<double>::infinity();
    ActiveSet             active(n, 0);
    for (unsigned int state = 0; state < (1u << n); ++state)
      {
        Eigen::MatrixXd M = p.S_eigen;
        for (unsigned int i = 0; i < n; ++i)
          if ((state >> i) % 2 == 0)
            M(i, i) += p.bonds.stiffness(i);
        const BoundQPResult qp =
          solve_bound_qp(M, g, Eigen::VectorXd::Zero(n), active);
        Vector s(n);
        std::copy(qp.x.begin(), qp.x.end(), s.begin());
        least = std::min(least, p.value(s));
      }
    return least;
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



  /// On a fine grid: below f, equal at the ends, convex, and on each chord
  /// that is possible not below it (the least chord value is the envelope).
  void
  test_envelope(std::mt19937_64 &engine)
  {
    std::uniform_real_distribution<double> uniform(0., 1.);
    double                                 worst = 0., worst_least = 0.;
    for (unsigned int k = 0; k < 300; ++k)
      {
        const BondEnergy f = {k % 3 == 0 ? 0. : uniform(engine),
                              10. * uniform(engine),
                              0.3 + uniform(engine)};
        const double lower = -4. * uniform(engine);
        const double upper =
          k % 2 == 0 ? 0. : lower + uniform(engine) * (0. - lower);
        const ConvexEnvelope   envelope(f, lower, upper);
        constexpr unsigned int n_points = 60;
        const auto             point    = [&](const unsigned int i) {
          return lower + (upper - lower) * i / n_points;
        };
        // Only the chords between grid points: the envelope is below them by
        // at most the square of the distance.
        const double h = (upper - lower) / n_points;
        for (unsigned int i = 0; i <= n_points; ++i)
          {
            double chord = f.value(point(i));
            for (unsigned int a = 0; a < i; ++a)
              for (unsigned int b = i + 1; b <= n_points; ++b)
                chord = std::min(chord,
                                 (f.value(point(a)) * (b - i) +
                                  f.value(point(b)) * (i - a)) /
                                   (b - a));
            const double below = chord - envelope.value(point(i));
            worst = std::max(worst, std::max(-below, below - 20. * h * h));
          }
        const double r     = 8. * (uniform(engine) - 0.5);
        double       least = std::numeric_limits<double>::infinity();
        for (unsigned int i = 0; i <= n_points; ++i)
          least = std::min(least, r * point(i) + f.value(point(i)));
        const double found = std::min(f.least_bonded(r, lower, upper),
                                      f.least_broken(r, lower, upper));
        worst_least =
          std::max(worst_least,
                   std::max(found - least, least - found - 20. * h * h));
      }
    std::cout << "envelope: the least of all chords: " << verdict(worst < 1e-13)
              << ", least values of r s + f(s): "
              << verdict(worst_least < 1e-13) << '\n';
    if (print_figures)
      std::cout << "  " << worst << ' ' << worst_least << '\n';
  }



  void
  test_bounds(std::mt19937_64 &engine, const unsigned int n_problems)
  {
    unsigned int invalid = 0, not_proved = 0, wrong = 0, most_nodes = 0;
    unsigned int interrupted = 0, found = 0, n_chains = 0, incomplete = 0;
    double       closest = std::numeric_limits<double>::infinity();
    for (unsigned int k = 0; k < n_problems; ++k)
      {
        const unsigned int n         = 2 + k % 6;
        const Problem      p         = random_problem(engine, n, k % 2 == 0);
        const double       minimum   = enumerated_minimum(p);
        const double       tolerance = 1e-10 * std::max(1., std::abs(minimum));

        // From rest, of which nothing is known.
        BranchAndBoundParameters parameters;
        parameters.tolerance = tolerance;
        const auto proof =
          BranchAndBound(parameters).minimize(p.S, p.g, p.bonds, Vector(n));
        not_proved += proof.status != ProofStatus::proved;
        wrong += std::abs(proof.upper - minimum) > tolerance ||
                 std::abs(p.value(proof.s) - minimum) > tolerance;
        invalid += proof.lower > minimum;
        closest    = std::min(closest, minimum - proof.lower);
        most_nodes = std::max(most_nodes, proof.nodes);

        parameters.maximum_nodes = 1;
        const auto stopped =
          BranchAndBound(parameters).minimize(p.S, p.g, p.bonds, Vector(n));
        interrupted += stopped.status == ProofStatus::node_limit;
        invalid += stopped.lower > minimum;

        Vector           s(n);
        MajoriseMinimise method({});
        CondensedProblem problem(p.S, p.g, p.bonds, s);
        method.minimize(problem);
        const auto search = search_bonds(
          p.S, p.g, p.bonds, p.bonds.threshold, chain(n), method, {}, s);
        incomplete += !search.complete ||
                      std::abs(search.functional - p.value(s)) > tolerance;
        n_chains += k % 2;
        found += k % 2 == 1 && search.functional < minimum + tolerance;
        invalid += search.functional < minimum - tolerance;
      }
    std::cout << "bounds on " << n_problems
              << " problems: never above the enumerated minimum: "
              << verdict(invalid == 0)
              << ", the minimum proved: " << verdict(not_proved == 0)
              << ", and found: " << verdict(wrong == 0)
              << "\n  some proofs stopped after one node: "
              << verdict(interrupted > n_problems / 100)
              << "\nsearch: values as points say: " << verdict(incomplete == 0)
              << ", the minimum in seven of ten with coupled neighbours: "
              << verdict(found > 0.7 * n_chains) << '\n';
    if (print_figures)
      std::cout << "  invalid " << invalid << ", not proved " << not_proved
                << ", wrong " << wrong << ", closest " << closest
                << ", most nodes " << most_nodes << ", interrupted "
                << interrupted << ", found by search " << found << '\n';
  }



  void
  test_larger(std::mt19937_64 &engine)
  {
    bool good = true, found = true;
    for (unsigned int k = 0; k < 4; ++k)
      {
        const unsigned int       n = 11 + k;
        const Problem            p = random_problem(engine, n, k % 2 == 0);
        const double             minimum = enumerated_minimum(p);
        BranchAndBoundParameters parameters;
        parameters.tolerance = 1e-10;
        const auto proof =
          BranchAndBound(parameters).minimize(p.S, p.g, p.bonds, Vector(n));
        good  = good && proof.status == ProofStatus::proved;
        found = found && std::abs(proof.upper - minimum) < 1e-10 &&
                proof.lower <= minimum;
        if (print_figures)
          std::cout << "  " << n << " bonds: " << proof.nodes << " nodes\n";
      }
    std::cout << "11 to 14 bonds: proved: " << verdict(good)
              << ", the enumerated minimum: " << verdict(found) << '\n';
  }



  void
  test_limits(std::mt19937_64 &engine)
  {
    const Problem            p = random_problem(engine, 8, true);
    BranchAndBoundParameters parameters;
    parameters.maximum_seconds = 0.;
    const auto late =
      BranchAndBound(parameters).minimize(p.S, p.g, p.bonds, Vector(8));
    Problem indefinite = p;
    indefinite.S(3, 3) = -1.;
    const auto nothing =
      BranchAndBound({}).minimize(indefinite.S, p.g, p.bonds, Vector(8));
    std::cout << "no time: " << to_string(late.status)
              << ", indefinite matrix: " << to_string(nothing.status)
              << ", no bound: " << verdict(!std::isfinite(nothing.lower))
              << '\n';
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;
  std::mt19937_64 engine(20261122);
  test_envelope(engine);
  test_bounds(engine, 10000);
  test_larger(engine);
  test_limits(engine);
}
