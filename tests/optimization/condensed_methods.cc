// SPDX-License-Identifier: LGPL-2.1-or-later
// Methods for a few unknowns with a dense matrix, against enumeration: the
// bound QP over all active sets, majorise-minimise and the bundle method in the
// energy norm over all states (pressed, bonded, broken) of all unknowns.

#include <deal.II/lac/full_matrix.h>

#include <debond/linear_algebra/dof_vector.h>
#include <debond/optimization/bundle/metric_direction.h>
#include <debond/optimization/bundle/proximal_bundle.h>
#include <debond/optimization/majorise/bound_qp.h>
#include <debond/optimization/majorise/coarse_start.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/optimization/majorise/majorise_minimise.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include "../check.h"
#include "plain_restriction.h"

using namespace Debond;

namespace
{
  /// sum_i w_i j_1(s_i) with the paper's j_1.
  class Bonds : public PiecewiseQuadratic
  {
  public:
    Eigen::VectorXd stiffness; // w_i a
    double          threshold; // M

    bool
    broken(const double s) const
    {
      return s < -threshold;
    }

    double
    value(const VectorView &s) const override
    {
      double sum = 0.;
      for (unsigned int i = 0; i < s.size(); ++i)
        sum +=
          0.5 * stiffness(i) * std::pow(broken(s(i)) ? threshold : s(i), 2);
      return sum;
    }

    Eigen::VectorXd
    subgradient(const VectorView &s) const override
    {
      Eigen::VectorXd xi(s.size());
      for (unsigned int i = 0; i < s.size(); ++i)
        xi(i) = broken(s(i)) ? 0. : stiffness(i) * s(i);
      return xi;
    }

    Eigen::SparseMatrix<double>
    curvature(const VectorView &s) const override
    {
      Eigen::SparseMatrix<double> matrix(s.size(), s.size());
      for (unsigned int i = 0; i < s.size(); ++i)
        if (!broken(s(i)))
          matrix.insert(i, i) = stiffness(i);
      return matrix;
    }
  };



  class Energy : public Objective
  {
  public:
    Energy(const Eigen::MatrixXd &matrix,
           const Eigen::VectorXd &load,
           const Bonds           &bonds)
      : S(matrix)
      , g(load)
      , phi(bonds)
    {}

    double
    value(const VectorView &s) const
    {
      return s.dot(0.5 * S * s - g) + phi.value(s);
    }

    double
    value(const dealii::Vector<double> &s) const override
    {
      return value(eigen_view(s));
    }

    void
    subgradient(const dealii::Vector<double> &s,
                dealii::Vector<double>       &eta) const override
    {
      const auto            point = eigen_view(s);
      const Eigen::VectorXd sum   = S * point - g + phi.subgradient(point);
      eta = dealii::Vector<double>(sum.begin(), sum.end());
    }

    std::unique_ptr<LineRestriction>
    along(const DofVector &x, const DofVector &d) const override
    {
      return std::make_unique<PlainRestriction>(*this, x, d);
    }

  private:
    const Eigen::MatrixXd &S;
    const Eigen::VectorXd &g;
    const Bonds           &phi;
  };



  struct Problem
  {
    Eigen::MatrixXd S;
    Eigen::VectorXd g;
    Bonds           bonds;
  };



  Problem
  random_problem(std::mt19937_64 &engine, const unsigned int n)
  {
    std::uniform_real_distribution<double> uniform(-1., 1.);

    // Neighbours are coupled, as on a contact boundary.
    Problem p;
    p.S = Eigen::MatrixXd::Zero(n, n);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        p.S(i, j) = -std::exp(-std::abs(double(i) - double(j))) *
                    (1. + 0.3 * uniform(engine));
    p.S = (0.5 * (p.S + p.S.transpose())).eval();
    for (unsigned int i = 0; i < n; ++i)
      p.S(i, i) = 0.2 - (p.S.row(i).sum() - p.S(i, i));

    p.g.resize(n);
    p.bonds.stiffness.resize(n);
    p.bonds.threshold = 0.5 + 0.4 * uniform(engine);
    for (unsigned int i = 0; i < n; ++i)
      {
        p.g(i)               = 1.5 * uniform(engine) - 0.5;
        p.bonds.stiffness(i) = 1. + uniform(engine);
      }
    return p;
  }



