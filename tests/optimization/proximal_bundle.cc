// SPDX-License-Identifier: LGPL-2.1-or-later
// The proximal bundle method on nonsmooth functions with known minima.
// Functions, starts and minima: L. Luksan, J. Vlcek, "Test problems for
// nonsmooth unconstrained and linearly constrained optimization", Technical
// Report 798, Institute of Computer Science, Prague, 2000, and M. M. Makela, P.
// Neittaanmaki, "Nonsmooth Optimization", World Scientific, 1992.

#include <debond/optimization/bundle/proximal_bundle.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "../check.h"
#include "plain_restriction.h"

using namespace Debond;

namespace
{
  using Values = std::vector<double>;

  /// f(x), and one subgradient in the second argument.
  using Function = std::function<double(const Values &, Values &)>;



  class TestObjective : public Objective
  {
  public:
    explicit TestObjective(const Function &f)
      : f(f)
    {}

    double
    value(const DofVector &x) const override
    {
      Values g(x.size());
      return f(Values(x.begin(), x.end()), g);
    }

    void
    subgradient(const DofVector &x, DofVector &eta) const override
    {
      Values g(x.size());
      f(Values(x.begin(), x.end()), g);
      for (unsigned int i = 0; i < g.size(); ++i)
        eta(i) = g[i];
    }

    std::unique_ptr<LineRestriction>
    along(const DofVector &x, const DofVector &d) const override
    {
      return std::make_unique<PlainRestriction>(*this, x, d);
    }

  private:
    Function f;
  };



  /// The largest of several smooth functions, given as (value, gradient).
  struct Piece
  {
    double value;
    Values gradient;
  };

  double
  largest(const std::vector<Piece> &pieces, Values &g)
  {
    const Piece *top = &pieces.front();
    for (const Piece &piece : pieces)
      if (piece.value > top->value)
        top = &piece;
    g = top->gradient;
    return top->value;
  }



  struct Case
  {
    std::string  name;
    Function     f;
    Values       start;
    double       minimum;
    double       gamma; // 0 for convex functions
    unsigned int most_iterations;
    UpperBounds  bounds = {};
  };



  Piece
  combined(const Piece &a, const double factor, const Piece &b)
  {
    Piece c = a;
    c.value += factor * b.value;
    for (unsigned int i = 0; i < c.gradient.size(); ++i)
      c.gradient[i] += factor * b.gradient[i];
    return c;
  }



  double
  cb2(const Values &x, Values &g)
  {
    const double e = 2. * std::exp(x[1] - x[0]);
    return largest({{x[0] * x[0] + std::pow(x[1], 4),
                     {2. * x[0], 4. * std::pow(x[1], 3)}},
                    {std::pow(2. - x[0], 2) + std::pow(2. - x[1], 2),
                     {-2. * (2. - x[0]), -2. * (2. - x[1])}},
                    {e, {-e, e}}},
                   g);
  }



  double
  ql(const Values &x, Values &g)
  {
    const Piece f{x[0] * x[0] + x[1] * x[1], {2. * x[0], 2. * x[1]}};
    return largest({f,
                    combined(f, 10., {-4. * x[0] - x[1] + 4., {-4., -1.}}),
                    combined(f, 10., {-x[0] - 2. * x[1] + 6., {-1., -2.}})},
                   g);
  }



  double
  mifflin1(const Values &x, Values &g)
  {
    const double circle = x[0] * x[0] + x[1] * x[1] - 1.;
    g = {-1. + (circle > 0. ? 40. * x[0] : 0.), circle > 0. ? 40. * x[1] : 0.};
    return -x[0] + 20. * std::max(circle, 0.);
  }



  double
  mifflin2(const Values &x, Values &g)
  {
    const double circle = x[0] * x[0] + x[1] * x[1] - 1.;
    const double factor = 2. + (circle > 0. ? 1.75 : -1.75);
    g                   = {-1. + factor * 2. * x[0], factor * 2. * x[1]};
    return -x[0] + factor * circle;
  }



