// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_majorise_majorant_h
#define debond_optimization_majorise_majorant_h

#include <Eigen/SparseCore>

namespace Debond
{
  /// The quadratic 1/2 s'E s - b's + const that touches Phi at a point s_k:
  ///     Phi(s_k) + xi'(s - s_k) + 1/2 (s - s_k)'E (s - s_k).
  class Majorant
  {
  public:
    Eigen::SparseMatrix<double> E;
    Eigen::VectorXd             b;

    /// Makes it touch at @p s, with the subgradient @p xi of Phi there and the
    /// @p curvature. Returns false if that changes no more than rounding.
    bool
    touch(const Eigen::VectorXd             &s,
          const Eigen::VectorXd             &xi,
          const Eigen::SparseMatrix<double> &curvature);

  private:
    bool touches = false;
  };
} // namespace Debond

#endif
