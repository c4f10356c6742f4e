// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_separable_energy_h
#define debond_optimization_global_separable_energy_h

#include <debond/optimization/piecewise_energy.h>
#include <debond/optimization/piecewise_quadratic.h>

#include <vector>

namespace Debond
{
  /// The piece that holds at each unknown.
  using PieceState = std::vector<unsigned int>;



  /// Phi(s) = sum_i f_i(s_i): each unknown has pieces of its own.
  struct SeparableEnergy : public PiecewiseQuadratic
  {
    std::vector<PiecewiseEnergy> f;

    explicit SeparableEnergy(const std::vector<PiecewiseEnergy> &f)
      : f(f)
    {}

    /// The piece that unknown i is on.
    const PiecewiseEnergy::Piece &
    piece(const unsigned int i, const VectorView &s) const
    {
      return f[i][f[i].index(s(i))];
    }

    PieceState
    state(const VectorView &s) const;

    double
    change(const VectorView &s) const override;

    Eigen::VectorXd
    subgradient(const VectorView &s) const override;

    Eigen::SparseMatrix<double>
    curvature(const VectorView &s) const override;

    bool
    softens() const override;

    Eigen::SparseMatrix<double>
    second_derivative(const VectorView &s) const override;

    double
    first_change(const VectorView &s,
                 const VectorView &ds,
                 const double      limit) const override;

    /// Returns whether all pieces are quadratic.
    bool
    is_piecewise_quadratic() const;

    /// The largest value of Phi, infinite if there is none.
    double
    largest_value() const;
  };

  using SeparableProblem = BoundedProblem<SeparableEnergy>;
} // namespace Debond

#endif
