// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_majorise_condensed_problem_h
#define debond_optimization_majorise_condensed_problem_h

#include <debond/optimization/majorise/coarse_start.h>
#include <debond/optimization/majorise/majorant.h>

#include <optional>

namespace Debond
{
  /**
   * A PiecewiseProblem with a dense symmetric S that is positive definite but
   * for given motions. Majorants are minimised by active
   * sets with a Cholesky factorisation each, exactly whatever the tolerance
   * unless minimise_roughly() was called.
   *
   * Where points of Phi move with s, or Phi softens, the minimum of a majorant
   * is only a step towards the limit.
   *
   * A majorant that leaves motions without stiffness, or with so little that it
   * is lost in that of the body, is minimised by proximal steps along these
   * (Rockafellar, SIAM J. Control Optim. 14, 1976), which shrink if there is a
   * minimum. If there is none, they come to repeat one along which the majorant
   * falls without end, and J with it. Only what the unbroken bonds hold says
   * which motions have none: bonds may be far softer or far stiffer than the
   * body.
   */
  class CondensedProblem : public MajorantProblem
  {
  public:
    /// Keeps references to what @p problem refers to and to @p s, the current
    /// point, which has to be within the bounds. The active set of the first
    /// majorant starts where it is at them. The columns
    /// of @p free_motions span the null space of S, of which rounding may have
    /// left anything up to all of S; @p stiffness is what S is made of there,
    /// in its units.
    CondensedProblem(const PiecewiseProblem &problem,
                     Eigen::VectorXd        &s,
                     const Eigen::MatrixXd  &free_motions = {},
                     const double            stiffness    = 0.);

    /// From now on a majorant's active set starts from this guess, if it is not
    /// null, in place of the one before.
    void
    guess_by(const ActiveSetGuess *other)
    {
      guess = other;
    }

    /// From now on majorants are factorised by this one, which knows those of
    /// problems with the same S.
    void
    factorise_by(BorderedCholesky &other)
    {
      factor = &other;
    }

    /// From now on a majorant is minimised only to the tolerance that is asked
    /// for, as long as that is a loose one: many trials of a search end where
    /// others have ended, and are not worth more.
    void
    minimise_roughly()
    {
      is_trial = true;
    }

    State
    evaluate() override;

    bool
    majorise() override;

    Minimisation
    minimise(const double tolerance) override;

  private:
    // fall_of_softening_bonds.cc

    /// Moves s, to which a majorant has led from @p before, to where J stops
    /// falling on a line. Where Phi softens majorants are too stiff to come
    /// far, and where J is not convex they crawl. The line is a Newton step for
    /// the bounds that are not active, or, if J is not convex, the way along
    /// which it is least so, by a power iteration that begins with the step of
    /// the majorant. J falls all the way, so that no barrier is crossed.
    void
    fall(const Eigen::VectorXd &before);

    /// Phi's subgradient() with the forces of the kinks that s is not at.
    Eigen::VectorXd
    slope_of_phi() const;

    /// From s along @p ds to the first minimum of J, or to where s meets a
    /// bound or a kink.
    void
    fall_along(const Eigen::VectorXd &ds);

    // loose_motions.cc

    /// Orthonormal motions of N that the majorant's bonds hold by at most
    /// @p most, the least held one first.
    Eigen::MatrixXd
    motions_held_by_less(const double most) const;

    /// v'E v.
    double
    held(const Eigen::VectorXd &v) const
    {
      return v.dot(majorant.E * v);
    }

    /// Returns whether the majorant has no minimum: no pressures of the
    /// foundation, and no friction, balance what its forces do along the
    /// columns of Z.
    bool
    falls_along(const Eigen::MatrixXd &Z) const;

    /// What pressures along the columns of @p towards and friction along those
    /// of @p motions leave of @p forces; nothing if it was not found.
    std::optional<Eigen::VectorXd>
    unbalanced_by_friction(const Eigen::MatrixXd &towards,
                           const Eigen::MatrixXd &motions,
                           const Eigen::VectorXd &forces) const;

    /**
     * Minimises the majorant by proximal steps along the columns of Z, which
     * are orthonormal: x_{k+1} is the minimum within the bounds of
     *
     *     1/2 x'M x - r'x + delta/2 |Z'(x - x_k)|^2.
     *
     * The steps converge to a minimum if there is one, but slowly: along a
     * motion that the bonds hold with a stiffness c, and as long as the same
     * bounds are active, what is missing to the minimum becomes q = delta /
     * (delta + c) times as large with each, and so do the steps. All that
     * follow are q / (1 - q) = delta / c times the last one, and extrapolate()
     * adds them at once, or as far as to the next bound. Then other bounds are
     * active; as there are finitely many active sets, this ends. Where nothing
     * holds the motion, q is 1: the majorant falls along it as far as to the
     * next bound, or for ever.
     */
    Minimisation
    minimise_along(const Eigen::MatrixXd &Z);

    /// Adds to @p x what follows @p step if it is a part of @p last_step, as in
    /// a geometric series. Returns false if that has no end.
    bool
    extrapolate(const double           delta,
                const Eigen::VectorXd &step,
                const Eigen::VectorXd &last_step,
                Eigen::VectorXd       &x) const;

    Eigen::MatrixXd N; ///< an orthonormal basis of S's null space

    /// S without what rounding leaves along N, if there is N.
    const Eigen::MatrixXd     S_of_loose;
    const MatrixView          S;
    const double              stiffness;
    const VectorView          g;
    const PiecewiseQuadratic &phi;
    const Bounds              bounds; ///< with Phi's kinks
    const Eigen::VectorXd    &upper;  ///< Bounds::place
    Eigen::VectorXd          &s;

    /// The stiffness by which the majorant's bonds hold a rigid motion at most
    /// as rounding does.
    double loose_stiffness = 0.;

    /// The majorant of J, 1/2 s'M s - r's + const, M = S + E and r = g + b with
    /// that of Phi.
    Majorant              majorant;
    Eigen::MatrixXd       M;
    Eigen::VectorXd       r;
    ActiveSet             active;
    BorderedCholesky      own_factor;
    BorderedCholesky     *factor   = &own_factor;
    bool                  is_trial = false;
    const ActiveSetGuess *guess    = nullptr;
  };



  /// The value of the problem at @p s.
  double
  condensed_functional(const PiecewiseProblem &problem, const VectorView &s);
} // namespace Debond

#endif
