// SPDX-License-Identifier: LGPL-2.1-or-later
// The bound QP on beams and with kinks, and what coarser spaces give as a
// start. Minima are beside enumeration in oracle/shapes.

#include <debond/optimization/majorise/bound_qp.h>
#include <debond/optimization/majorise/coarse_start.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/optimization/majorise/cone_qp.h>
#include <debond/optimization/majorise/majorise_minimise.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "../check.h"
#include "random_problems.h"

using namespace Debond;

namespace
{
  /// A beam of unit length and stiffness on an elastic foundation, clamped at
  /// one end and pulled off at the other: fourth differences, with which
  /// exchanges of all wrong indices need not end. The optimality conditions are
  /// computed in extended precision.
  void
  test_beam_qp()
  {
    bool         converged  = true;
    double       worst      = 0.;
    unsigned int most_steps = 0;
    for (const unsigned int n : {60, 75, 90})
      for (const double foundation : {1e-3, 1., 1e3})
        for (const double load : {-1., -10.})
          for (const bool alternating : {false, true})
            {
              const double    h = 1. / n;
              Eigen::MatrixXd D = Eigen::MatrixXd::Identity(n, n);
              for (unsigned int i = 1; i < n; ++i)
                {
                  D(i, i - 1) = -2.;
                  if (i > 1)
                    D(i, i - 2) = 1.;
                }
              Eigen::MatrixXd M = D.transpose() * D / (h * h * h);
              M.diagonal().head(n / 2).array() += foundation * h;
              Eigen::VectorXd r = Eigen::VectorXd::Zero(n);
              r(n - 1)          = load;

              ActiveSet active(n);
              for (unsigned int i = 0; i < n; ++i)
                active[i] = alternating ? i % 2 : i < 0.4 * n;
              const BoundQPResult result =
                solve_bound_qp(M, r, Bounds(Eigen::VectorXd::Zero(n)), active);
              converged = converged && result.status == SolverStatus::success;
              raise(most_steps, result.steps);
              const LongVector force =
                r.cast<long double>() -
                M.cast<long double>() * result.x.cast<long double>();
              for (unsigned int i = 0; i < n; ++i)
                raise(worst,
                      static_cast<double>(
                        result.x(i) > 0. ? 1.L :
                        result.x(i) < 0. ? std::abs(force(i)) :
                                           -force(i)) /
                        std::abs(load));
            }
    section("bound QP on 36 beams");
    check("converged", converged);
    check("optimality conditions to 1e-7 of the load", worst, 1e-7);
  }



  /// A positive definite matrix, or that of a beam.
  Eigen::MatrixXd
  random_or_beam(Random &random, const unsigned int n, const bool is_beam)
  {
    Eigen::MatrixXd D(n, n);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        D(i, j) = !is_beam   ? random(-1., 1.) :
                  i == j     ? 1. :
                  i == j + 1 ? -2. :
                               double(i == j + 2);
    return D.transpose() * D + 1e-3 * Eigen::MatrixXd::Identity(n, n);
  }



  /// Bounds on some unknowns, kinks at random places on others, from random
  /// active sets; a quarter are beams, on which exchanges wander. The
  /// optimality conditions are computed in extended precision.
  void
  test_kinks(Random &random)
  {
    bool         converged = true;
    double       worst     = 0.;
    unsigned int n_stick = 0, n_below = 0, n_above = 0;
    for (unsigned int k = 0; k < 200; ++k)
      {
        const unsigned int    n = random.integer(2, 40);
        const Eigen::MatrixXd M = random_or_beam(random, n, k % 4 == 0);
        Eigen::VectorXd       r(n), upper(n);
        Kinks                 kinks = {Eigen::VectorXd::Zero(n), upper};
        ActiveSet             active(n);
        for (unsigned int i = 0; i < n; ++i)
          {
            r(i)           = random(-1., 1.);
            const bool has = random(0., 1.) < 0.6;
            upper(i)       = has ? infinity : random(-0.1, 1.);
            if (has)
              kinks.weight(i) = random(0.05, 1.5);
            kinks.place(i) = random(-0.5, 0.5);
            active[i]      = static_cast<char>(random.integer(0, has ? 2 : 1));
          }
        const BoundQPResult result =
          solve_bound_qp(M, r, Bounds(upper, kinks), active);
        converged = converged && result.status == SolverStatus::success;
        const LongVector force =
          r.cast<long double>() -
          M.cast<long double>() * result.x.cast<long double>();
        const double scale =
          r.lpNorm<Eigen::Infinity>() + (M * result.x).norm();
        for (unsigned int i = 0; i < n; ++i)
          {
            const double f     = static_cast<double>(force(i));
            const double x     = result.x(i);
            const double w     = kinks.weight(i);
            double       wrong = 0.;
            if (w == 0.)
              wrong = x > upper(i) ? scale : x < upper(i) ? std::abs(f) : -f;
            else if (x == kinks.place(i))
              wrong = std::abs(f) - w;
            else
              wrong = std::abs(f - (x > kinks.place(i) ? w : -w));
            raise(worst, wrong / scale);
            n_stick += w > 0. && x == kinks.place(i);
            n_above += w > 0. && x > kinks.place(i);
            n_below += w > 0. && x < kinks.place(i);
          }
      }
    section("bound QP with kinks on 200 problems");
    check("converged", converged);
    check("optimality conditions to 1e-10 of the forces", worst, 1e-10);
    check("at kinks and on both sides",
          std::min({n_stick, n_below, n_above}) > 100);
  }



