// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/interruption.h>
#include <debond/base/tolerances.h>
#include <debond/optimization/majorise/bound_qp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <utility>

namespace Debond
{
  namespace
  {
    /// Updates in a row that leave no fewer wrong indices. Those of bodies that
    /// are not slender need hardly more in all.
    constexpr unsigned int maximum_idle_updates = 10;

    /// If that many updates have not found the active set, it may be for
    /// rounding in the solutions: on slender bodies small errors of forces have
    /// long levers.
    constexpr unsigned int updates_before_refinement = 15;

    constexpr unsigned int largest_number_of_refinements = 5;

    /// The time of an operation in extended precision, and of all that is done
    /// with an entry of M beside the factorisation, in operations of that.
    constexpr double extended_operation = 10., operations_per_entry = 30.;

    /// Of a step on the projected path.
    constexpr unsigned int maximum_halvings_of_step = 30;



    class NotPositiveDefinite : public std::exception
    {};



    /// r - M x with sums in extended precision.
    Eigen::VectorXd
    residual(const Eigen::Ref<const Eigen::MatrixXd> &M,
             const Eigen::VectorXd                   &r,
             const Eigen::VectorXd                   &x)
    {
      // Columns of M are its rows, some at once so that their sums can stay in
      // registers, and without what bounds have made zero.
      constexpr Eigen::Index at_once = 4;
      const Eigen::Index     n       = r.size();
      Eigen::VectorXd        result(n);
      for (Eigen::Index first = 0; first < n; first += at_once)
        {
          std::array<const double *, at_once> column;
          std::array<long double, at_once>    sum;
          for (Eigen::Index k = 0; k < at_once; ++k)
            {
              // Beyond the last index it is the last one again, whose sum is
              // not written then.
              const Eigen::Index i = std::min(first + k, n - 1);
              column[k]            = M.col(i).data();
              sum[k]               = r(i);
            }
          for (Eigen::Index j = 0; j < n; ++j)
            if (x(j) != 0.)
              for (Eigen::Index k = 0; k < at_once; ++k)
                sum[k] -= static_cast<long double>(column[k][j]) * x(j);
          for (Eigen::Index k = 0; k < at_once && first + k < n; ++k)
            result(first + k) = static_cast<double>(sum[k]);
        }
      return result;
    }



    /// Solves M_ff x_f = r_f on the given indices, where x is zero before, for
    /// the other entries of x given; refined by residuals in extended precision
    /// if @p refined. Returns the number of operations. Throws
    /// NotPositiveDefinite if M_ff is not: there is no minimum on these
    /// components then, and what the caller believes of M is wrong.
    double
    solve_on(const std::vector<unsigned int>         &free,
             const Eigen::Ref<const Eigen::MatrixXd> &M,
             const Eigen::VectorXd                   &r,
             const bool                               refined,
             BorderedCholesky                        &factor,
             Eigen::VectorXd                         &x)
    {
      if (free.empty())
        return 0.;
      if (!factor.restrict_to(free, M))
        throw NotPositiveDefinite();

      Eigen::VectorXd x_free(free.size());
      const auto      correct = [&](const Eigen::VectorXd &missing) {
        for (unsigned int k = 0; k < free.size(); ++k)
          x_free(k) = missing(free[k]);
        factor.solve_in_place(x_free);
        for (unsigned int k = 0; k < free.size(); ++k)
          x(free[k]) += x_free(k);
      };
      // The first solution, and then what it leaves of the residual: for active
      // components at zero, as most are, r is the residual.
      correct(x.isZero(0.) ? r : Eigen::VectorXd(r - M * x));
      // Rounding in the border takes some digits.
      if (factor.has_border() && !refined)
        correct(r - M * x);
      const double n_free     = static_cast<double>(free.size());
      double       operations = factor.operations();
      for (unsigned int k = 0; refined && k < largest_number_of_refinements;
           ++k)
        {
          correct(residual(M, r, x));
          operations += extended_operation * n_free * double(r.size());
          if (x_free.lpNorm<Eigen::Infinity>() <=
              Tolerance::epsilon * x.lpNorm<Eigen::Infinity>())
            break;
        }
      return operations;
    }



    /// One problem, and its result as it comes about.
    struct BoundQP
    {
      const Eigen::Ref<const Eigen::MatrixXd> &M;
      const Eigen::VectorXd                   &r;
      const Bounds                            &bounds;
      ActiveSet                               &active;
      const double                             tolerance;
      BorderedCholesky                        &factor;
      const unsigned int     n       = static_cast<unsigned int>(r.size());
      const Eigen::VectorXd &b       = bounds.place;
      BoundQPResult          result  = {};
      bool                   refined = false; ///< in extended precision
      Eigen::VectorXd        load    = r;     ///< r and the forces of kinks
      Eigen::VectorXd        force   = {};    ///< load - M x of the last point

