// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_majorise_fixed_point_acceleration_h
#define debond_optimization_majorise_fixed_point_acceleration_h

#include <Eigen/Core>

#include <deque>

namespace Debond
{
  /**
   * Steps x -> G(x) that come to their limit linearly, a few directions slowly:
   * the combination of the last images whose steps G(x) - x nearly cancel, in
   * the Euclidean norm. See Anderson, J. ACM 12 (1965); Walker, Ni, "Anderson
   * acceleration for fixed-point iterations", SIAM J. Numer. Anal. 49 (2011).
   */
  class FixedPointAcceleration
  {
  public:
    /// Where to go on from x, of which @p image is G(x), of the same size as
    /// those before; the image itself while too few are known. A step that is
    /// longer than the one before starts anew.
    Eigen::VectorXd
    next(const Eigen::VectorXd &x, const Eigen::VectorXd &image);

    /// Forgets what was known: G is another function from now on.
    void
    restart();

  private:
    std::deque<Eigen::VectorXd> steps, images;
  };
} // namespace Debond

#endif