  /// The values at all points that satisfy the law: for each choice of states,
  /// the solution of its linear system if it has those states.
  std::vector<double>
  stationary_values(const Problem &p)
  {
    enum State : unsigned int
    {
      pressed,
      bonded,
      broken
    };
    const unsigned int  n = p.g.size();
    std::vector<double> values;
    for (unsigned int code = 0; code < std::pow(3, n); ++code)
      {
        std::vector<unsigned int> state(n);
        std::vector<int>          free;
        Eigen::MatrixXd           M    = p.S;
        unsigned int              rest = code;
        for (unsigned int i = 0; i < n; ++i, rest /= 3)
          {
            state[i] = rest % 3;
            if (state[i] == bonded)
              M(i, i) += p.bonds.stiffness(i);
            if (state[i] != pressed)
              free.push_back(i);
          }
        const Eigen::VectorXd &g = p.g;
        Eigen::VectorXd        s = Eigen::VectorXd::Zero(n);
        if (!free.empty())
          {
            const Eigen::VectorXd s_free = M(free, free).llt().solve(g(free));
            for (unsigned int k = 0; k < free.size(); ++k)
              s(free[k]) = s_free(k);
          }
        const Eigen::VectorXd mu         = g - p.S * s;
        bool                  consistent = true;
        for (unsigned int i = 0; i < n; ++i)
          consistent =
            consistent &&
            (state[i] == pressed ? mu(i) >= 0. :
             state[i] == bonded  ? s(i) <= 0. && !p.bonds.broken(s(i)) :
                                   p.bonds.broken(s(i)));
        if (consistent)
          values.push_back(Energy(p.S, p.g, p.bonds).value(s));
      }
    return values;
  }



  void
  test_bound_qp(std::mt19937_64 &engine)
  {
    std::uniform_real_distribution<double> uniform(-1., 1.);
    double                                 worst      = 0.;
    unsigned int                           most_steps = 0;
    bool                                   converged  = true;
    for (unsigned int k = 0; k < 500; ++k)
      {
        const unsigned int    n = 1 + k % 9;
        const Eigen::MatrixXd B =
          Eigen::MatrixXd::NullaryExpr(n, n, [&]() { return uniform(engine); });
        const Eigen::MatrixXd M =
          B * B.transpose() + 0.01 * Eigen::MatrixXd::Identity(n, n);
        const Eigen::VectorXd r =
          Eigen::VectorXd::NullaryExpr(n, [&]() { return uniform(engine); });
        const Eigen::VectorXd b =
          Eigen::VectorXd::NullaryExpr(n, [&]() { return uniform(engine); });

        double best = std::numeric_limits<double>::infinity();
        for (unsigned int set = 0; set < (1u << n); ++set)
          {
            std::vector<int> free;
            Eigen::VectorXd  x = b;
            for (unsigned int i = 0; i < n; ++i)
              if ((set >> i) % 2 == 0)
                {
                  free.push_back(i);
                  x(i) = 0.;
                }
            if (!free.empty())
              {
                const Eigen::VectorXd x_free =
                  M(free, free).llt().solve((r - M * x)(free));
                for (unsigned int i = 0; i < free.size(); ++i)
                  x(free[i]) = x_free(i);
              }
            if (((x - b).array() <= 1e-12).all())
              best = std::min(best, x.dot(0.5 * (M * x) - r));
          }

        ActiveSet  active(n, 0);
        const auto result = solve_bound_qp(M, r, b, active);
        converged         = converged && result.status == SolverStatus::success;
        raise(most_steps, result.steps);
        raise(worst,
              std::abs(result.x.dot(0.5 * (M * result.x) - r) - best) /
                (1. + std::abs(best)));
      }
    section("bound QP on 500 problems");
    check("converged", converged);
    check("enumerated minimum to 1e-10", worst, 1e-10);
  }



