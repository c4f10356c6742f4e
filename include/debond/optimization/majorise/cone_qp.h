// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_majorise_cone_qp_h
#define debond_optimization_majorise_cone_qp_h

#include <debond/optimization/majorise/bound_qp.h>

namespace Debond
{
  /// The v for which 1/2 v'A v - f'v + w |v| is least, w > 0.
  Eigen::Vector2d
  least_on_pair(const Eigen::Matrix2d &A,
                const Eigen::Vector2d &f,
                const double           w);



  /**
   * min 1/2 x'M x - r'x + kinks(x) subject to x <= b as solve_bound_qp(), where
   * kinks may have pairs: friction of a node that can slide in a plane, w |v|.
   *
   * Of a pair that slides Newton's method takes the second-order expansion,
   * whose curvature w / |v| across v is added to M, and one at its kink stays
   * there: what is left has bounds and single kinks. Steps end at the kink
   * where a pair would turn back beyond it, and no further than where the
   * functional falls. Between these steps each pair goes to where the
   * functional is least with all else held, by which pairs leave their kinks:
   * both together are a truncated nonsmooth Newton method (Graeser, Sander, IMA
   * J. Numer. Anal. 39, 2019). M is factorised anew in each step, where without
   * pairs a factor serves many.
   */
  class ConeQP
  {
  public:
    using Matrix = Eigen::Ref<const Eigen::MatrixXd>;

    /// Keeps references.
    ConeQP(const Matrix &M, const Eigen::VectorXd &r, const Bounds &bounds)
      : M(M)
      , r(r)
      , bounds(bounds)
    {}

    /// From @p start, which only counts if there are pairs; the others as of
    /// solve_bound_qp().
    BoundQPResult
    solve(const Eigen::VectorXd &start,
          ActiveSet             &active,
          const double           tolerance = 0.,
          BorderedCholesky      *factor    = nullptr) const;

  private:
    /// Each pair to where the functional is least, one after the other, or to
    /// its kink if the way is no longer than this part of the place. @p force:
    /// r - M x, which follows x.
    void
    relax_pairs(const double     short_way,
                Eigen::VectorXd &x,
                Eigen::VectorXd &force) const;

    /// The minimum of the second-order expansion about @p x.
    BoundQPResult
    newton_step(const Eigen::VectorXd &x,
                ActiveSet             &active,
                BorderedCholesky      *factor) const;

    /// Goes from @p x to @p target, or to the middle, a quarter of the way, ...
    /// if the functional falls so far. Returns whether it does.
    bool
    step(const Eigen::VectorXd &target,
         const Eigen::VectorXd &force,
         Eigen::VectorXd       &x) const;

    /// What x is rounded with: of pairs the way from their kinks counts, too.
    Eigen::VectorXd
    sizes(const Eigen::VectorXd &x) const;

    /// The largest violation of the optimality conditions.
    double
    violation(const Eigen::VectorXd &x, const Eigen::VectorXd &force) const;

    const Matrix           M;
    const Eigen::VectorXd &r;
    const Bounds          &bounds;
  };
} // namespace Debond

#endif
