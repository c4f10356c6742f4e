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
                    const dealii::Vector<double>    &s,
                    const std::vector<unsigned int> &components);

    double
    value(const dealii::Vector<double> &part) const override;

    void
    subgradient(const dealii::Vector<double> &part,
                dealii::Vector<double>       &xi) const override;

    Eigen::SparseMatrix<double>
    curvature(const dealii::Vector<double> &part) const override;

  private:
    dealii::Vector<double>
    whole(const dealii::Vector<double> &part) const;

    const PiecewiseQuadratic       &phi;
    const dealii::Vector<double>    s;
    const std::vector<unsigned int> components;
    Eigen::SparseMatrix<double>     selection; ///< a column for each component
  };
} // namespace Debond

#endif
