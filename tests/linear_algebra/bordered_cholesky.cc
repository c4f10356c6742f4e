// SPDX-License-Identifier: LGPL-2.1-or-later
// One set of indices after the other, of matrices that change in some rows,
// beside Eigen's factorisation of each in extended precision.

#include <debond/linear_algebra/bordered_cholesky.h>

#include <Eigen/Dense>

#include <iostream>
#include <random>

#include "../check.h"

using namespace Debond;

namespace
{
  using Extended = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

  std::mt19937 generator(1);

  double
  uniform(const double lower, const double upper)
  {
    return std::uniform_real_distribution<double>(lower, upper)(generator);
  }



  unsigned int
  below(const unsigned int n)
  {
    return std::uniform_int_distribution<unsigned int>(0, n - 1)(generator);
  }



  /// A stiffness as of contact nodes: springs between all of them, weaker with
  /// their distance, and by the ground.
  Eigen::MatrixXd
  stiffness(const unsigned int n)
  {
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
    for (unsigned int j = 0; j < n; ++j)
      {
        M(j, j) += uniform(0.01, 1.);
        for (unsigned int i = j + 1; i < n; ++i)
          {
            const double k = uniform(0.5, 1.) / std::pow(i - j, 2);
            M(i, i) += k;
            M(j, j) += k;
            M(i, j) = M(j, i) = -k;
          }
      }
    return M;
  }



  /// The bonds of some nodes, or of pairs of unknowns, become stiffer or break.
  void
  change(const Eigen::MatrixXd &first, Eigen::MatrixXd &M)
  {
    for (unsigned int k = below(6); k > 0; --k)
      {
        const unsigned int i = below(M.rows()), j = below(M.rows());
        M(i, i) = first(i, i) + uniform(0., 3.);
        if (uniform(0., 1.) < 0.3)
          M(i, j) = M(j, i) = first(i, j) - (i != j) * uniform(0., 0.005);
      }
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures          = argc > 1;
  double       worst     = 0.;
  unsigned int n_borders = 0, n_wrong = 0, n_indefinite = 0;
  for (unsigned int problem = 0; problem < 40; ++problem)
    {
      const unsigned int    n     = 20 + below(100);
      const Eigen::MatrixXd first = stiffness(n);
      Eigen::MatrixXd       M     = first;
      BorderedCholesky      factor;
      std::vector<char>     is_free(n, 1);
      for (unsigned int step = 0; step < 40; ++step)
        {
          if (step % 3 == 0)
            {
              change(first, M);
              // Now and then a node that is pushed away, and no longer.
              const unsigned int i = below(n);
              M(i, i)              = uniform(0., 1.) < 0.2 ? -0.1 : first(i, i);
              factor.compare(M);
            }
          for (unsigned int k = below(8); k > 0; --k)
            is_free[below(n)] ^= 1;
          std::vector<unsigned int> free;
          for (unsigned int i = 0; i < n; ++i)
            if (is_free[i] != 0)
              free.push_back(i);
          if (free.empty())
            continue;
          const Extended             part = M(free, free).cast<long double>();
          const Eigen::LLT<Extended> exact(part);
          const bool is_definite = exact.info() == Eigen::Success;
          n_wrong += factor.restrict_to(free, M) != is_definite;
          n_indefinite += !is_definite;
          if (!is_definite)
            continue;
          n_borders += factor.has_border();
          Eigen::VectorXd b(free.size());
          for (double &value : b)
            value = uniform(-1., 1.);
          const Eigen::VectorXd x =
            exact.solve(b.cast<long double>()).cast<double>();
          factor.solve_in_place(b);
          worst = std::max(worst,
                           (b - x).lpNorm<Eigen::Infinity>() /
                             x.lpNorm<Eigen::Infinity>());
        }
    }
  check("the solution", worst, 1e-11);
  check("what is not positive definite is seen", n_wrong == 0);
  check("there were such ones", n_indefinite > 100);
  check("many have a border", n_borders > 400);
  if (print_figures)
    std::cout << n_borders << " borders, " << n_indefinite << " indefinite"
              << std::endl;
}
