// SPDX-License-Identifier: LGPL-2.1-or-later
// The search and the proof where bonds have several unknowns, of which some
// have no bound, against enumeration of the states of all bonds. Takes the
// number of problems.

#include <debond/optimization/global/bond_bound.h>
#include <debond/optimization/global/branch_and_bound.h>
#include <debond/optimization/majorise/condensed_problem.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "../check.h"
#include "random_problems.h"

using namespace Debond;

namespace
{
  /// Nodes with an unknown that has a bound and none, one or two that have not,
  /// of one bond or of one each.
  Problem
  random_problem(Random            &random,
                 const unsigned int n_nodes,
                 const unsigned int k)
  {
    const unsigned int n_tangents = k % 3;
    const bool         is_common = k % 2 == 0, is_steep = k % 5 == 0;
    const unsigned int n = n_nodes * (1 + n_tangents);
    // Any order of the unknowns.
    std::vector<unsigned int> order(n);
    std::iota(order.begin(), order.end(), 0);
    for (unsigned int i = n - 1; i > 0; --i)
      std::swap(order[i], order[random.integer(0, i)]);
    Problem p = {random_matrix(random, n, k % 7 == 0),
                 Vector::NullaryExpr(n, [&]() { return random(-2.2, 0.8); }),
                 SeparableEnergy({}),
                 Vector::Constant(n, infinity)};
    // Ratios of stiffnesses, and of that to the body's, over many orders.
    const double                 spread = is_steep ? 6. : 1.;
    std::vector<PiecewiseEnergy> laws;
    for (unsigned int c = 0; c <= n_tangents; ++c)
      {
        const double energy = random(0.05, 1.);
        const double k_c    = std::pow(10., random(-spread, spread));
        laws.push_back(
          bonds_of(Vector::Constant(1, k_c), std::sqrt(2. * energy / k_c))
            .f[0]);
      }
    const double ratio = std::pow(10., random(-spread, spread));
    p.phi.bonds.resize(n);
    p.phi.weights = Vector::Ones(n);
    for (unsigned int i = 0; i < n_nodes; ++i)
      {
        const double weight = std::pow(2., random.integer(0, 4)) / 4.;
        for (unsigned int c = 0; c <= n_tangents; ++c)
          {
            const unsigned int j = order[i * (1 + n_tangents) + c];
            if (c == 0)
              p.upper(j) = 0.;
            else
              {
                p.g(j) += 0.7;
                p.phi.weights(j) = is_common ? ratio : 1.;
              }
            // Now and then there are no bonds.
            if (c == 0 || !is_common)
              p.phi.f.push_back(laws[c].scaled(k % 13 == c + i ? 0. : weight));
            p.phi.bonds[j] = p.phi.f.size() - 1;
          }
      }
    return p;
  }



  void
  test_bounds(Random &random, const unsigned int n_problems)
  {
    unsigned int above = 0, not_proved = 0, wrong = 0, lost = 0, incomplete = 0;
    unsigned int certified = 0, branched = 0, stopped = 0, found = 0;
    for (unsigned int k = 0; k < n_problems; ++k)
      {
        const Problem      p = random_problem(random, 1 + k % 3, k);
        const unsigned int n = p.g.size();
        LongVector         s_min;
        const long double  minimum = p.enumerated_minimum(s_min);
        const double       tolerance =
          1e-10 * std::max(1., std::abs(double(minimum)));
        const double rounding = 1e-15 * std::max(1., std::abs(double(minimum)));

        BranchAndBoundParameters parameters;
        parameters.tolerance = tolerance;
        const auto proof     = branch_and_bound(parameters, p, Vector::Zero(n));
        not_proved += proof.status != ProofStatus::proved;
        above += proof.lower > minimum + rounding;
        wrong += std::abs(proof.upper - minimum) > tolerance ||
                 std::abs(p.value(proof.s) - minimum) > tolerance;
        branched += proof.nodes > 1;

        parameters.maximum_nodes = 1;
        const auto first = branch_and_bound(parameters, p, Vector::Zero(n));
        stopped += first.status == ProofStatus::node_limit;
        above += first.lower > minimum + rounding;
        // The box must not lose the minimum.
        const BondBound bound(p);
        const double    best = double(minimum) + tolerance;
        ProofNode       node = *bound.root(best);
        bound.bound(node, best, 0.);
        const Vector at_minimum = s_min.cast<double>();
        const auto   state      = p.phi.state(at_minimum);
        for (unsigned int i = 0; i < n; ++i)
          lost += at_minimum(i) < node.lower(i) - 1e-9 ||
                  at_minimum(i) > node.upper(i) + 1e-9;
        for (unsigned int i = 0; i < state.size(); ++i)
          lost += state[i] < node.lower(n + i) || state[i] > node.upper(n + i);
        above += node.bound > minimum + rounding;
        const double certificate = bound.bound_at(at_minimum).value;
        above += certificate > minimum + rounding;
        certified += certificate > minimum - tolerance;

        Vector                 s = Vector::Zero(n);
        const MajoriseMinimise method({});
        CondensedProblem       problem(p, s);
        method.minimize(problem);
        const auto search =
          search_branches({p, p.phi, chain(p.phi.f.size()), method}, {}, s);
        incomplete += !search.complete || search.failures > 0 ||
                      std::abs(search.functional - p.value(s)) > tolerance ||
                      search.functional < minimum - tolerance;
        found += search.functional < minimum + tolerance;
      }
    section("bounds on ", n_problems, " problems");
    check("never above the enumerated minimum", above == 0);
    check("the minimum proved", not_proved == 0);
    check("and found", wrong == 0);
    check("never outside the shrunk box", lost == 0);
    check("values of the search as points say", incomplete == 0);
    check("some need more than one node", branched > n_problems / 20);
    check("some stopped after one node", stopped > n_problems / 100);
    check("half of them are certified", certified > n_problems / 2);
    check("the search finds 49 of 50", found > 0.98 * n_problems);
  }
  /// With more bonds than could be enumerated, and with threads.
  void
  test_many_bonds(Random &random)
  {
    unsigned int not_proved = 0, most_nodes = 0, not_same = 0;
    for (const unsigned int k : {1, 2, 4, 5, 7, 8})
      {
        Problem p = random_problem(random, 20, k);
        // So that some bonds break.
        p.g *= 0.5;
        const Vector             rest = Vector::Zero(p.g.size());
        BranchAndBoundParameters parameters;
        parameters.tolerance     = 1e-8;
        parameters.maximum_nodes = 3000;
        const auto proof         = branch_and_bound(parameters, p, rest);
        not_proved += proof.status != ProofStatus::proved;
        raise(most_nodes, proof.nodes);
        parameters.n_threads = 3;
        const auto other     = branch_and_bound(parameters, p, rest);
        not_same += other.nodes != proof.nodes || other.lower != proof.lower ||
                    other.s != proof.s;
      }
    section("20 nodes");
    check("proved", not_proved == 0);
    check("in some nodes", most_nodes > 10);
    check("with threads the same", not_same == 0);
  }
} // namespace



int
main(int argc, char *argv[])
{
  print_figures = argc > 1;
  Random random;
  test_bounds(random, argc > 1 ? std::stoul(argv[1]) : 600);
  test_many_bonds(random);
}
