// SPDX-License-Identifier: LGPL-2.1-or-later
// The bundle QP on problems generated from a known solution: choose d, the
// active cuts and bounds and their multipliers, and put the data together so
// that they satisfy the optimality conditions.

#include <debond/optimization/bundle/bundle_qp.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>
#include <string>

#include "../check.h"

using namespace Debond;

namespace
{
  struct Shape
  {
    unsigned int n;             // components of d
    unsigned int n_bounded;     // of these, the first have bounds
    unsigned int cuts;          // all cuts
    unsigned int active_cuts;   // with positive multiplier
    unsigned int active_bounds; // with positive multiplier
  };



  struct Problem
  {
    Eigen::MatrixXd eta; // n x cuts
    Eigen::VectorXd beta;
    Eigen::VectorXd b;
    double          u;
    Eigen::VectorXd d; // the solution
    double          v;
  };



  class Generator
  {
  public:
    double
    symmetric()
    {
      return std::uniform_real_distribution<double>(-1., 1.)(engine);
    }

    double
    positive()
    {
      return std::uniform_real_distribution<double>(0.1, 1.)(engine);
    }

    /// A value between 10^-exponent and 10^exponent.
    double
    magnitude(const double exponent)
    {
      return std::pow(10., exponent * symmetric());
    }

    unsigned int
    integer(const unsigned int lowest, const unsigned int highest)
    {
      return std::uniform_int_distribution<unsigned int>(lowest,
                                                         highest)(engine);
    }

    Shape
    shape()
    {
      Shape s;
      s.n             = integer(2, 60);
      s.n_bounded     = integer(0, s.n - 1);
      s.active_bounds = integer(0, s.n_bounded);
      s.active_cuts   = integer(1, s.n - s.active_bounds);
      s.cuts          = s.active_cuts + integer(0, 40);
      return s;
    }

    Problem
    problem(const Shape &s, const double u, const double cut_spread)
    {
      Problem p;
      p.u   = u;
      p.d   = Eigen::VectorXd::NullaryExpr(s.n, [&]() { return symmetric(); });
      p.eta = Eigen::MatrixXd::NullaryExpr(s.n, s.cuts, [&]() {
        return u * symmetric();
      });
      for (unsigned int j = 0; j + 1 < s.cuts; ++j)
        p.eta.col(j) *= magnitude(cut_spread);

      // u d + sum_j lambda_j eta_j + mu = 0 fixes the last active cut.
      Eigen::VectorXd lambda(s.active_cuts);
      for (double &l : lambda)
        l = positive();
      lambda /= lambda.sum();
      Eigen::VectorXd rest = -u * p.d;
      for (unsigned int i = 0; i < s.active_bounds; ++i)
        rest(i) -= u * positive();
      for (unsigned int j = 0; j + 1 < s.active_cuts; ++j)
        rest -= lambda(j) * p.eta.col(j);
      p.eta.col(s.active_cuts - 1) = rest / lambda(s.active_cuts - 1);

      const Eigen::VectorXd slopes = p.eta.transpose() * p.d;
      p.v                          = slopes.minCoeff();
      p.beta                       = slopes.array() - p.v;
      for (unsigned int j = s.active_cuts; j < s.cuts; ++j)
        p.beta(j) += u * positive() * magnitude(2.);
      p.b = p.d.head(s.n_bounded);
      for (unsigned int i = s.active_bounds; i < s.n_bounded; ++i)
        p.b(i) += positive();
      return p;
    }

    /// Every cut a second time, moved by the relative amount @p difference.
    void
    repeat_cuts(Problem &p, const double difference)
    {
      const unsigned int m = p.eta.cols(), n = p.eta.rows();
      p.eta.conservativeResize(n, 2 * m);
      p.beta.conservativeResize(2 * m);
      for (unsigned int j = 0; j < m; ++j)
        {
          const double length = p.eta.col(j).norm() * difference;
          for (unsigned int i = 0; i < n; ++i)
            p.eta(i, m + j) = p.eta(i, j) + length * symmetric();
          p.beta(m + j) =
            p.beta(j) + (p.eta.col(m + j) - p.eta.col(j)).dot(p.d);
        }
    }

  private:
    std::mt19937_64 engine{20260701};
  };



  struct Record
  {
    double       residual     = 0.; // largest of the solver's own
    double       error        = 0.; // in d and v, from the known solution
    unsigned int not_optimal  = 0;
    unsigned int warm_steps   = 0;  // started at the solution
    double       longest_run  = 0.; // steps over cuts and bounds
    double       order_change = 0.; // of d if the cuts are reversed
  };



  BundleQP
  load(const Problem &p, const bool reversed)
  {
    const unsigned int n_bounded = p.b.size(), m = p.eta.cols(),
                       n_free = p.eta.rows() - n_bounded;
    BundleQP qp(m, n_bounded);
    for (unsigned int j = 0; j < m; ++j)
      {
        const auto cut = [&](const unsigned int k) {
          return p.eta.col(reversed ? m - 1 - k : k);
        };
        Eigen::VectorXd products(j + 1);
        for (unsigned int k = 0; k <= j; ++k)
          products(k) = cut(k).tail(n_free).dot(cut(j).tail(n_free));
        qp.add_cut(products, cut(j).head(n_bounded));
      }
    return qp;
  }



