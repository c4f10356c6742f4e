// SPDX-License-Identifier: LGPL-2.1-or-later
// Parts of the proof by branch and bound beside closed forms, and proofs with
// 11 to 14 bonds, brittle ones, limits and threads, against enumeration of all
// bond states. Many small problems, with any number of branches, are in
// branches.cc.

#include <debond/optimization/global/branch_and_bound.h>
#include <debond/optimization/global/convexity_shift.h>
#include <debond/optimization/global/node_bound.h>
#include <debond/optimization/majorise/condensed_problem.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

#include "../check.h"
#include "random_problems.h"

using namespace Debond;

namespace
{
  /// A string that is pulled off on one half, which gains hardly more than the
  /// bonds cost.
  Problem
  hard_problem(Random &random, const unsigned int n)
  {
    Problem p = {Eigen::MatrixXd::Identity(n, n) * 40.02,
                 Vector(n),
                 bonds_of(Eigen::VectorXd::Constant(n, 500.), 0.007)};
    for (unsigned int i = 1; i < n; ++i)
      p.S(i, i - 1) = p.S(i - 1, i) = -20.;
    for (unsigned int i = 0; i < n; ++i)
      p.g(i) = i < n / 2 ? random(-0.084, -0.056) : 0.03;
    return p;
  }



  /// The interval where a parabola is below a level, against bisection.
  void
  test_growth(Random &random)
  {
    unsigned int too_small = 0, too_large = 0;
    for (unsigned int k = 0; k < 1000; ++k)
      {
        const Growth growth = {random(-1., 1.),
                               random(-1., 1.),
                               random(-1., 1.),
                               random(0.01, 2.01)};
        const double centre = growth.x - growth.slope / growth.curvature;
        const double least  = growth.value(centre);
        const double level  = least + random(0., 2.);
        double       inside = centre, outside = centre + 1e3;
        for (unsigned int step = 0; step < 60; ++step)
          {
            const double middle = 0.5 * (inside + outside);
            (growth.value(middle) <= level ? inside : outside) = middle;
          }
        const double   radius = inside - centre;
        const Interval all    = {-1e4, 1e4};
        const Interval found  = growth.where_at_most(level, all);
        const double   margin = 1e-5 * (radius + std::abs(centre - growth.x));
        too_small += found.lower > centre - radius || found.upper < inside;
        too_large += found.lower < centre - radius - margin ||
                     found.upper > inside + margin;

        // Cut off, and out of reach.
        const Interval half = growth.where_at_most(level, {centre, 1e4});
        too_small += half.lower != centre || half.upper != found.upper;
        const Interval far = {inside + 1.1 * margin + 1e-3, 1e4};
        too_large += !growth.where_at_most(level, far).is_empty() ||
                     growth.least(far) <= level;
      }
    section("where a parabola is below a level");
    check("no point left out", too_small == 0);
    check("and no more than these", too_large == 0);
  }



