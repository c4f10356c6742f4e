// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_envelope_relaxation_h
#define debond_optimization_global_envelope_relaxation_h

#include <debond/optimization/global/convex_envelope.h>

#include <Eigen/Core>

namespace Debond
{
  /// q(s) = 1/2 s'A s - g's + sum_i f_i(s_i) on the box lower <= s <= upper
  /// <= 0, A symmetric and positive definite.
  struct BoxProblem
  {
    Eigen::MatrixXd            A;
    Eigen::VectorXd            g;
    std::vector<ShiftedEnergy> f;
    Eigen::VectorXd            lower, upper;
  };

  /**
   * Moves s towards the minimum of q with the convex envelopes of f_i in place
   * of f_i, by a Newton method for s = prox(s - D^{-1}(A s - g)), D = diag A.
   * Whatever s is in the end, LowerBound holds there.
   */
  void
  minimise_relaxation(const BoxProblem                  &problem,
                      const std::vector<ConvexEnvelope> &envelopes,
                      Eigen::VectorXd                   &s);



  /**
   * A lower bound of q on the box from any point x:
   *
   *     q(s) = 1/2 (s - x)'A (s - x) - 1/2 x'A x + sum_i r_i s_i + f_i(s_i)
   *
   * with r = A x - g, and each term of the sum has a least value. At the
   * minimum of the relaxation the bound is the minimum. `value` accounts for
   * the rounding in its own evaluation, for which A, g and f_i are exact.
   */
  class LowerBound
  {
  public:
    double value;

    LowerBound(const BoxProblem &problem, const Eigen::VectorXd &x);

    /// How the bound grows with s_i on a piece of f_i, by its own term and the
    /// quadratic one, of which
    ///     1/2 (s - x)'A (s - x) >= 1/2 (s_i - x_i)^2 / (A^{-1})_ii
    /// is left if all others are free.
    Growth
    growth(const unsigned int i,
           const unsigned int piece,
           const double       inverse_diagonal) const;

  private:
    const BoxProblem      &problem;
    const Eigen::VectorXd &x;

    /// In the digits in which they were summed.
    std::vector<long double> r, least;

    double
    largest(const unsigned int i) const
    {
      return std::max(std::abs(problem.lower(i)), std::abs(problem.upper(i)));
    }
  };
} // namespace Debond

#endif