  /// A beam of unit length and stiffness on an elastic foundation, clamped at
  /// one end and pulled off at the other: fourth differences, with which
  /// exchanges of all wrong indices need not end. The optimality conditions are
  /// computed in extended precision.
  void
  test_beam_qp()
  {
    using LongVector        = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
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
                solve_bound_qp(M, r, Eigen::VectorXd::Zero(n), active);
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



  void
  test_minimisers(std::mt19937_64 &engine)
  {
    double                 worst_mm = 0., worst_bundle = 0.;
    unsigned int           mm_failures = 0, bundle_failures = 0, rises = 0;
    unsigned int           mm_global = 0, bundle_global = 0, several = 0;
    unsigned int           most_mm = 0, most_bundle = 0;
    unsigned int           misnamed = 0, converged_at_once = 0;
    constexpr unsigned int n_problems = 300;
    for (unsigned int k = 0; k < n_problems; ++k)
      {
        const unsigned int  n      = 2 + k % 6;
        const Problem       p      = random_problem(engine, n);
        std::vector<double> values = stationary_values(p);
        std::sort(values.begin(), values.end());
        several += values.size() > 1 && values[1] - values[0] > 1e-8;
        const auto distance = [&](const double value) {
          double least = std::numeric_limits<double>::infinity();
          for (const double v : values)
            least = std::min(least, std::abs(value - v));
          return least;
        };

        // From rest, and from anywhere.
        Eigen::VectorXd start = Eigen::VectorXd::Zero(n);
        if (k % 2 == 1)
          for (double &entry : start)
            entry = -std::abs(
              std::uniform_real_distribution<double>(-2., 2.)(engine));

        Eigen::VectorXd  s = start;
        CondensedProblem condensed(p.S, p.g, p.bonds, s);
        const auto       mm = MajoriseMinimise({}).minimize(condensed);
        mm_failures += mm.status != SolverStatus::success;
        raise(worst_mm, distance(mm.functional));
        mm_global += std::abs(mm.functional - values[0]) < 1e-9;
        most_mm = std::max<unsigned int>(most_mm, mm.history.size());
        for (unsigned int i = 1; i < mm.history.size(); ++i)
          rises +=
            mm.history[i].functional > mm.history[i - 1].functional + 1e-14;

        // A signal that came before ends the method after its first iteration.
        s = start;
        CondensedProblem once_more(p.S, p.g, p.bonds, s);
        const auto       stopped = MajoriseMinimise({}).minimize(
          once_more, [](const MajoriseMinimiseIteration &) { return false; });
        misnamed +=
          (stopped.status == SolverStatus::success) != (mm.history.size() <= 1);
        converged_at_once += mm.history.size() == 1;

        ProximalBundleParameters parameters;
        parameters.epsilon_s          = 1e-14;
        parameters.bundle_size        = 50;
        parameters.maximum_iterations = 500;
        MetricDirection        direction(p.S, p.bonds, parameters.bundle_size);
        dealii::Vector<double> x(start.begin(), start.end());
        const auto             bundle =
          ProximalBundle(parameters)
            .minimize(Energy(p.S, p.g, p.bonds), direction, x);
        bundle_failures += bundle.status != SolverStatus::success;
        raise(worst_bundle, distance(bundle.functional));
        bundle_global += std::abs(bundle.functional - values[0]) < 1e-9;
        raise(most_bundle, bundle.iterations());
      }
    section("majorise-minimise on ", n_problems, " problems");
    check("converged", mm_failures == 0);
    check("an enumerated stationary value to 1e-12", worst_mm, 1e-12);
    check("never rising", rises == 0);
    check("converged ones are no interrupted ones",
          misnamed == 0 && converged_at_once > 0);
    check("energy bundle on the same: converged", bundle_failures == 0);
    check("an enumerated stationary value to 1e-10", worst_bundle, 1e-10);
    check(
      "more than a quarter of these problems have several stationary values",
      several > n_problems / 4);
  }



  /// Neighbouring pairs of unknowns move together on each coarser level.
  void
  test_coarse_start(std::mt19937_64 &engine)
  {
    bool         feasible = true, below_rest = true, converged = true;
    bool         all_named  = true;
    unsigned int n_problems = 50, n_failed = 0;
    for (unsigned int k = 0; k < n_problems; ++k)
      {
        const Problem                            p = random_problem(engine, 16);
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
        coarse_start({p.S, p.g, p.bonds},
                     prolongations,
                     MajoriseMinimise({1e-10, 1}),
                     failures);
        n_failed += failures.size();
        for (const std::string &failure : failures)
          all_named = all_named &&
                      failure.find(" after 1 iterations") != std::string::npos;
        failures.clear();
        Eigen::VectorXd s =
          coarse_start({p.S, p.g, p.bonds}, prolongations, method, failures);
        converged = converged && failures.empty();
        const Energy energy(p.S, p.g, p.bonds);
        for (const double entry : s)
          feasible = feasible && entry <= 0.;
        below_rest = below_rest &&
                     energy.value(s) <= energy.value(Eigen::VectorXd::Zero(16));
        CondensedProblem problem(p.S, p.g, p.bonds, s);
        converged =
          converged && method.minimize(problem).status == SolverStatus::success;
      }
    section("start from coarser spaces on ", n_problems, " problems");
    check("feasible", feasible);
    check("not above rest", below_rest);
    check("converged from there", converged);
    check("failures of levels are told", all_named && n_failed > 0);
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;
  std::mt19937_64 engine(20261121);
  test_bound_qp(engine);
  test_beam_qp();
  test_minimisers(engine);
  test_coarse_start(engine);
}
