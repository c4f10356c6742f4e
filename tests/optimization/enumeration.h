// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_tests_optimization_enumeration_h
#define debond_tests_optimization_enumeration_h

#include <debond/optimization/piecewise_energy.h>

#include <Eigen/Dense>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

// The minimum of 1/2 s'S s - g's + sum_i min_k b_ik(s_i), s <= 0, by
// enumeration of all choices of a branch for each unknown.

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
using BranchList = std::vector<Debond::PiecewiseEnergy::Piece>;



/// The pieces of f as branches that go on for ever.
inline BranchList
branches_of(const Debond::PiecewiseEnergy &f)
{
  BranchList branches;
  for (unsigned int k = 0; k < f.size(); ++k)
    branches.push_back(f[k]);
  return branches;
}



inline long double
least_branch(const BranchList &branches, const long double s)
{
  long double least = std::numeric_limits<long double>::infinity();
  for (const Debond::PiecewiseEnergy::Piece &b : branches)
    least =
      std::min(least, b.constant + s * (b.slope + 0.5L * b.curvature * s));
  return least;
}



/// For s <= 0 of 1/2 s'A s - g's, by principal pivoting.
inline LongVector
pivoted_minimiser(const LongMatrix  &A,
                  const LongVector  &g,
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
      while (i < n && !(active[i] != 0 ? mu(i) < 0. : s(i) > 0.))
        ++i;
      if (i == n)
        return s;
      active[i] = active[i] == 0;
    }
  throw std::runtime_error("pivoting did not end");
}



/// The least value, and where it is.
inline long double
enumerated_minimum(const LongMatrix              &S,
                   const LongVector              &g,
                   const std::vector<BranchList> &branches,
                   LongVector                    &where)
{
  const unsigned int        n = g.size();
  std::vector<unsigned int> choice(n, 0);
  std::vector<char>         active(n, 0);
  long double least = std::numeric_limits<long double>::infinity();
  while (true)
    {
      LongMatrix  A        = S;
      LongVector  load     = g;
      long double constant = 0.L;
      for (unsigned int i = 0; i < n; ++i)
        {
          const Debond::PiecewiseEnergy::Piece &b = branches[i][choice[i]];
          A(i, i) += b.curvature;
          load(i) -= b.slope;
          constant += b.constant;
        }
      const LongVector  s     = pivoted_minimiser(A, load, active);
      const long double value = s.dot(0.5L * (A * s) - load) + constant;
      if (value < least)
        {
          least = value;
          where = s;
        }
      unsigned int i = 0;
      while (i < n && ++choice[i] == branches[i].size())
        choice[i++] = 0;
      if (i == n)
        return least;
    }
}

#endif
