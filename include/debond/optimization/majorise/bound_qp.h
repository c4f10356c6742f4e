// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_majorise_bound_qp_h
#define debond_optimization_majorise_bound_qp_h

#include <debond/base/infinity.h>
#include <debond/linear_algebra/bordered_cholesky.h>
#include <debond/optimization/kinks.h>
#include <debond/optimization/status.h>

#include <limits>

namespace Debond
{
  /// Factorisations after which a solver gives up.
  constexpr unsigned int maximum_active_set_steps = 10000;

  /// Which bounds and kinks are active, by index: is_active(). Of a kink that
  /// is not, 0 says that x is below it, and above_kink that x is above.
  using ActiveSet = std::vector<char>;

  constexpr char above_kink = 2;

  inline bool
  is_active(const char entry)
  {
    return entry == 1;
  }



  /// x <= upper, and kinks where that is infinite.
  struct Bounds
  {
    Bounds(const Eigen::VectorXd &upper, const Kinks &kinks = {})
      : kinks(kinks)
      , place(upper)
    {
      for (Eigen::Index i = 0; i < kinks.weight.size(); ++i)
        if (kinks.has(i))
          place(i) = kinks.place(i);
    }

    /// What is left of the kinks where they are linear in pairs about @p x:
    /// those at their kinks stay there, and others are free.
    Bounds
    with_pairs_as_at(const Eigen::VectorXd &x) const
    {
      Kinks           rest  = kinks;
      Eigen::VectorXd upper = place;
      rest.partner.clear();
      for (Eigen::Index i = 0; i < x.size(); ++i)
        if (kinks.is_paired(i))
          {
            upper(i)       = infinity;
            rest.weight(i) = kinks.way(i, x) == 0. ? infinity : 0.;
          }
      return {upper, rest};
    }

    bool
    is_at(const Eigen::Index i, const Eigen::VectorXd &x) const
    {
      return kinks.has(i) ? kinks.way(i, x) == 0. : x(i) == place(i);
    }

    /// The entry of the active set for a component of @p x.
    char
    state(const Eigen::Index i, const Eigen::VectorXd &x) const
    {
      return is_at(i, x) ? 1 : x(i) > place(i) ? above_kink : 0;
    }

    /// The t > 0 at which x + t d comes to the bound or kink of a component, of
    /// a pair next to it; infinity if it does not.
    double
    way_to(const Eigen::Index     i,
           const Eigen::VectorXd &x,
           const Eigen::VectorXd &d) const
    {
      double work = d(i) * (place(i) - x(i)), square = d(i) * d(i);
      if (kinks.is_paired(i))
        {
          const Eigen::Index j = kinks.partner[i];
          work += d(j) * (place(j) - x(j));
          square += d(j) * d(j);
        }
      return work > 0. ? work / square : infinity;
    }

    /// How far @p x_i is outside of the side that @p state says.
    double
    excess(const Eigen::Index i, const double x_i, const char state) const
    {
      return state == above_kink ? place(i) - x_i : x_i - place(i);
    }

    /// The force of the kink on a component that is not at it.
    double
    force(const Eigen::Index i, const char state) const
    {
      return !kinks.has(i) || is_active(state) ? 0. :
             state == above_kink               ? -kinks.weight(i) :
                                                 kinks.weight(i);
    }

    /// By how much a force, without that of the kink, holds a component that is
    /// active.
    double
    hold(const Eigen::Index i, const Eigen::VectorXd &force) const
    {
      return kinks.has(i) ? kinks.weight(i) - kinks.size(i, force) : force(i);
    }

    /// The state of a component that leaves its place.
    char
    left_to(const Eigen::Index i, const double force_i) const
    {
      return kinks.has(i) && force_i > 0. ? above_kink : 0;
    }

    /// The nearest point on the sides that @p active says.
    Eigen::VectorXd
    projected(Eigen::VectorXd x, const ActiveSet &active) const
    {
      for (Eigen::Index i = 0; i < x.size(); ++i)
        if (excess(i, x(i), active[i]) > 0. ||
            (kinks.has(i) && is_active(active[i])))
          x(i) = place(i);
      return x;
    }

    const Kinks     kinks;
    Eigen::VectorXd place; ///< of the bound or kink
  };



  /**
   * The rule by which active-set methods go on: bounds that are exceeded and
   * kinks that are passed enter, those that do not hold leave, kinks to the
   * side that the force points to, all at once as in the primal-dual active set
   * method (Hintermueller, Ito, Kunisch, SIAM J. Optim. 13, 2002). Once the
   * number of wrong indices has not fallen for long, only the first of them
   * changes, which ends after finitely many steps for positive definite
   * matrices (Murty, Math. Programming 7, 1974).
   */
  class ActiveSetRule
  {
  public:
    /// By a point and the @p force on its active components, without that of
    /// kinks; a sign counts only beyond the noise of each. Returns the number
    /// of wrong indices.
    unsigned int
    update(const Bounds          &bounds,
           const Eigen::VectorXd &x,
           const Eigen::VectorXd &force,
           const double           x_noise,
           const double           force_noise,
           ActiveSet             &active);

    /// Returns whether the number of wrong indices has not fallen for long.
    bool
    wanders() const;

  private:
    std::size_t  fewest = std::numeric_limits<std::size_t>::max();
    unsigned int idle   = 0; ///< updates since there were fewer
  };



  struct BoundQPResult
  {
    /// success, stagnated, interrupted, or quadratic_program if there is no
    /// minimum or it was not found.
    SolverStatus status = SolverStatus::quadratic_program;
    unsigned int steps  = 0; ///< solutions on a set

    /// The cost in multiplications with an addition each: the same on every
    /// machine.
    double operations = 0.;

    Eigen::VectorXd x;
    Eigen::VectorXd mu; ///< multipliers, zero where inactive; at kinks forces
  };



  /**
   * min 1/2 x'M x - r'x + kinks(x) subject to x <= b for a dense symmetric
   * positive definite M, started at @p active, which is updated. Each step
   * solves on the free components with a Cholesky factorisation, or by that of
   * a step before. A @p factor can be handed on from problem to problem, whose
   * matrices may differ in few rows.
   *
   * A component with a kink is at it, which is active, or on a given side of
   * it, where its term is a force, with which M stays what it is. There are no
   * bounds at kinks, and no pairs of these, which are for ConeQP.
   *
   * Wrong indices are exchanged by ActiveSetRule. Matrices of slender bodies,
   * where fourth derivatives count, can make that wander; then projected Newton
   * steps take over (Bertsekas, SIAM J. Control Optim. 20, 1982), with which
   * the functional falls until rounding hides it. Then the status is stagnated.
   *
   * With a @p tolerance above zero the exchanges end as soon as the projection
   * onto x <= b meets the optimality conditions to this part of the largest
   * |r_i|: on slender bodies the last exchanges are many and move little.
   */
  BoundQPResult
  solve_bound_qp(const Eigen::Ref<const Eigen::MatrixXd> &M,
                 const Eigen::VectorXd                   &r,
                 const Bounds                            &bounds,
                 ActiveSet                               &active,
                 const double                             tolerance = 0.,
                 BorderedCholesky                        *factor    = nullptr);
} // namespace Debond

#endif
