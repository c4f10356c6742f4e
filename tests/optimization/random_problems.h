// SPDX-License-Identifier: LGPL-2.1-or-later
// Random problems min 1/2 s'S s - g's + sum_i phi_i(s_i), s <= 0, where phi_i
// is the least of some convex branches, and their minimum by enumeration of all
// choices of a branch for each unknown, by a solver of its own in long double:
// for each choice the minimum of the convex problem is above J's, and one of
// them is it.
#ifndef debond_tests_optimization_random_problems_h
#define debond_tests_optimization_random_problems_h

#include <debond/optimization/global/branch_search.h>
#include <debond/optimization/global/separable_energy.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

using Vector     = Eigen::VectorXd;
using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

class Random
{
public:
  explicit Random(const unsigned int seed = 20261122)
    : engine(seed)
  {}

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
  std::mt19937_64 engine;
};



/// k/2 min(s^2, M^2) for each k of @p stiffness.
inline Debond::SeparableEnergy
bonds_of(const Vector &stiffness, const double threshold)
{
  std::vector<Debond::PiecewiseEnergy> f;
  for (const double k : stiffness)
    f.push_back(Debond::PiecewiseEnergy(
      {{k, 0., -threshold, "bonded"}, {0., 0., Debond::no_end, "broken"}}));
  return Debond::SeparableEnergy(f);
}



inline Debond::NeighbourGraph
chain(const unsigned int n)
{
  Debond::NeighbourGraph graph(n);
  for (unsigned int i = 1; i < n; ++i)
    {
      graph[i - 1].insert(i);
      graph[i].insert(i - 1);
    }
  return graph;
}



/// Of the pieces of f as branches that go on for ever.
inline long double
least_branch(const Debond::PiecewiseEnergy &f, const long double s)
{
  long double least = std::numeric_limits<long double>::infinity();
  for (unsigned int k = 0; k < f.size(); ++k)
    least =
      std::min(least,
               f[k].constant + s * (f[k].slope + 0.5L * f[k].curvature * s));
  return least;
}



/// For s <= upper, which is 0 or infinite, of 1/2 s'A s - g's, by principal
/// pivoting.
inline LongVector
pivoted_minimiser(const LongMatrix  &A,
                  const LongVector  &g,
                  const Vector      &upper,
                  std::vector<char> &active)
{
  const unsigned int n = g.size();
  LongVector         s(n);
  for (unsigned int step = 0; step < 10000; ++step)
    {
      std::vector<int> free;
      for (unsigned int i = 0; i < n; ++i)
        if (active[i] == 0)
          free.push_back(i);
      s.setZero();
      if (!free.empty())
        {
          const LongMatrix A_ff = A(free, free);
          const LongVector g_f  = g(free);
          const LongVector s_f  = A_ff.llt().solve(g_f);
          s(free)               = s_f;
        }
      const LongVector mu = g - A * s;
      unsigned int     i  = 0;
      while (i < n && !(active[i] != 0 ? mu(i) < 0. : s(i) > upper(i)))
        ++i;
      if (i == n)
        return s;
      active[i] = active[i] == 0;
    }
  throw std::runtime_error("pivoting did not end");
}



struct Problem
{
  Eigen::MatrixXd         S;
  Vector                  g;
  Debond::SeparableEnergy phi;
  Vector                  upper = Vector::Zero(g.size());

  /// What the methods take.
  operator Debond::PiecewiseProblem() const
  {
    return {S, g, upper, phi};
  }

  operator Debond::SeparableProblem() const
  {
    return {S, g, upper, phi};
  }

  /// The bond of an unknown, and its weight there.
  unsigned int
  bond(const unsigned int j) const
  {
    return phi.bonds.empty() ? j : phi.bonds[j];
  }

  double
  weight(const unsigned int j) const
  {
    return phi.bonds.empty() ? 1. : phi.weights(j);
  }

  /// As exact as a double can be: bounds come close to it.
  long double
  value(const Vector &s) const
  {
    const LongVector s_long = s.cast<long double>();
    long double      sum = s_long.dot(0.5L * (S.cast<long double>() * s_long) -
                                 g.cast<long double>());
    LongVector       squares = LongVector::Zero(phi.f.size());
    for (unsigned int j = 0; j < s.size(); ++j)
      squares(bond(j)) += weight(j) * s_long(j) * s_long(j);
    for (unsigned int i = 0; i < squares.size(); ++i)
      sum +=
        least_branch(phi.f[i],
                     phi.bonds.empty() ? s_long(i) : -std::sqrt(squares(i)));
    return sum;
  }

  /// The least value, and where it is.
  long double
  enumerated_minimum(LongVector &where) const
  {
    const unsigned int        n = phi.f.size();
    std::vector<unsigned int> choice(n, 0);
    std::vector<char>         active(g.size(), 0);
    long double least = std::numeric_limits<long double>::infinity();
    while (true)
      {
        LongMatrix  A        = S.cast<long double>();
        LongVector  load     = g.cast<long double>();
        long double constant = 0.L;
        for (unsigned int j = 0; j < g.size(); ++j)
          {
            const auto &b = phi.f[bond(j)][choice[bond(j)]];
            A(j, j) += b.curvature * weight(j);
            load(j) -= b.slope;
          }
        for (unsigned int i = 0; i < n; ++i)
          constant += phi.f[i][choice[i]].constant;
        const LongVector  s     = pivoted_minimiser(A, load, upper, active);
        const long double value = s.dot(0.5L * (A * s) - load) + constant;
        if (value < least)
          {
            least = value;
            where = s;
          }
        unsigned int i = 0;
        while (i < n && ++choice[i] == phi.f[i].size())
          choice[i++] = 0;
        if (i == n)
          return least;
      }
  }
};



/// Coupled neighbours as on a contact boundary, or any coupling.
inline Eigen::MatrixXd
random_matrix(Random &random, const unsigned int n, const bool any_coupling)
{
  Eigen::MatrixXd S(n, n);
  if (any_coupling)
    {
      const Eigen::MatrixXd B =
        Eigen::MatrixXd::NullaryExpr(n, n, [&]() { return random(-1., 1.); });
      return B * B.transpose() + 0.02 * Eigen::MatrixXd::Identity(n, n);
    }
  for (unsigned int i = 0; i < n; ++i)
    for (unsigned int j = 0; j <= i; ++j)
      S(i, j) = S(j, i) = -std::exp(-double(i - j)) * random(0.7, 1.3);
  for (unsigned int i = 0; i < n; ++i)
    S(i, i) = 0.05 - (S.row(i).sum() - S(i, i));
  return S;
}



/// With bonds, of which the energy is moderate whatever the unit of lengths is.
inline Problem
random_bonds(Random            &random,
             const unsigned int n,
             const bool         any_coupling,
             const double       unit = 1.)
{
  const auto numbers = [&](const double lower, const double upper) -> Vector {
    return Vector::NullaryExpr(n, [&]() { return random(lower, upper); });
  };
  const Vector exponents = numbers(-1., 1.);
  return {random_matrix(random, n, any_coupling),
          numbers(-2.2, 0.8),
          bonds_of(Eigen::pow(10., exponents.array()).matrix() / (unit * unit),
                   random(0.1, 0.9) * unit)};
}

#endif
