// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/interruption.h>
#include <debond/base/tolerances.h>
#include <debond/optimization/majorise/cone_qp.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace Debond
{
  namespace
  {
    /// Of random problems with up to 60 unknowns none of 2000 has needed half.
    constexpr unsigned int maximum_cone_steps = 200;

    constexpr unsigned int maximum_halvings_of_way = 30;

    constexpr unsigned int maximum_lengths = 60;

    /// In which the violation does not halve.
    constexpr unsigned int most_idle_steps = 3;

    /// What may be rounding, and what is next to the minimum, over the rounding
    /// of single products.
    constexpr double near_noise = 1e3, near_minimum = 1e9;
  } // namespace



  Eigen::Vector2d
  least_on_pair(const Eigen::Matrix2d &A,
                const Eigen::Vector2d &f,
                const double           w)
  {
    const double beyond = f.norm() - w;
    if (!(beyond > 0.))
      return Eigen::Vector2d::Zero();
    // (A + w / rho) v = f with rho = |v|: in the axes of A a single equation,
    // |c / (lambda rho + w)| = 1. Its reciprocal is nearly linear in rho, and
    // linear if A is isotropic.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(A);
    const Eigen::Array2d lambda = eigen.eigenvalues();
    const Eigen::Array2d c      = eigen.eigenvectors().transpose() * f;
    const double         least  = beyond / lambda(1);
    const double         most   = beyond / lambda(0);
    double               rho    = least;
    for (unsigned int k = 0; k < maximum_lengths; ++k)
      {
        // Newton's step for h^(-1/2) = 1.
        const Eigen::Array2d d     = lambda * rho + w;
        const double         h     = (c / d).square().sum();
        const double         slope = (lambda * (c / d).square() / d).sum();
        const double         next =
          std::clamp(rho + h * (std::sqrt(h) - 1.) / slope, least, most);
        if (std::abs(next - rho) <= 4. * Tolerance::epsilon * next)
          break;
        rho = next;
      }
    return eigen.eigenvectors() * (rho * c / (lambda * rho + w)).matrix();
  }



  void
  ConeQP::relax_pairs(const double     short_way,
                      Eigen::VectorXd &x,
                      Eigen::VectorXd &force) const
  {
    for (const Eigen::Index i : bounds.kinks.pairs())
      {
        const std::vector<Eigen::Index> pair  = bounds.kinks.group(i);
        const Eigen::Vector2d           place = bounds.kinks.place(pair);
        const Eigen::Matrix2d           A     = M(pair, pair);
        // The force with the pair at its kink.
        const Eigen::Vector2d v = x(pair) - place;
        Eigen::Vector2d       next =
          least_on_pair(A, force(pair) + A * v, bounds.kinks.weight(i));
        // So close to the kink rounding of x makes the direction.
        if (next.norm() <= short_way * place.norm())
          next.setZero();
        if (next == v)
          continue;
        x(pair) = place + next;
        force -= M(Eigen::all, pair) * (next - v);
      }
  }



  bool
  ConeQP::step(const Eigen::VectorXd &target,
               const Eigen::VectorXd &force,
               Eigen::VectorXd       &x) const
  {
    const Eigen::VectorXd way       = target - x;
    const double          work      = force.dot(way);
    const double          curvature = way.dot(M * way);
    double                t         = 1.;
    for (unsigned int k = 0; k < maximum_halvings_of_way; ++k, t *= 0.5)
      {
        Eigen::VectorXd next = target;
        if (k > 0)
          next = x + t * way;
        double change = t * (0.5 * t * curvature - work);
        for (Eigen::Index i = 0; i < x.size(); ++i)
          if (!bounds.kinks.has(i))
            next(i) = std::min(next(i), bounds.place(i));
          else if (const double sum =
                     bounds.kinks.way(i, x) + bounds.kinks.way(i, next);
                   sum > 0.)
            // The difference of two lengths is that of their squares, a sum
            // over components in which nothing cancels, over their sum.
            change += bounds.kinks.weight(i) * (next(i) - x(i)) *
                      ((x(i) - bounds.place(i)) + (next(i) - bounds.place(i))) /
                      sum;
        if (change < 0.)
          {
            x = next;
            return true;
          }
      }
    return false;
  }



  Eigen::VectorXd
  ConeQP::sizes(const Eigen::VectorXd &x) const
  {
    Eigen::VectorXd result = x.cwiseAbs();
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (bounds.kinks.is_paired(i))
        result(i) = std::max(result(i), std::abs(bounds.place(i)));
    return result;
  }



  double
  ConeQP::violation(const Eigen::VectorXd &x,
                    const Eigen::VectorXd &force) const
  {
    const Eigen::VectorXd left  = force - bounds.kinks.gradient(x);
    double                worst = 0.;
    for (Eigen::Index i = 0; i < x.size(); ++i)
      worst = std::max(worst,
                       is_active(bounds.state(i, x)) ?
                         -bounds.hold(i, force) :
                         std::abs(left(i)) - bounds.kinks.rounding(i, x));
    return worst;
  }



  BoundQPResult
  ConeQP::newton_step(const Eigen::VectorXd &x,
                      ActiveSet             &active,
                      BorderedCholesky      *factor) const
  {
    // What is quadratic in the pairs that slide.
    const Eigen::SparseMatrix<double> H     = bounds.kinks.curvature(x);
    const Eigen::VectorXd             slope = bounds.kinks.gradient(x);
    Eigen::VectorXd                   load  = r + H * x;
    Eigen::MatrixXd                   sum   = M;
    sum += H;
    for (const Eigen::Index i : bounds.kinks.pairs())
      for (const Eigen::Index j : bounds.kinks.group(i))
        {
          load(j) -= slope(j);
          active[j] = bounds.is_at(j, x);
        }
    return solve_bound_qp(
      sum, load, bounds.with_pairs_as_at(x), active, 0., factor);
  }



  BoundQPResult
  ConeQP::solve(const Eigen::VectorXd &start,
                ActiveSet             &active,
                const double           tolerance,
                BorderedCholesky      *factor) const
  {
    const std::vector<Eigen::Index> pairs = bounds.kinks.pairs();
    if (pairs.empty())
      return solve_bound_qp(M, r, bounds, active, tolerance, factor);

    BoundQPResult   result;
    Eigen::VectorXd x = start;
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (!bounds.kinks.has(i))
        x(i) = std::min(x(i), bounds.place(i));
    Eigen::VectorXd best  = x;
    double          least = infinity, short_way = Tolerance::at_cone;
    unsigned int    idle = 0;
    for (unsigned int k = 0; k < maximum_cone_steps; ++k)
      {
        Eigen::VectorXd force = r - M * x;
        const double    worst = violation(x, force);
        const double    noise =
          Tolerance::row_of_product *
          (r.cwiseAbs() + M.cwiseAbs() * sizes(x)).maxCoeff();
        // Far from the minimum the violation may rise before it falls.
        idle =
          worst <= 0.5 * least || least > near_minimum * noise ? 0 : idle + 1;
        if (worst < least)
          {
            least = worst;
            best  = x;
          }
        if (least <= std::max(noise, tolerance * r.lpNorm<Eigen::Infinity>()))
          {
            result.status = SolverStatus::success;
            break;
          }
        // What is near rounding and becomes no less is rounding. Farther from
        // it pairs that bear what they can and hardly slide go to and fro, as
        // when a load is again what it has been: the shortest ways are none.
        result.status = SolverStatus::stagnated;
        if (idle >= most_idle_steps)
          {
            if (least <= near_noise * noise ||
                short_way == Tolerance::longest_no_way)
              break;
            short_way = std::min(100. * short_way, Tolerance::longest_no_way);
            idle      = 0;
          }

        relax_pairs(short_way, x, force);
        const BoundQPResult newton = newton_step(x, active, factor);
        result.steps += newton.steps;
        result.operations += newton.operations;
        if (!can_be_verified(newton.status))
          {
            result.status = newton.status;
            break;
          }
        // A pair that would turn back ends at its kink, where the expansion is
        // wrong beyond. If that leads up, no step is cut.
        Eigen::VectorXd target = newton.x;
        for (const Eigen::Index i : pairs)
          {
            const auto            pair  = bounds.kinks.group(i);
            const Eigen::Vector2d place = bounds.kinks.place(pair);
            if ((target(pair) - place).dot(x(pair) - place) <= 0.)
              target(pair) = place;
          }
        if (!step(target, force, x))
          step(newton.x, force, x);
      }
    for (Eigen::Index i = 0; i < x.size(); ++i)
      active[i] = bounds.state(i, best);
    result.x = best;
    return result;
  }
} // namespace Debond