  /// Without bonds distances are known: if s_i moves from the minimum by d and
  /// all others follow, the value rises by d^2 / (2 (S^{-1})_ii).
  void
  test_distances(Random &random)
  {
    bool growth_holds = true, box_holds = true, close = true;
    for (unsigned int k = 0; k < 200; ++k)
      {
        const unsigned int     n       = 3 + k % 4;
        const Problem          p       = random_bonds(random, n, k % 2 == 0);
        const Eigen::MatrixXd  inverse = p.S.inverse();
        const Eigen::VectorXd &g       = p.g;
        const Eigen::VectorXd  minimum = inverse * g;
        const double           value   = -0.5 * g.dot(minimum);
        const PiecewiseEnergy  zero    = PiecewiseEnergy::zero();
        const SeparableEnergy  no_bonds(std::vector<PiecewiseEnergy>(n, zero));
        const double           more = random(0.1, 1.);
        const auto             root =
          NodeBound({p.S, p.g, Vector::Zero(n), no_bonds}).root(value + more);

        const BoxProblem problem = {p.S,
                                    g,
                                    std::vector<ShiftedEnergy>(n,
                                                               {0., {zero[0]}}),
                                    Eigen::VectorXd::Constant(n, -1e3),
                                    Eigen::VectorXd::Constant(n, 1e3)};
        const LowerBound lower_bound(problem, minimum);
        for (unsigned int i = 0; i < n; ++i)
          {
            // The point with the least s_i among those with this value.
            const double          d = -std::sqrt(2. * more * inverse(i, i));
            const Eigen::VectorXd s =
              minimum + d / inverse(i, i) * inverse.col(i);
            const double s_value = s.dot(0.5 * p.S * s - g);
            const double claimed =
              lower_bound.growth(i, 0, inverse(i, i)).value(s(i));
            growth_holds = growth_holds && claimed <= s_value;
            close        = close && claimed > s_value - 1e-5 * more;
            box_holds    = box_holds && root->lower(i) <= std::min(s(i), 0.);
            close        = close && root->lower(i) >= std::min(s(i), 0.) -
                                                 1e-5 * (1. + std::abs(s(i)));
          }
      }
    section("distances without bonds");
    check("growth holds", growth_holds);
    check("the first box holds", box_holds);
    check("both to 1e-5", close);
  }



