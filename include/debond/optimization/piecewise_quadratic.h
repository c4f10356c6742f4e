// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_piecewise_quadratic_h
#define debond_optimization_piecewise_quadratic_h

#include <debond/base/interruption.h>
#include <debond/base/views.h>
#include <debond/optimization/interval.h>
#include <debond/optimization/kinks.h>

#include <Eigen/SparseCore>

namespace Debond
{
  /**
   * A function Phi that is the least of convex quadratics (at each of its
   * quadrature points), but for its kinks(): one at s lies above Phi everywhere
   * and touches it at s.
   * s are the normal displacements of the contact nodes in their order, and
   * after them displacements along the boundary where Phi depends on these:
   * lengths.
   */
  class PiecewiseQuadratic
  {
  public:
    virtual ~PiecewiseQuadratic() = default;

    /// Phi(s) less the value at 0 of all but the kinks, whose weights may be
    /// so large that nothing else would be left of the difference.
    virtual double
    change(const VectorView &s) const = 0;

    /// The gradient at s of the quadratics that touch there, which is an
    /// element of the Clarke subdifferential of Phi.
    virtual Eigen::VectorXd
    subgradient(const VectorView &s) const = 0;

    /// The second derivative of these, positive semidefinite.
    virtual Eigen::SparseMatrix<double>
    curvature(const VectorView &s) const = 0;

    /// Terms of Phi that are no such quadratics and convex: they are part of
    /// change(), and of no other function here.
    virtual const Kinks &
    kinks() const
    {
      static const Kinks none;
      return none;
    }

    /// Returns whether infinitely many quadratics touch Phi, as where bonds
    /// soften: then Phi's own second derivative is less than theirs.
    virtual bool
    softens() const = 0;

    /// The second derivative of Phi, which is the curvature unless it softens.
    virtual Eigen::SparseMatrix<double>
    second_derivative(const VectorView &s) const = 0;

    /// How far on the way from s to s + @p limit ds the points of Phi come
    /// before some leave their piece, as a multiple of ds: at most @p limit.
    virtual double
    first_change(const VectorView &s,
                 const VectorView &ds,
                 const double      limit) const = 0;
  };



  /// 1/2 s'S s - g's + Phi(s) over s <= upper with a Phi of a kind of
  /// PiecewiseQuadratic. Keeps references but for the bounds, which the contact
  /// space says: infinity is none.
  template <typename Phi>
  struct BoundedProblem
  {
    MatrixView      S;
    VectorView      g;
    Eigen::VectorXd upper;
    const Phi      &phi;

    /// Ends what is done with it.
    const Interruption &interruption = Interruption::by_signal();
  };

  using PiecewiseProblem = BoundedProblem<PiecewiseQuadratic>;



  /// s_k -> Phi(P s_k): Phi on a subspace.
  class RestrictedFunction : public PiecewiseQuadratic
  {
  public:
    /// Keeps references.
    RestrictedFunction(const PiecewiseQuadratic          &phi,
                       const Eigen::SparseMatrix<double> &prolongation)
      : phi(phi)
      , P(prolongation)
    {}

    double
    change(const VectorView &s) const override
    {
      return phi.change(P * s);
    }

    Eigen::VectorXd
    subgradient(const VectorView &s) const override
    {
      return P.transpose() * phi.subgradient(P * s);
    }

    Eigen::SparseMatrix<double>
    curvature(const VectorView &s) const override
    {
      return P.transpose() * phi.curvature(P * s) * P;
    }

    bool
    softens() const override
    {
      return phi.softens();
    }

    Eigen::SparseMatrix<double>
    second_derivative(const VectorView &s) const override
    {
      return P.transpose() * phi.second_derivative(P * s) * P;
    }

    double
    first_change(const VectorView &s,
                 const VectorView &ds,
                 const double      limit) const override
    {
      return phi.first_change(P * s, P * ds, limit);
    }

  private:
    const PiecewiseQuadratic          &phi;
    const Eigen::SparseMatrix<double> &P;
  };

} // namespace Debond

#endif