  /// As before, with pairs of kinks among bounds and single ones, some started
  /// at their kinks.
  void
  test_cones(Random &random)
  {
    bool         converged = true;
    double       worst     = 0.;
    unsigned int n_stick = 0, n_slide = 0;
    for (unsigned int k = 0; k < 200; ++k)
      {
        const unsigned int    n = 2 * random.integer(1, 20);
        const Eigen::MatrixXd M = random_or_beam(random, n, k % 4 == 0);
        Eigen::VectorXd       r(n), upper(n), start(n);
        Kinks                 kinks = {Eigen::VectorXd::Zero(n), upper, {}};
        for (unsigned int i = 0; i < n; ++i)
          {
            r(i)           = random(-1., 1.);
            upper(i)       = infinity;
            kinks.place(i) = random(-0.5, 0.5);
            kinks.partner.push_back(i);
          }
        for (unsigned int i = 0; i < n; i += 2)
          {
            const unsigned int kind = random.integer(0, 3);
            if (kind == 0)
              upper(i) = random(-0.1, 1.);
            else
              kinks.weight(i) = std::pow(10., random(-3., 1.));
            if (kind > 1)
              {
                kinks.weight(i + 1) = kinks.weight(i);
                std::swap(kinks.partner[i], kinks.partner[i + 1]);
              }
          }
        start = kinks.place;
        if (k % 2 == 0)
          start.setZero();
        ActiveSet           active(n, 0);
        const Bounds        bounds(upper, kinks);
        const BoundQPResult result = ConeQP(M, r, bounds).solve(start, active);
        converged = converged && can_be_verified(result.status);
        const LongVector exact =
          r.cast<long double>() -
          M.cast<long double>() * result.x.cast<long double>();
        const Eigen::VectorXd force = exact.cast<double>();
        const double          scale =
          r.lpNorm<Eigen::Infinity>() + (M * result.x).norm();
        for (unsigned int i = 0; i < n; ++i)
          {
            const unsigned int    j = kinks.partner[i];
            const Eigen::Vector2d v(result.x(i) - kinks.place(i),
                                    j == i ? 0. : result.x(j) - kinks.place(j));
            const Eigen::Vector2d f(force(i), j == i ? 0. : force(j));
            const double          w = kinks.weight(i);
            double                wrong;
            if (w == 0.)
              wrong = result.x(i) > upper(i) ? scale :
                      result.x(i) < upper(i) ? std::abs(f(0)) :
                                               -f(0);
            else if (v.norm() == 0.)
              wrong = f.norm() - w;
            else
              wrong = (f - w * v.normalized()).norm();
            raise(worst, wrong / scale);
            n_stick += j != i && v.norm() == 0.;
            n_slide += j != i && v.norm() > 0.;
          }
      }
    section("bound QP with pairs of kinks on 200 problems");
    check("converged", converged);
    check("optimality conditions to 1e-10 of the forces", worst, 1e-10);
    check("some slide and some stick", std::min(n_stick, n_slide) > 100);
  }



