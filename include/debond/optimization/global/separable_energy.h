// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_separable_energy_h
#define debond_optimization_global_separable_energy_h

#include <debond/optimization/piecewise_energy.h>
#include <debond/optimization/piecewise_quadratic.h>

namespace Debond
{
  /// The piece that holds at each unknown.
  using PieceState = std::vector<unsigned int>;



  /// Phi(s) = sum_i f_i(s_i): each unknown has pieces of its own. With @p bonds
  /// it is sum_i f_i(l_i) with the displacements of bonds that each have some
  /// of the unknowns; then its values and derivatives are those of laws that
  /// are is_piecewise_quadratic().
  struct SeparableEnergy : public PiecewiseQuadratic
  {
    std::vector<PiecewiseEnergy> f;

    /// The bond of each unknown, and its part in l = -sqrt(sum weight s^2),
    /// which is positive.
    std::vector<unsigned int> bonds;
    Eigen::VectorXd           weights;

    Kinks friction = {}; ///< kinks()

    explicit SeparableEnergy(const std::vector<PiecewiseEnergy> &f)
      : f(f)
    {}

    /// What f_i is a function of: s itself without bonds.
    Eigen::VectorXd
    displacements(const VectorView &s) const;

    /// Gives bond i a displacement: its unknowns keep their ratios or, if all
    /// are zero, the first of them takes it.
    void
    set_displacement(const unsigned int i,
                     const double       displacement,
                     Eigen::VectorXd   &s) const;

    /// The piece that bond i is on at the displacements @p l.
    const PiecewiseEnergy::Piece &
    piece(const unsigned int i, const VectorView &l) const
    {
      return f[i][f[i].index(l(i))];
    }

    /// With a memory pieces keep the numbers that they have without one.
    PieceState
    state(const VectorView &s) const;

    const Kinks &
    kinks() const override
    {
      return friction;
    }

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

    /// Returns whether all pieces are quadratic in the unknowns; with bonds,
    /// whether these are springs that lose their stiffness at once as well.
    bool
    is_piecewise_quadratic() const;

    /// The largest value of Phi, infinite if there is none.
    double
    largest_value() const;
  };

  using SeparableProblem = BoundedProblem<SeparableEnergy>;
} // namespace Debond

#endif