      BoundQPResult
      run()
      {
        result.x = b.array().isFinite().select(b, 0.);
        factor.compare(M);
        try
          {
            // The exchange of all wrong indices at once takes few systems if it
            // ends. If it wanders, projected Newton steps from its last point
            // take over, along which the functional falls.
            if (!exchange())
              descend();
          }
        catch (const NotPositiveDefinite &)
          {
            result.status = SolverStatus::quadratic_program;
          }
        // A result that is whole counts, whenever the signal came.
        if (!can_be_verified(result.status) && Interruption::noticed())
          result.status = SolverStatus::interrupted;
        result.x = bounds.projected(result.x, active);
        return result;
      }

      /// The indices that are not active. Sets the load on them.
      std::vector<unsigned int>
      free_indices()
      {
        std::vector<unsigned int> free;
        load = r;
        for (unsigned int i = 0; i < n; ++i)
          if (!is_active(active[i]))
            {
              free.push_back(i);
              load(i) += bounds.force(i, active[i]);
            }
        return free;
      }

      /// The minimum with the given components free, the others at b.
      Eigen::VectorXd
      minimum_on(const std::vector<unsigned int> &free)
      {
        // With the active components at b, the free ones solve M_ff x_f = r_f -
        // M_fa b_a.
        ++result.steps;
        Eigen::VectorXd x = b;
        for (const unsigned int i : free)
          x(i) = 0.;
        result.operations += solve_on(free, M, load, refined, factor, x) +
                             operations_per_entry * double(n) * double(n);
        // The multipliers of active bounds, mu = load - M x >= 0 at the
        // minimum; on free components the same is rounding.
        result.mu = force = force_at(x);
        for (const unsigned int i : free)
          result.mu(i) = 0.;
        return x;
      }

      Eigen::VectorXd
      force_at(const Eigen::VectorXd &x) const
      {
        return refined ? residual(M, load, x) : load - M * x;
      }

      bool
      is_within_limits() const
      {
        return !Interruption::noticed() &&
               result.steps < std::min(maximum_active_set_steps, 100 + 2 * n);
      }

      double
      force_noise(const Eigen::VectorXd &x) const
      {
        // The terms of M x can be far larger than their sum; what rounding
        // leaves of them is no force, and would let bounds change for ever.
        Eigen::VectorXd terms = Eigen::VectorXd::Zero(n);
        for (unsigned int j = 0; j < n; ++j)
          if (x(j) != 0.)
            terms += M.col(j).cwiseAbs() * std::abs(x(j));
        return Tolerance::active_set *
               (r.lpNorm<Eigen::Infinity>() + terms.lpNorm<Eigen::Infinity>());
      }

      static double
      noise(const Eigen::VectorXd &x)
      {
        return Tolerance::active_set * x.lpNorm<Eigen::Infinity>();
      }

      void
      end(const SolverStatus status)
      {
        if (result.x.allFinite())
          result.status = status;
      }

      /// Whether the projection of the last point meets the optimality
      /// conditions to the tolerance.
      bool
      is_near() const
      {
        // Free components need no force, those at their bounds one that
        // presses. Few move by the projection.
        const Eigen::VectorXd near = bounds.projected(result.x, active);
        Eigen::VectorXd       left = force;
        for (unsigned int i = 0; i < n; ++i)
          // The force at the projected point is that of the last one less M
          // times what the projection has moved.
          if (near(i) != result.x(i))
            left += M.col(i) * (result.x(i) - near(i));
        const Eigen::VectorXd without_kinks = left + r - load;
        double                worst         = 0.;
        for (unsigned int i = 0; i < n; ++i)
          worst = std::max(worst,
                           near(i) == b(i) ? -bounds.hold(i, without_kinks) :
                                             std::abs(left(i)));
        return worst <= tolerance * r.lpNorm<Eigen::Infinity>();
      }

      /// All wrong indices at once. Returns false if that does not lead to the
      /// minimum.
      bool
      exchange()
      {
        ActiveSetRule rule;
        while (is_within_limits() && !rule.wanders())
          {
            refined  = result.steps >= updates_before_refinement;
            result.x = minimum_on(free_indices());
            if (rule.update(bounds,
                            result.x,
                            force,
                            noise(result.x),
                            force_noise(result.x),
                            active) == 0 ||
                (tolerance > 0. && !rule.wanders() && is_near()))
              {
                end(SolverStatus::success);
                return true;
              }
          }
        return false;
      }