  Eigen::VectorXd
  direction(const Problem &p, const BundleQP::Solution &s, const bool reversed)
  {
    Eigen::VectorXd d =
      -(p.eta * (reversed ? s.lambda.reverse().eval() : s.lambda)) / p.u;
    d.head(s.d.size()) = s.d;
    return d;
  }



  void
  check(const Problem &p, Record &record)
  {
    BundleQP              qp     = load(p, false);
    const auto            cold   = qp.solve(p.beta, p.b, p.u);
    const Eigen::VectorXd d_cold = direction(p, cold, false);

    record.not_optimal += cold.status != BundleQP::Status::optimal;
    record.residual = std::max(record.residual, cold.residual());
    record.error =
      std::max({record.error,
                (d_cold - p.d).norm() / p.d.norm(),
                std::abs(cold.v - p.v) /
                  (p.eta.transpose() * p.d).cwiseAbs().maxCoeff()});
    record.longest_run =
      std::max(record.longest_run,
               double(cold.steps) / (p.beta.size() + p.b.size()));

    const auto warm = qp.solve(p.beta, p.b, p.u);
    record.warm_steps += warm.steps;

    BundleQP              turned   = load(p, true);
    const auto            reversed = turned.solve(p.beta.reverse(), p.b, p.u);
    const Eigen::VectorXd d        = direction(p, reversed, true);
    record.order_change =
      std::max(record.order_change, (d - d_cold).norm() / d_cold.norm());
  }



  void
  print(const std::string &name, const Record &record, const double tolerance)
  {
    std::cout << name << "\n  all optimal: " << verdict(record.not_optimal == 0)
              << "\n  residuals below 1e-10: "
              << verdict(record.residual, 1e-10) << "\n  known solution to "
              << tolerance << ": " << verdict(record.error, tolerance)
              << "\n  warm start takes no step: "
              << verdict(record.warm_steps == 0)
              << "\n  same for the reversed order to " << tolerance << ": "
              << verdict(record.order_change, tolerance) << '\n';
    if (print_figures)
      std::cout << name << ": residual " << record.residual << ", error "
                << record.error << ", steps per constraint "
                << record.longest_run << ", not optimal " << record.not_optimal
                << ", warm steps " << record.warm_steps << ", order "
                << record.order_change << '\n';
  }



  /// Data that are not finite have no solution, whatever the working set.
  bool
  is_told_from_optimal(const double product,
                       const double component,
                       const double beta,
                       const double b)
  {
    BundleQP qp(2, 1);
    qp.add_cut(Eigen::VectorXd::Ones(1), Eigen::VectorXd::Ones(1));
    qp.add_cut(Eigen::Vector2d(0.5, product),
               Eigen::VectorXd::Constant(1, component));
    return qp.solve(Eigen::Vector2d(0., beta),
                    Eigen::VectorXd::Constant(1, b),
                    1.)
             .status != BundleQP::Status::optimal;
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;

  constexpr unsigned int n_problems = 1000;
  Generator              generator;

  Record regular, scaled, repeated, nearly_repeated, bounds_only, many_cuts;
  for (unsigned int k = 0; k < n_problems; ++k)
    {
      check(generator.problem(generator.shape(), 1., 0.), regular);
      check(generator.problem(generator.shape(), generator.magnitude(8.), 3.),
            scaled);

      Problem twice = generator.problem(generator.shape(), 1., 0.);
      generator.repeat_cuts(twice, 0.);
      check(twice, repeated);

      Problem nearly_twice = generator.problem(generator.shape(), 1., 0.);
      generator.repeat_cuts(nearly_twice, 1e-10);
      check(nearly_twice, nearly_repeated);

      Shape all_bounds         = generator.shape();
      all_bounds.n_bounded     = all_bounds.n - 1;
      all_bounds.active_bounds = all_bounds.n - 1;
      all_bounds.active_cuts   = 1;
      check(generator.problem(all_bounds, 1., 0.), bounds_only);
    }
  for (unsigned int k = 0; k < 10; ++k)
    check(generator.problem({400, 100, 200, 40, 50}, 1., 0.), many_cuts);

  print("regular", regular, 1e-8);
  // The known solution itself suffers from rounding of the data times a
  // condition number of up to 1e9.
  print("badly scaled", scaled, 1e-5);
  print("every cut repeated", repeated, 1e-8);
  print("every cut repeated with a difference of 1e-10", nearly_repeated, 1e-6);
  print("all bounds active", bounds_only, 1e-8);
  print("200 cuts, 100 bounds", many_cuts, 1e-8);

  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::cout << "finite data are optimal: "
            << verdict(!is_told_from_optimal(2., 1., 0.1, 0.1))
            << ", NaN in products, components, beta, b is not:";
  for (const bool told : {is_told_from_optimal(nan, 1., 0.1, 0.1),
                          is_told_from_optimal(2., nan, 0.1, 0.1),
                          is_told_from_optimal(2., 1., nan, 0.1),
                          is_told_from_optimal(2., 1., 0.1, nan)})
    std::cout << ' ' << verdict(told);
  std::cout << '\n';
}