  /// Neighbouring pairs of unknowns move together on each coarser level.
  void
  test_coarse_start(Random &random)
  {
    bool         feasible = true, below_rest = true, converged = true;
    bool         all_named  = true;
    unsigned int n_problems = 50, n_failed = 0;
    for (unsigned int k = 0; k < n_problems; ++k)
      {
        const Problem p = random_bonds(random, 16, false);
        std::vector<Eigen::SparseMatrix<double>> prolongations;
        for (unsigned int n = 16; n > 4; n /= 2)
          {
            Eigen::SparseMatrix<double> P(n, n / 2);
            for (unsigned int i = 0; i < n; ++i)
              P.insert(i, i / 2) = 1.;
            prolongations.push_back(P);
          }
        const MajoriseMinimise   method({});
        std::vector<std::string> failures;
        coarse_start(p, prolongations, MajoriseMinimise({1e-10, 1}), failures);
        n_failed += failures.size();
        for (const std::string &failure : failures)
          all_named = all_named &&
                      failure.find(" after 1 iterations") != std::string::npos;
        failures.clear();
        Eigen::VectorXd s = coarse_start(p, prolongations, method, failures);
        converged         = converged && failures.empty();
        for (const double entry : s)
          feasible = feasible && entry <= 0.;
        below_rest =
          below_rest && s.dot(0.5 * p.S * s - p.g) + p.phi.change(s) <= 0.;
        CondensedProblem problem(p, s);
        converged =
          converged && method.minimize(problem).status == SolverStatus::success;
      }
    section("start from coarser spaces on ", n_problems, " problems");
    check("feasible", feasible);
    check("not above rest", below_rest);
    check("converged from there", converged);
    check("failures of levels are told", all_named && n_failed > 0);
  }



  /// The square root of the second differences on 255 nodes, which resembles
  /// the elastic half plane, with bonds on a part of them and forces that
  /// change their sign: from a guess by coarser spaces one or two systems do
  /// where from no contact it takes more.
  void
  test_active_set_guess()
  {
    const unsigned int n           = 255;
    Eigen::MatrixXd    differences = Eigen::MatrixXd::Zero(n, n);
    differences.diagonal().setConstant(2.);
    differences.diagonal<1>().setConstant(-1.);
    differences.diagonal<-1>().setConstant(-1.);
    const Eigen::MatrixXd root =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(differences)
        .operatorSqrt();
    const Eigen::MatrixXd S = 0.5 * (root + root.transpose());

    std::vector<Eigen::SparseMatrix<double>> prolongations;
    for (unsigned int fine = n; fine > 20; fine /= 2)
      {
        Eigen::SparseMatrix<double> P(fine, fine / 2);
        for (unsigned int j = 0; j < fine / 2; ++j)
          {
            P.insert(2 * j, j)     = 0.5;
            P.insert(2 * j + 1, j) = 1.;
            P.insert(2 * j + 2, j) = 0.5;
          }
        prolongations.push_back(P);
      }
    const ActiveSetGuess guess(S, prolongations);

    bool         same = true;
    unsigned int most = 0, fewest_without = n;
    for (unsigned int waves = 1; waves <= 4; ++waves)
      for (const double stiffness : {0., 1e-2, 1.})
        {
          Eigen::SparseMatrix<double> E(n, n);
          Eigen::VectorXd             r(n);
          for (unsigned int i = 0; i < n; ++i)
            {
              E.insert(i, i) = i < n / 3 ? stiffness : 0.;
              r(i)           = std::sin(6.3 * waves * (i + 0.3) / n) - 0.2;
            }
          Eigen::MatrixXd M = S;
          M += E;
          const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n);
          ActiveSet             active(n, 0);
          const BoundQPResult   without = solve_bound_qp(M, r, zero, active);
          ActiveSet             guessed = guess.active_set(M, E, r, zero);
          const BoundQPResult   with    = solve_bound_qp(M, r, zero, guessed);
          same = same && with.status == SolverStatus::success &&
                 (with.x - without.x).norm() <= 1e-12 * without.x.norm();
          raise(most, with.steps);
          fewest_without = std::min(fewest_without, without.steps);
        }
    section("active sets guessed by coarser spaces");
    check("the same minima", same);
    check("in at most two systems", most <= 2);
    check("in place of at least three", fewest_without >= 3);
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;
  Random random;
  test_beam_qp();
  test_kinks(random);
  test_cones(random);
  test_coarse_start(random);
  test_active_set_guess();
}