  double
  crescent(const Values &x, Values &g)
  {
    const double q = x[0] * x[0] + std::pow(x[1] - 1., 2);
    return largest({{q + x[1] - 1., {2. * x[0], 2. * (x[1] - 1.) + 1.}},
                    {-q + x[1] + 1., {-2. * x[0], -2. * (x[1] - 1.) + 1.}}},
                   g);
  }



  double
  rosen_suzuki(const Values &x, Values &g)
  {
    const Piece f{
      x[0] * x[0] + x[1] * x[1] + 2. * x[2] * x[2] + x[3] * x[3] - 5. * x[0] -
        5. * x[1] - 21. * x[2] + 7. * x[3],
      {2. * x[0] - 5., 2. * x[1] - 5., 4. * x[2] - 21., 2. * x[3] + 7.}};
    const Piece a{
      x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3] + x[0] - x[1] +
        x[2] - x[3] - 8.,
      {2. * x[0] + 1., 2. * x[1] - 1., 2. * x[2] + 1., 2. * x[3] - 1.}};
    const Piece b{x[0] * x[0] + 2. * x[1] * x[1] + x[2] * x[2] +
                    2. * x[3] * x[3] - x[0] - x[3] - 10.,
                  {2. * x[0] - 1., 4. * x[1], 2. * x[2], 4. * x[3] - 1.}};
    const Piece c{2. * x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + 2. * x[0] -
                    x[1] - x[3] - 5.,
                  {4. * x[0] + 2., 2. * x[1] - 1., 2. * x[2], -1.}};
    return largest(
      {f, combined(f, 10., a), combined(f, 10., b), combined(f, 10., c)}, g);
  }



  double
  maxq(const Values &x, Values &g)
  {
    unsigned int top = 0;
    for (unsigned int i = 0; i < x.size(); ++i)
      if (x[i] * x[i] > x[top] * x[top])
        top = i;
    g.assign(x.size(), 0.);
    g[top] = 2. * x[top];
    return x[top] * x[top];
  }



  double
  maxl(const Values &x, Values &g)
  {
    unsigned int top = 0;
    for (unsigned int i = 0; i < x.size(); ++i)
      if (std::abs(x[i]) > std::abs(x[top]))
        top = i;
    g.assign(x.size(), 0.);
    g[top] = x[top] > 0. ? 1. : -1.;
    return std::abs(x[top]);
  }



  double
  goffin(const Values &x, Values &g)
  {
    unsigned int top = 0;
    double       sum = 0.;
    for (unsigned int i = 0; i < x.size(); ++i)
      {
        sum += x[i];
        if (x[i] > x[top])
          top = i;
      }
    g.assign(x.size(), -1.);
    g[top] += x.size();
    return x.size() * x[top] - sum;
  }



  /// Springs of stiffness k pulled by forces p off a foundation that they are
  /// glued to by the paper's law with M = 1: each spring has
  /// k/2 s^2 - p s + j_1(s), s <= 0. It stays at s = p / (k + a) or, once
  /// broken, at s = p / k; or it is pressed to s = 0.
  double
  glued_springs(const Values &x, Values &g)
  {
    const double k = 1., a = 3.;
    const Values p{-0.8, 2., -5., -6., 0.};
    double       sum = 0.;
    for (unsigned int i = 0; i < x.size(); ++i)
      {
        const bool bonded = x[i] >= -1. && x[i] <= 0.;
        sum += 0.5 * k * x[i] * x[i] - p[i] * x[i] +
               (x[i] < -1. ? 0.5 * a :
                bonded     ? 0.5 * a * x[i] * x[i] :
                             0.);
        g[i] = k * x[i] - p[i] + (bonded ? a * x[i] : 0.);
      }
    return sum;
  }



  void
  run(const Case &test)
  {
    ProximalBundleParameters parameters;
    parameters.u                  = 1.;
    parameters.gamma              = test.gamma;
    parameters.t_bar              = 0.01;
    parameters.m_L                = 0.01;
    parameters.epsilon_s          = 1e-10;
    parameters.bundle_size        = 100;
    parameters.maximum_iterations = 5000;

    DofVector x(test.start.size());
    for (unsigned int i = 0; i < test.start.size(); ++i)
      x(i) = test.start[i];
    for (unsigned int i = 0; i < test.bounds.indices.size(); ++i)
      x(test.bounds.indices[i]) =
        std::min(x(test.bounds.indices[i]), test.bounds.upper[i]);

    const TestObjective objective(test.f);
    const auto          result =
      ProximalBundle(parameters).minimize(objective, test.bounds, x);

    bool inside = true, monotone = true;
    for (unsigned int i = 0; i < test.bounds.indices.size(); ++i)
      inside = inside && x(test.bounds.indices[i]) <= test.bounds.upper[i];
    for (unsigned int k = 1; k < result.history.size(); ++k)
      monotone = monotone && result.history[k].functional <=
                               result.history[k - 1].functional;

    const double error = result.functional - test.minimum;
    section(test.name);
    check("success", result.status == SolverStatus::success);
    check("minimum",
          std::abs(error) / std::max(1., std::abs(test.minimum)),
          1e-8);
    check("monotone", monotone);
    check("feasible", inside);
    check("iterations", result.iterations(), test.most_iterations);
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;

  Values maxq_start(20), goffin_start(50);
  for (unsigned int i = 0; i < 20; ++i)
    maxq_start[i] = i < 10 ? i + 1. : -(i + 1.);
  for (unsigned int i = 0; i < 50; ++i)
    goffin_start[i] = i + 1. - 25.5;

  const std::vector<Case> cases{
    {"CB2", cb2, {1., -0.1}, 1.9522244936, 0., 60},
    {"QL", ql, {-1., 5.}, 7.2, 0., 60},
    {"Mifflin 1", mifflin1, {0.8, 0.6}, -1., 0., 300},
    {"Rosen-Suzuki", rosen_suzuki, {0., 0., 0., 0.}, -44., 0., 150},
    {"MAXQ", maxq, maxq_start, 0., 0., 400},
    {"MAXL", maxl, maxq_start, 0., 0., 400},
    {"Goffin", goffin, goffin_start, 0., 0., 400},
    {"Crescent (nonconvex)", crescent, {-1.5, 2.}, 0., 0.5, 200},
    {"Mifflin 2 (nonconvex)", mifflin2, {-1., -1.}, -1., 0.5, 200},
    // MAXQ pushed away from its minimum by x_1 <= -2, x_20 <= -3.
    {"bounded MAXQ", maxq, maxq_start, 9., 0., 500, {{0, 19}, {-2., -3.}}},
    // Bonded at -0.2, pressed, broken at -5 and -6, at rest: each the only
    // local minimum of its spring.
    {"glued springs (nonconvex)",
     glued_springs,
     {0., 0., 0., 0., 0.},
     -0.5 * 0.64 / 4. + (1.5 - 0.5 * 25.) + (1.5 - 0.5 * 36.),
     0.5,
     200,
     {{0, 1, 2, 3, 4}, {0., 0., 0., 0., 0.}}}};

  for (const Case &test : cases)
    run(test);

  // Out of iterations is not success.
  ProximalBundleParameters parameters;
  parameters.maximum_iterations = 3;
  DofVector x(2);
  x(0) = 1.;
  const auto short_run =
    ProximalBundle(parameters).minimize(TestObjective(cb2), {}, x);
  check("stopped early, with a message",
        short_run.status == SolverStatus::iteration_limit &&
          !short_run.message.empty());

  // A function that is not finite is named.
  const Function broken = [](const Values &v, Values &g) {
    g[0] = 1.;
    return v[0] < 0. ? std::nan("") : v[0];
  };
  DofVector y(1);
  y(0) = -1.;
  const auto not_finite =
    ProximalBundle(parameters).minimize(TestObjective(broken), {}, y);
  check("not a number", not_finite.status == SolverStatus::not_finite);
}
