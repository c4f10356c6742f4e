// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_bundle_line_search_h
#define debond_optimization_bundle_line_search_h

#include <debond/optimization/bundle/proximal_bundle.h>

namespace Debond
{
  struct LineSearchResult
  {
    /// False if no t_R with eq. (15) was found.
    bool success = false;

    StepKind kind = StepKind::null_step;

    double t_L    = 0.; ///< x_{k+1} = x_k + t_L d_k
    double t_R    = 0.; ///< y_{k+1} = x_k + t_R d_k
    double change = 0.; ///< J(x_{k+1}) - J(x_k)
    double slope  = 0.; ///< eta_{k+1}'d_k
    double alpha  = 0.; ///< linearisation error of y_{k+1} at x_{k+1}
    double beta   = 0.; ///< its locality measure
  };



  /**
   * The two-parameter line search of the paper's Section 4 on the line
   * through x_k with direction d_k.
   *
   * The paper asks for the largest t_L with (14) and the largest t_R > t_L
   * with (15), by bisection, and leaves the rest open. The largest t_L has
   * J(x_k + t_L d_k) close to J(x_k), and the iteration stalls.
   * DescentRule::minimum goes through 1, 1/2, 1/4, ... to the first t with
   * (14), on as long as J falls, and ends with the minimum of the parabola
   * through 0, t and 2t if that is lower still. t_R is found by bisection
   * between t_L and 2 t_L (0 and 1 for a null step). doc/notes/reproduction.md
   * compares the rules.
   *
   * A short step for which no t_R has (15) takes y_{k+1} = x_{k+1}.
   *
   * @p v is v_k < 0, @p d_norm the length of d_k. On success @p eta is the
   * subgradient at y_{k+1}.
   */
  LineSearchResult
  line_search(const Functional::Line         &line,
              const DofVector                &d,
              const double                    d_norm,
              const double                    v,
              const ProximalBundleParameters &parameters,
              DofVector                      &eta);
} // namespace Debond

#endif