  /// The inverse and the multiple against eigenvalues; the sweep raises
  /// v'D + mu log det (A - D), and where that is stationary it stays.
  void
  test_shift(Random &random)
  {
    bool inverses = true, multiples = true, rises = true, stays = true;
    for (unsigned int k = 0; k < 100; ++k)
      {
        const unsigned int    n       = 3 + k % 5;
        const Eigen::MatrixXd A       = random_matrix(random, n, true);
        const auto            inverse = safe_inverse(A);
        inverses =
          inverses && inverse &&
          (*inverse * A - Eigen::MatrixXd::Identity(n, n)).norm() < 1e-9 &&
          !safe_inverse(A - A.trace() * Eigen::MatrixXd::Identity(n, n));
        const double least =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A).eigenvalues()(0);
        const double multiple =
          largest_multiple(*inverse, Eigen::VectorXd::Ones(n));
        multiples =
          multiples && multiple > 0.99 * least && multiple < 2. * least;

        std::vector<unsigned int> all(n);
        for (unsigned int i = 0; i < n; ++i)
          all[i] = i;
        const double          mu = 0.1;
        const Eigen::VectorXd v  = Eigen::VectorXd::LinSpaced(n, 0.1, 1.);
        Eigen::VectorXd       D  = Eigen::VectorXd::Zero(n);
        const auto            objective = [&]() {
          const Eigen::MatrixXd rest = A - Eigen::MatrixXd(D.asDiagonal());
          return v.dot(D) + mu * std::log(rest.determinant());
        };
        double before = objective();
        for (unsigned int sweep = 0; sweep < 2000; ++sweep)
          {
            const Eigen::MatrixXd rest = A - Eigen::MatrixXd(D.asDiagonal());
            raise_bound(rest.inverse(), v, mu, all, D);
            const double after = objective();
            rises              = rises && after > before - 1e-9;
            before             = after;
          }
        const Eigen::MatrixXd rest = A - Eigen::MatrixXd(D.asDiagonal());
        const Eigen::MatrixXd P    = rest.inverse();
        for (unsigned int i = 0; i < n; ++i)
          stays = stays && D(i) >= 0. &&
                  (D(i) * P(i, i) < 2e-3 ?
                     v(i) < 1.01 * mu * P(i, i) :
                     std::abs(v(i) - mu * P(i, i)) < 0.01 * v(i));
      }
    section("shift of convexity");
    check("inverse", inverses);
    check("largest multiple", multiples);
    check("sweeps rise", rises);
    check("to where the derivative is zero", stays);
  }



  void
  test_larger(Random &random)
  {
    bool good = true, found = true;
    for (unsigned int k = 0; k < 4; ++k)
      {
        const unsigned int       n = 11 + k;
        const Problem            p = random_bonds(random, n, k % 2 == 0);
        LongVector               minimiser;
        const double             minimum = p.enumerated_minimum(minimiser);
        BranchAndBoundParameters parameters;
        parameters.tolerance = 1e-10;
        const auto proof     = branch_and_bound(parameters, p, Vector::Zero(n));
        good                 = good && proof.status == ProofStatus::proved;
        found = found && std::abs(proof.upper - minimum) < 1e-10 &&
                proof.lower <= minimum + 1e-15;
      }
    section("11 to 14 bonds");
    check("proved", good);
    check("the enumerated minimum", found);
  }



  /// The same nodes in the same order, whatever the number of threads.
  void
  test_threads(Random &random)
  {
    bool         same       = true;
    unsigned int most_nodes = 0;
    for (unsigned int k = 0; k < 3; ++k)
      {
        const Problem            p = hard_problem(random, 80);
        BranchAndBoundParameters parameters;
        parameters.tolerance     = 1e-9;
        parameters.maximum_nodes = 300;
        const auto one = branch_and_bound(parameters, p, Vector::Zero(80));
        for (const unsigned int n_threads : {2, 3, 16})
          {
            parameters.n_threads = n_threads;
            const auto more = branch_and_bound(parameters, p, Vector::Zero(80));
            same = same && more.nodes == one.nodes && more.lower == one.lower &&
                   more.upper == one.upper && more.s == one.s &&
                   more.status == one.status;
          }
        raise(most_nodes, one.nodes);
      }
    check("threads change nothing", same);
    check("in proofs of several batches", most_nodes > 8);
  }



  void
  test_limits(Random &random)
  {
    const Problem            p    = random_bonds(random, 8, true);
    const Problem            q    = hard_problem(random, 80);
    const Vector             zero = Vector::Zero(80);
    BranchAndBoundParameters little;
    little.tolerance     = 1e-9;
    little.maximum_bytes = 2 * 4 * 80 * sizeof(double);
    const auto full =
      branch_and_bound(little, {q.S, q.g, zero, q.phi}, Vector::Zero(80));
    section("limits");
    check("room for 2 nodes", full.status == ProofStatus::memory_limit);
    check("its gap is valid",
          std::isfinite(full.lower) && full.lower <= full.upper);
    check("at most a batch more", full.history.back().open <= 2 + 8);
    struct ThirdTime : public Interruption
    {
      mutable unsigned int asked = 0;

      bool
      requested() const override
      {
        return ++asked >= 3;
      }
    } third_time;
    const auto interrupted =
      branch_and_bound({},
                       {q.S, q.g, zero, q.phi, third_time},
                       Vector::Zero(80));
    check("interrupted", interrupted.status == ProofStatus::interrupted);
    check("at once", third_time.asked == 3);
    check("with a valid gap",
          std::isfinite(interrupted.lower) && interrupted.lower <= full.upper);
    BranchAndBoundParameters parameters;
    parameters.maximum_seconds = 0.;
    const auto late       = branch_and_bound(parameters, p, Vector::Zero(8));
    Problem    indefinite = p;
    indefinite.S(3, 3)    = -1.;
    const auto nothing    = branch_and_bound({}, indefinite, Vector::Zero(8));
    check("no time", late.status == ProofStatus::time_limit);
    check("an indefinite matrix has no bound",
          nothing.status == ProofStatus::no_bound &&
            !std::isfinite(nothing.lower));
  }



  /// One bond, of which both states are minima: -1/6 intact, -1/4 broken, and
  /// from the broken state the descent stays there. Then a matrix that is
  /// indefinite without its bond, so that all states with that broken fail.
  void
  test_starts()
  {
    Problem    p      = {Eigen::MatrixXd::Identity(1, 1),
                         Vector::Constant(1, -1.),
                         bonds_of(Eigen::VectorXd::Constant(1, 2.), 0.5)};
    const auto search = [&](Vector &s) {
      const MajoriseMinimise method({});
      CondensedProblem       problem(p, s);
      method.minimize(problem);
      return search_branches({p, p.phi, chain(s.size()), method}, {}, s);
    };
    Vector     s     = Vector::Zero(1);
    const auto found = search(s);
    check("a start that is its own minimum is taken",
          std::abs(found.functional + 0.25) < 1e-14 &&
            std::abs(s(0) + 1.) < 1e-14 && found.failures == 0);

    p.S(0, 0)         = -1.;
    Vector     rest   = Vector::Zero(1);
    const auto failed = search(rest);
    check("trials that fail are counted", failed.failures > 0);
  }



  /// A stiff strip that hangs over the foundation, farthest away from it at its
  /// ends, on bonds that reach there only where they pull it together. The
  /// search has to close some bonds at once; a move of edges by one node alone
  /// misses 10 of these.
  void
  test_bonds_over_gap()
  {
    Random           random(3);
    constexpr double M      = 0.5;
    unsigned int     missed = 0;
    for (unsigned int k = 0; k < 400; ++k)
      {
        const unsigned int n        = k < 200 ? 6 : 10;
        Eigen::MatrixXd    S        = 0.02 * Eigen::MatrixXd::Identity(n, n);
        const double       coupling = 5. * std::pow(10., random(0., 1.));
        for (unsigned int i = 1; i < n; ++i)
          S.block<2, 2>(i - 1, i - 1) +=
            coupling * (Eigen::Matrix2d() << 1., -1., -1., 1.).finished();
        const double middle    = random(0., n - 1.);
        const double curvature = random(0., 0.3);
        const double height    = random(1., 3.);
        Vector       hanging(n), stiffness(n);
        for (unsigned int i = 0; i < n; ++i)
          {
            hanging(i)   = -M * (height + curvature * std::pow(i - middle, 2));
            stiffness(i) = std::pow(10., random(-1.5, 0.5));
          }
        const Problem          p = {S, S * hanging, bonds_of(stiffness, M)};
        Vector                 s = hanging;
        LongVector             minimiser;
        const MajoriseMinimise method({});
        CondensedProblem       problem(p, s);
        method.minimize(problem);
        BranchSearchParameters quick;
        quick.maximum_shift = 1;
        quick.flips         = false;
        const double found =
          search_branches({p, p.phi, chain(n), method}, quick, s).functional;
        missed += found > p.enumerated_minimum(minimiser) + 1e-9;
      }
    check("bonds over a gap: the least state of 400 found", missed == 0);
  }



  /// Bonds so stiff and short that in a double nothing else is left of a
  /// diagonal entry with one: as the energy they take to break is moderate,
  /// their state matters.
  void
  test_brittle(Random &random)
  {
    unsigned int invalid = 0, wrong = 0, proved = 0, certified = 0;
    for (unsigned int k = 0; k < 300; ++k)
      {
        const unsigned int       n = 2 + k % 6;
        const Problem            p = random_bonds(random, n, k % 2 == 0, 1e-10);
        LongVector               minimiser;
        const double             minimum = p.enumerated_minimum(minimiser);
        BranchAndBoundParameters parameters;
        parameters.tolerance = 1e-10 * std::max(1., std::abs(minimum));
        const auto proof     = branch_and_bound(parameters, p, Vector::Zero(n));
        invalid += proof.lower > minimum + 1e-15;
        wrong += std::abs(proof.upper - minimum) > parameters.tolerance;
        proved += proof.status == ProofStatus::proved;

        parameters.maximum_nodes = 0;
        const auto certificate =
          branch_and_bound(parameters, p, minimiser.cast<double>());
        invalid += certificate.lower > minimum + 1e-15;
        certified += certificate.status == ProofStatus::proved;
      }
    section("brittle bonds");
    check("bounds never above the enumerated minimum", invalid == 0);
    check("the minimum found", wrong == 0);
    check("and proved", proved == 300);
    check("by a certificate in one of ten", certified > 30);
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;
  Random random;
  test_growth(random);
  test_distances(random);
  test_shift(random);
  test_larger(random);
  test_threads(random);
  test_limits(random);
  test_starts();
  test_bonds_over_gap();
  test_brittle(random);
}