      /// From the last point, so that the functional falls with each step.
      void
      descend()
      {
        // Bertsekas: a bound is kept active where the force presses on it, and
        // the Newton step for the others is followed along its projection onto
        // x <= b, as far as the functional falls. So it cannot wander. Kinks
        // are left to the side that the force points to.
        Eigen::VectorXd x = bounds.projected(result.x, active);
        refined           = false;
        while (is_within_limits())
          {
            load                           = r;
            const Eigen::VectorXd pull     = force_at(x);
            const double          mu_noise = force_noise(x);
            for (unsigned int i = 0; i < n; ++i)
              {
                active[i] = bounds.state(i, x);
                if (is_active(active[i]) && bounds.hold(i, pull) < -mu_noise)
                  active[i] = bounds.left_to(i, pull(i));
              }
            // If the whole step stays within the bounds and the kept
            // multipliers press, it leads to the minimum.
            result.x = minimum_on(free_indices());
            if (is_minimum())
              {
                end(SolverStatus::success);
                return;
              }
            if (!step(result.x - x, force_at(x), x))
              {
                if (std::exchange(refined, true) == false)
                  continue;
                // Rounding hides the descent: the best that there is in
                // doubles.
                result.x = x;
                end(SolverStatus::stagnated);
                return;
              }
          }
      }

      /// Whether the last point is within the bounds, and held where it is
      /// active.
      bool
      is_minimum() const
      {
        const double x_noise = noise(result.x);
        const double least   = -force_noise(result.x);
        for (unsigned int i = 0; i < n; ++i)
          if (is_active(active[i]) ?
                bounds.hold(i, force) < least :
                bounds.excess(i, result.x(i), active[i]) > x_noise)
            return false;
        return true;
      }

      /// Goes from x along the projection of x + t @p direction, with t = 1 or
      /// a half, a quarter, ... Returns whether the functional falls.
      bool
      step(Eigen::VectorXd        direction,
           const Eigen::VectorXd &force,
           Eigen::VectorXd       &x) const
      {
        for (unsigned int k = 0; k < maximum_halvings_of_step; ++k)
          {
            const Eigen::VectorXd change =
              bounds.projected(x + direction, active) - x;
            // The functional changes by 1/2 c'M c - f'c along a change c. Some
            // part of the first-order descent f'c has to be left, else steps
            // could shrink for ever.
            const double slope = force.dot(change);
            if (slope > 0. && 0.5 * change.dot(M * change) <=
                                (1. - Tolerance::least_descent) * slope)
              {
                x = bounds.projected(x + direction, active);
                return true;
              }
            direction *= 0.5;
          }
        return false;
      }
    };
  } // namespace



  unsigned int
  ActiveSetRule::update(const Bounds          &bounds,
                        const Eigen::VectorXd &x,
                        const Eigen::VectorXd &force,
                        const double           x_noise,
                        const double           force_noise,
                        ActiveSet             &active)
  {
    // Indices are wrong in two ways: active without a hold, and free beyond the
    // bound or kink. Either way the index changes sides.
    std::vector<unsigned int> wrong;
    for (unsigned int i = 0; i < active.size(); ++i)
      if (is_active(active[i]) ? bounds.hold(i, force) < -force_noise :
                                 bounds.excess(i, x(i), active[i]) > x_noise)
        wrong.push_back(i);
    if (wrong.size() < fewest)
      {
        fewest = wrong.size();
        idle   = 0;
      }
    else
      ++idle;
    // All at once is fast but may return to a set that was there before; the
    // first alone never does.
    for (std::size_t k = 0; k < (wanders() ? 1 : wrong.size()); ++k)
      {
        const unsigned int i = wrong[k];
        active[i] = is_active(active[i]) ? bounds.left_to(i, force(i)) : 1;
      }
    return static_cast<unsigned int>(wrong.size());
  }



  bool
  ActiveSetRule::wanders() const
  {
    return idle > maximum_idle_updates;
  }



  BoundQPResult
  solve_bound_qp(const Eigen::Ref<const Eigen::MatrixXd> &M,
                 const Eigen::VectorXd                   &r,
                 const Bounds                            &bounds,
                 ActiveSet                               &active,
                 const double                             tolerance,
                 BorderedCholesky                        *factor)
  {
    BorderedCholesky own;
    return BoundQP{M, r, bounds, active, tolerance, factor ? *factor : own}
      .run();
  }
} // namespace Debond
