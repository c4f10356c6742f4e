// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_majorise_restricted_function_h
#define debond_optimization_majorise_restricted_function_h

#include <debond/optimization/piecewise_quadratic.h>

namespace Debond
{
  /// s_k -> Phi(P s_k): Phi on a subspace.
  class RestrictedFunction : public PiecewiseQuadratic
  {
  public:
    /// Keeps references.
    RestrictedFunction(const PiecewiseQuadratic          &phi,
                       const Eigen::SparseMatrix<double> &prolongation);

    double
    value(const VectorView &s) const override
    {
      return phi.value(P * s);
    }

    Eigen::VectorXd
    subgradient(const VectorView &s) const override;

    Eigen::SparseMatrix<double>
    curvature(const VectorView &s) const override;

  private:
    const PiecewiseQuadratic          &phi;
    const Eigen::SparseMatrix<double> &P;
  };
} // namespace Debond

#endif
