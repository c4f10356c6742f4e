// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_bundle_bundle_h
#define debond_optimization_bundle_bundle_h

#include <debond/optimization/bundle/direction_problem.h>
#include <debond/optimization/bundle/line_search.h>

namespace Debond
{
  /**
   * The bundle of the paper's Section 4: up to @p capacity subgradients eta_j,
   * which the direction problem holds, with their linearisation errors alpha_j
   * (energy) and the lengths s_j of the way from y_j to x_k (in the norm of the
   * direction problem). Keeps a reference to the direction problem, which has
   * to outlive it and is cleared at the start.
   */
  template <typename VectorType>
  class Bundle
  {
  public:
    using Solution = typename DirectionProblem<VectorType>::Solution;

    Bundle(DirectionProblem<VectorType> &direction_problem,
           const unsigned int            capacity)
      : problem(direction_problem)
      , alpha(capacity)
      , distance(capacity)
    {
      problem.clear();
    }

    unsigned int
    size() const
    {
      return problem.size();
    }

    bool
    full() const
    {
      return size() == alpha.size();
    }

    void
    clear()
    {
      problem.clear();
    }

    /// Adds the subgradient eta with its alpha_j and s_j at x_k. There has to
    /// be room: !full().
    void
    add(const VectorType &eta,
        const double      new_alpha,
        const double      new_distance)
    {
      alpha(size())    = new_alpha;
      distance(size()) = new_distance;
      problem.add(eta);
    }

    /// The direction at @p x = x_k, from beta_j = max(|alpha_j|, gamma s_j^2).
    /// The result is valid until the next call.
    const Solution &
    solve(const VectorType &x, const double gamma)
    {
      const unsigned int m = size();
      return problem.solve(x,
                           alpha.head(m).cwiseAbs().cwiseMax(
                             gamma * distance.head(m).cwiseAbs2()));
    }

    /// Changes alpha_j and s_j of all subgradients from x_k to x_{k+1} = x_k +
    /// t_L d, where d is the direction of @p solution and @p d_length its
    /// length.
    void
    move(const Solution         &solution,
         const LineSearchResult &step,
         const double            d_length)
    {
      const unsigned int m = size();
      alpha.head(m) +=
        (step.change - step.t_L * solution.slopes.array()).matrix();
      distance.head(m).array() += step.t_L * d_length;
    }

  private:
    DirectionProblem<VectorType> &problem;
    Eigen::VectorXd               alpha;    ///< linearisation errors
    Eigen::VectorXd               distance; ///< s_j^k
  };
} // namespace Debond

#endif
