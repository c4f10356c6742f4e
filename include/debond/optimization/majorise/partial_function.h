// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_majorise_partial_function_h
#define debond_optimization_majorise_partial_function_h

#include <debond/optimization/piecewise_quadratic.h>

#include <vector>

namespace Debond
{
  /// Phi as a function of some components of s, the others being given.
  class PartialFunction : public PiecewiseQuadratic
  {
  public:
    /// Keeps a reference to @p phi. The argument has the @p components of s in
    /// their order.
    PartialFunction(const PiecewiseQuadratic        &phi,
                    const VectorView                &s,
                    const std::vector<unsigned int> &components);

    double
    value(const VectorView &part) const override;

    Eigen::VectorXd
    subgradient(const VectorView &part) const override;

    Eigen::SparseMatrix<double>
    curvature(const VectorView &part) const override;

    bool
    has_moving_points() const override;

  private:
    Eigen::VectorXd
    whole(const VectorView &part) const;

    const PiecewiseQuadratic       &phi;
    const Eigen::VectorXd           s;
    const std::vector<unsigned int> components;
    Eigen::SparseMatrix<double>     selection; ///< a column for each component
  };
} // namespace Debond

#endif
