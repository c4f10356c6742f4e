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
    /// Far more than scenes need, which take 5 to 15.
    constexpr unsigned int maximum_cone_steps = 200;

    constexpr unsigned int maximum_halvings_of_way = 30;

    constexpr unsigned int maximum_lengths = 60;

    /// What may be rounding, over the rounding of single products.
    constexpr double near_noise = 1e3;



    /// The v for which 1/2 v'A v - f'v + w |v| is least, w > 0.
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
  } // namespace



  void
  ConeQP::relax_pairs(Eigen::VectorXd &x, Eigen::VectorXd &force) const
  {
    for (const Eigen::Index i : bounds.kinks.pairs())
      {
        const std::vector<Eigen::Index> pair  = bounds.kinks.pair(i);
        const Eigen::Vector2d           place = bounds.kinks.place(pair);
        const Eigen::Matrix2d           A     = M(pair, pair);
        // The force with the pair at its kink.
        const Eigen::Vector2d v = x(pair) - place;
        const Eigen::Vector2d next =
          least_on_pair(A, force(pair) + A * v, bounds.kinks.weight(i));
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



  double
  ConeQP::violation(const Eigen::VectorXd &x,
                    const Eigen::VectorXd &force) const
  {
    const Eigen::VectorXd left  = force - bounds.kinks.gradient(x);
    double                worst = 0.;
    for (Eigen::Index i = 0; i < x.size(); ++i)
      worst = std::max(worst,
                       is_active(bounds.state(i, x)) ? -bounds.hold(i, force) :
                                                       std::abs(left(i)));
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
      for (const Eigen::Index j : bounds.kinks.pair(i))
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
    double          before = infinity;
    Eigen::VectorXd x      = start;
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (!bounds.kinks.has(i))
        x(i) = std::min(x(i), bounds.place(i));
    for (unsigned int k = 0; k < maximum_cone_steps; ++k)
      {
        Eigen::VectorXd force = r - M * x;
        const double    worst = violation(x, force);
        const double    noise =
          Tolerance::row_of_product *
          (r.cwiseAbs() + M.cwiseAbs() * x.cwiseAbs()).maxCoeff();
        const bool is_enough =
          worst <= std::max(noise, tolerance * r.lpNorm<Eigen::Infinity>());
        // What is near rounding and becomes no less is rounding.
        if (is_enough || (worst <= near_noise * noise && worst > 0.5 * before))
          {
            result.status =
              is_enough ? SolverStatus::success : SolverStatus::stagnated;
            break;
          }
        before = worst;

        relax_pairs(x, force);
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
            const auto            pair  = bounds.kinks.pair(i);
            const Eigen::Vector2d place = bounds.kinks.place(pair);
            if ((target(pair) - place).dot(x(pair) - place) <= 0.)
              target(pair) = place;
          }
        if (!step(target, force, x))
          step(newton.x, force, x);
      }
    for (Eigen::Index i = 0; i < x.size(); ++i)
      active[i] = bounds.state(i, x);
    result.x = x;
    return result;
  }
} // namespace Debond
