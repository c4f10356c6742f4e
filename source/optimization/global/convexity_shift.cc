// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/linear_algebra/cholesky.h>
#include <debond/optimization/global/convexity_shift.h>
#include <debond/optimization/interval.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace Debond
{
  namespace
  {
    constexpr unsigned int power_iterations = 12;

    /// The part of a coordinate's step that is done.
    constexpr double step_share = 0.7;

    /// What is refused is tried again with this part of it.
    constexpr double retreat = 0.7;



    /// The factor of A less a shift that covers its rounding. The bound of Rump
    /// does not change if rows and columns are scaled, so that a shift in
    /// proportion to each entry of the diagonal will do.
    DenseCholesky
    factorise_safely(Eigen::MatrixXd A)
    {
      // If the factorisation of A less this shift ends without a pivot that is
      // not positive, A itself is positive definite in spite of rounding.
      const double n     = double(A.rows());
      const double shift = (n + 3.) * 2. * Tolerance::epsilon * n;
      A.diagonal() -= shift * A.diagonal().cwiseAbs();
      return DenseCholesky(std::move(A));
    }
  } // namespace



  bool
  is_safely_positive_definite(const Eigen::MatrixXd &A)
  {
    return factorise_safely(A).is_positive_definite();
  }



  std::optional<Eigen::MatrixXd>
  safe_inverse(const Eigen::MatrixXd &A)
  {
    const DenseCholesky factor = factorise_safely(A);
    if (!factor.is_positive_definite())
      return {};
    return factor.inverse();
  }



  double
  largest_multiple(const Eigen::MatrixXd &inverse_of_A,
                   const Eigen::VectorXd &weights)
  {
    // Power iterations for W^{1/2} A^{-1} W^{1/2}.
    const Eigen::VectorXd root   = weights.cwiseSqrt();
    Eigen::VectorXd       v      = root;
    double                lambda = 0.;
    // Few iterations will do: they approach the largest eigenvalue from below,
    // so that the multiple is rather too large than too small, and what is
    // taken of it has to be checked by a factorisation anyway.
    for (unsigned int k = 0; k < power_iterations && v.norm() > 0.; ++k)
      {
        v.normalize();
        v      = root.cwiseProduct(inverse_of_A * root.cwiseProduct(v));
        lambda = v.norm();
      }
    return lambda > 0. ? 1. / lambda : infinity;
  }



  std::optional<Eigen::MatrixXd>
  take_shift(const double trace, Eigen::MatrixXd &A, Eigen::VectorXd &shift)
  {
    // A less the shift has to stay positive definite beyond doubt.
    // Factorisations decide; what is refused is tried with less.
    while (true)
      {
        Eigen::MatrixXd rest = A;
        rest.diagonal() -= shift;
        auto inverse = safe_inverse(rest);
        if (inverse)
          A.swap(rest);
        if (inverse || shift.isZero(0.))
          return inverse;
        shift *= retreat;
        if (shift.maxCoeff() < Tolerance::epsilon * trace)
          shift.setZero();
      }
  }



  void
  raise_bound(const Eigen::MatrixXd           &inverse,
              const Eigen::VectorXd           &v,
              const double                     mu,
              const std::vector<unsigned int> &which,
              Eigen::VectorXd                 &D)
  {
    // One coordinate after the other goes towards where the derivative of v'D +
    // mu log det (A - D) with respect to it is zero. Only the block of (A -
    // D)^{-1} for these coordinates is needed, and is updated with each step in
    // O(n^2).
    const unsigned int n = static_cast<unsigned int>(which.size());
    Eigen::MatrixXd    P(n, n);
    for (unsigned int l = 0; l < n; ++l)
      for (unsigned int k = 0; k < n; ++k)
        P(k, l) = inverse(which[k], which[l]);

    for (unsigned int k = 0; k < n; ++k)
      {
        const unsigned int i = which[k];
        // The derivative v_i - mu (A - D)^{-1}_ii is zero there, as (A -
        // D)^{-1}_ii changes with D_i alone like P_kk / (1 - step P_kk).
        const double best = v(i) > 0. ? 1. / P(k, k) - mu / v(i) : -D(i);
        // D_i stays at least zero. As `best` is at most 1 / P_kk, a step of
        // this share leaves 1 - step P_kk >= 0.3, so that A - D stays away from
        // singular matrices and the update below loses no digits. Where s_i is
        // on no line of its envelope, D_i does not raise the bound, and what it
        // takes from A is given back to the others.
        const double step = step_share * std::max(best, -D(i));
        if (std::abs(step) * P(k, k) < Tolerance::shift_step)
          continue;
        D(i) += step;
        // The inverse after the step, by the formula of Sherman and Morrison.
        const Eigen::VectorXd column = P.col(k);
        P.noalias() +=
          (step / (1. - step * P(k, k))) * column * column.transpose();
      }
  }
} // namespace Debond
