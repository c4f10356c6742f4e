// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef tests_optimization_bundle_qp_problems_h
#define tests_optimization_bundle_qp_problems_h

// Problems for the bundle QP with known solutions.

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace BundleQPProblems
{
  using Eigen::MatrixXd;
  using Eigen::VectorXd;



  struct Shape
  {
    unsigned int n;
    unsigned int n_bounded;     // of n, the first have bounds
    unsigned int active_bounds; // of n_bounded, the first
    unsigned int active_cuts;
    unsigned int cuts;
  };



  struct Problem
  {
    MatrixXd eta; // n x cuts
    VectorXd beta, b;
    double   u;
    VectorXd d, lambda; // the solution
    double   v;

    // The sizes of the terms that d and v are sums of.
    double d_terms, v_terms;

    void
    measure()
    {
      const VectorXd lengths = eta.colwise().norm().transpose();
      d_terms                = std::max(d.norm(), lengths.dot(lambda) / u);
      v_terms                = lambda.dot(lengths * d_terms + beta);
    }
  };



  class Generator
  {
  public:
    explicit Generator(const unsigned int seed)
      : engine(seed)
    {}

    double
    uniform(const double lowest, const double highest)
    {
      return std::uniform_real_distribution<double>(lowest, highest)(engine);
    }

    double
    power_of_ten(const double lowest, const double highest)
    {
      return std::pow(10., uniform(lowest, highest));
    }

    unsigned int
    integer(const unsigned int lowest, const unsigned int highest)
    {
      return std::uniform_int_distribution<unsigned int>(lowest,
                                                         highest)(engine);
    }

    VectorXd
    vector(const unsigned int n, const double lowest, const double highest)
    {
      return VectorXd::NullaryExpr(n,
                                   [&]() { return uniform(lowest, highest); });
    }

    Shape
    shape()
    {
      Shape s;
      s.n             = integer(2, 40);
      s.n_bounded     = integer(0, s.n - 1);
      s.active_bounds = integer(0, s.n_bounded);
      s.active_cuts   = integer(1, s.n - s.active_bounds);
      s.cuts          = s.active_cuts + integer(0, 30);
      return s;
    }

    /// 1 to 300 cuts and 1 to 2000 bounds, small numbers as often as large.
    Shape
    large_shape()
    {
      Shape s;
      s.n_bounded     = std::lround(std::exp(uniform(0., std::log(2000.))));
      s.cuts          = std::lround(std::exp(uniform(0., std::log(300.))));
      s.n             = s.n_bounded + s.cuts;
      s.active_bounds = integer(0, s.n_bounded);
      s.active_cuts   = integer(1, s.cuts);
      return s;
    }

    /// Cuts of length about @p eta_scale, but for a random factor of up to 10
    /// to the power of @p spread, d of length about @p d_scale.
    Problem
    problem(const Shape &s,
            const double u,
            const double eta_scale,
            const double d_scale,
            const double spread = 0.)
    {
      Problem p;
      p.u   = u;
      p.d   = d_scale * vector(s.n, -1., 1.);
      p.eta = MatrixXd::NullaryExpr(s.n, s.cuts, [&]() {
        return eta_scale * uniform(-1., 1.);
      });
      if (spread > 0.)
        for (unsigned int j = 0; j < s.cuts; ++j)
          p.eta.col(j) *= power_of_ten(-spread, spread);

      p.lambda.setZero(s.cuts);
      p.lambda.head(s.active_cuts) = vector(s.active_cuts, 0.1, 1.);
      p.lambda /= p.lambda.sum();
      // u d + sum_j lambda_j eta_j + mu = 0 fixes the last active cut.
      VectorXd rest = -u * p.d;
      rest.head(s.active_bounds) -=
        eta_scale * vector(s.active_bounds, 0.1, 1.);
      const unsigned int last = s.active_cuts - 1;
      rest -= p.eta.leftCols(last) * p.lambda.head(last);
      p.eta.col(last) = rest / p.lambda(last);

      const VectorXd slopes = p.eta.transpose() * p.d;
      p.v                   = slopes.minCoeff();
      p.beta                = slopes.array() - p.v;
      for (unsigned int j = s.active_cuts; j < s.cuts; ++j)
        p.beta(j) += std::max(eta_scale * d_scale, u * d_scale * d_scale) *
                     power_of_ten(-2., 2.);
      p.b = p.d.head(s.n_bounded);
      p.b.tail(s.n_bounded - s.active_bounds) +=
        std::max(d_scale, eta_scale / u) *
        vector(s.n_bounded - s.active_bounds, 0.1, 1.);
      return p;
    }

    /// Appends a cut that is as active as those it is made of.
    void
    append_cut(Problem &p, const VectorXd &eta, const double slack)
    {
      const unsigned int m = p.beta.size();
      p.eta.conservativeResize(Eigen::NoChange, m + 1);
      p.eta.col(m) = eta;
      p.beta.conservativeResize(m + 1);
      p.beta(m) = std::max(0., eta.dot(p.d) - p.v + slack);
      p.lambda.conservativeResize(m + 1);
      p.lambda(m) = 0.;
    }

    /// Every cut again, moved by the relative amount @p difference.
    Problem
    repeat_cuts(Problem p, const double difference)
    {
      const unsigned int m = p.beta.size();
      for (unsigned int j = 0; j < m; ++j)
        {
          const VectorXd eta = p.eta.col(j);
          append_cut(p,
                     eta +
                       difference * eta.norm() * vector(eta.size(), -1., 1.),
                     p.beta(j) - (eta.dot(p.d) - p.v));
        }
      return p;
    }

    /// One more active cut, an affine combination of the other active ones.
    Problem
    dependent_cut(Problem p, const unsigned int active_cuts)
    {
      VectorXd weights = vector(active_cuts, -1., 1.);
      weights.array() += (1. - weights.sum()) / active_cuts;
      append_cut(p, p.eta.leftCols(active_cuts) * weights, 0.);
      return p;
    }

    std::vector<unsigned int>
    permutation(const unsigned int n)
    {
      std::vector<unsigned int> order(n);
      std::iota(order.begin(), order.end(), 0U);
      std::shuffle(order.begin(), order.end(), engine);
      return order;
    }

  private:
    std::mt19937_64 engine;
  };



  /// Small random problems, solved by trying all working sets: the one whose
  /// point violates the other conditions least is the solution.
  inline Problem
  enumerated(Generator &generator)
  {
    using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
    using Vector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
    const unsigned int m = generator.integer(1, 5), c = generator.integer(0, 4),
                       n = c + generator.integer(1, 4);
    Problem p;
    p.u = generator.power_of_ten(-2., 2.);
    p.eta =
      MatrixXd::NullaryExpr(n, m, [&]() { return generator.uniform(-1., 1.); });
    p.beta = generator.vector(m, 0., 0.5);
    p.b    = generator.vector(c, 0., 0.5);
    for (double &b : p.b)
      b *= generator.integer(0, 1) / p.u;

    const Matrix eta   = p.eta.cast<long double>();
    long double  least = std::numeric_limits<long double>::max();
    for (unsigned int set = 0; set < (1U << (m + c)); ++set)
      {
        std::vector<unsigned int> cuts, bounds;
        for (unsigned int k = 0; k < m + c; ++k)
          if (set >> k & 1U)
            (k < m ? cuts : bounds).push_back(k < m ? k : k - m);
        if (cuts.empty())
          continue;

        // Forces of the multipliers; with d = -F x / u the rows are the
        // active constraints, and the last one sum lambda = 1.
        const unsigned int size = cuts.size() + bounds.size();
        Matrix             F    = Matrix::Zero(n, size);
        Vector             sum  = Vector::Zero(size), right(size + 1);
        for (unsigned int k = 0; k < size; ++k)
          {
            const bool         cut   = k < cuts.size();
            const unsigned int index = cut ? cuts[k] : bounds[k - cuts.size()];
            if (cut)
              F.col(k) = eta.col(index);
            else
              F(index, k) = 1.L;
            sum(k)   = cut ? 1.L : 0.L;
            right(k) = cut ? p.beta(index) : p.b(index);
          }
        right(size) = 1.L;
        Matrix K(size + 1, size + 1);
        K << -F.transpose() * F / p.u, -sum, sum.transpose(), 0.L;
        const Eigen::FullPivLU<Matrix> factor(K);
        if (!factor.isInvertible())
          continue;
        const Vector x = factor.solve(right);
        const Vector d = -F * x.head(size) / static_cast<long double>(p.u);
        long double  violation = std::max(
          -x.head(size).minCoeff(),
          (eta.transpose() * d - p.beta.cast<long double>()).maxCoeff() -
            x(size));
        if (c > 0)
          violation =
            std::max(violation,
                     (d.head(c) - p.b.cast<long double>()).maxCoeff());
        if (violation < least)
          {
            least = violation;
            p.d   = d.cast<double>();
            p.v   = x(size);
            p.lambda.setZero(m);
            for (unsigned int k = 0; k < cuts.size(); ++k)
              p.lambda(cuts[k]) = x(k);
          }
      }
    return p;
  }
} // namespace BundleQPProblems

#endif
