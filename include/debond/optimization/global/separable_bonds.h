// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_separable_bonds_h
#define debond_optimization_global_separable_bonds_h

#include <debond/optimization/piecewise_quadratic.h>

#include <Eigen/Core>

namespace Debond
{
  /// Phi(s) = sum_i k_i/2 min(s_i^2, M^2): a bond for each unknown, which
  /// breaks at s_i = -M.
  struct SeparableBonds : public PiecewiseQuadratic
  {
    Eigen::VectorXd stiffness; ///< k_i >= 0
    double          threshold; ///< M > 0

    SeparableBonds(const Eigen::VectorXd &stiffness, const double threshold);

    double
    value(const dealii::Vector<double> &s) const override;

    void
    subgradient(const dealii::Vector<double> &s,
                dealii::Vector<double>       &xi) const override;

    Eigen::SparseMatrix<double>
    curvature(const dealii::Vector<double> &s) const override;
  };
} // namespace Debond

#endif
