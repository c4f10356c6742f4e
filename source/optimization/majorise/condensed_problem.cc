// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/linear_algebra/cholesky.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/optimization/polar_cone.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace Debond
{
  namespace
  {
    /// Far more than scenes need.
    constexpr unsigned int maximum_proximal_steps = 500;

    /// On the way of a fall, for each unknown.
    constexpr unsigned int most_pieces_passed = 10;

    constexpr unsigned int most_bisections = 50;

    /// Towards the motion along which J is least convex.
    constexpr unsigned int steps_to_least_convex = 20;

    Eigen::MatrixXd
    orthonormal(const Eigen::MatrixXd &motions)
    {
      if (motions.cols() == 0)
        return {};
      // Translations and rotations differ by a length.
      const Eigen::MatrixXd columns = motions.colwise().normalized();
      return Eigen::HouseholderQR<Eigen::MatrixXd>(columns).householderQ() *
             Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
    }



    /// (I - N N')S(I - N N'), nothing without N.
    Eigen::MatrixXd
    without_motions(const MatrixView &S, const Eigen::MatrixXd &N)
    {
      if (N.cols() == 0)
        return {};
      Eigen::MatrixXd rest = S;
      rest -= N * (N.transpose() * rest).eval();
      rest -= (rest * N).eval() * N.transpose();
      return 0.5 * (rest + rest.transpose());
    }
  } // namespace



  CondensedProblem::CondensedProblem(const MatrixView         &matrix,
                                     const VectorView         &load,
                                     const PiecewiseQuadratic &nonsmooth,
                                     Eigen::VectorXd          &start,
                                     const Eigen::MatrixXd    &free_motions,
                                     const double              stiffness)
    : N(orthonormal(free_motions))
    , S_of_loose(without_motions(matrix, N))
    , S(N.cols() > 0 ? MatrixView(S_of_loose) : matrix)
    , stiffness(stiffness)
    , g(load)
    , phi(nonsmooth)
    , s(start)
    , active(start.size())
  {
    if (N.cols() > 0)
      loose_stiffness =
        Tolerance::loose_motion *
        (N.transpose() * (phi.curvature(Eigen::VectorXd::Zero(s.size())) * N))
          .norm();
    for (unsigned int i = 0; i < s.size(); ++i)
      active[i] = s(i) == 0.;
  }



  MajorantProblem::State
  CondensedProblem::evaluate()
  {
    const Eigen::VectorXd xi = phi.subgradient(s);

    State state;
    state.n_active      = 0;
    double       energy = 0., work = 0.;
    double       largest_force = 0., violation = 0.;
    double       largest_terms = 0., energy_terms = 0.;
    const double adhesion = phi.change(s);

    // The terms of a row of S s nearly cancel. Summed up column by column, for
    // which processors have instructions that sums row by row must not use.
    Eigen::VectorXd S_s   = Eigen::VectorXd::Zero(s.size());
    Eigen::VectorXd terms = Eigen::VectorXd::Zero(s.size());
    for (unsigned int j = 0; j < s.size(); ++j)
      if (s(j) != 0.)
        {
          S_s += s(j) * S.col(j);
          terms += std::abs(s(j)) * S.col(j).cwiseAbs();
        }
    for (unsigned int i = 0; i < s.size(); ++i)
      {
        largest_terms = std::max(largest_terms, terms(i));
        energy_terms += std::abs(s(i)) * terms(i);

        energy += 0.5 * s(i) * S_s(i);
        work += g(i) * s(i);
        // S s + xi - g + mu = 0,  mu >= 0,  s <= 0,  mu's = 0.
        const double mu = g(i) - S_s(i) - xi(i);
        violation       = std::max(violation, s(i) < 0. ? std::abs(mu) : -mu);
        largest_force   = std::max(
          {largest_force, std::abs(g(i)), std::abs(S_s(i)), std::abs(xi(i))});
        state.n_active += s(i) == 0.;
        // A maximum would lose it.
        if (std::isnan(mu))
          violation = largest_force = mu;
      }
    state.functional         = energy - work + adhesion;
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    state.functional_rounding =
      epsilon * (16. * (energy + std::abs(work) + adhesion) + energy_terms);
    state.residual = largest_force == 0. ? 0. : violation / largest_force;
    state.residual_rounding =
      largest_force == 0. ?
        0. :
        Tolerance::row_of_product * largest_terms / largest_force;
    return state;
  }



  bool
  CondensedProblem::majorise()
  {
    // Phi <= Phi(s_k) + xi'(s - s_k) + 1/2 (s - s_k)'E (s - s_k).
    const Eigen::SparseMatrix<double> previous_E = E;
    const Eigen::VectorXd             previous_r = r;
    E                                            = phi.curvature(s);
    const Eigen::VectorXd E_s                    = E * s;
    r                                            = g - phi.subgradient(s) + E_s;
    if (previous_r.size() == r.size() && majorised)
      {
        // Squares of what rounding leaves of a vanishing load would underflow.
        const auto size = [](const Eigen::VectorXd &v) {
          return v.lpNorm<Eigen::Infinity>();
        };
        if (size(r - previous_r) <=
              Tolerance::same_majorant * (size(E_s) + size(r)) &&
            curvature_norm(E - previous_E) <=
              Tolerance::same_majorant * curvature_norm(E))
          return false;
      }
    majorised = true;
    M         = S;
    M += E;
    return true;
  }



  MajorantProblem::Minimisation
  CondensedProblem::minimise(const double tolerance)
  {
    if (N.cols() > 0)
      {
        const Eigen::MatrixXd Z = motions_held_by_less(
          std::max(Tolerance::least_stiffness * stiffness, loose_stiffness));
        if (Z.cols() > 0)
          return minimise_along(Z);
      }
    if (guess != nullptr && !guess->empty())
      active = guess->active_set(M, E, r);
    const Eigen::VectorXd before = s;
    const BoundQPResult   qp =
      solve_bound_qp(M,
                     r,
                     Eigen::VectorXd::Zero(s.size()),
                     active,
                     is_trial && tolerance >= Tolerance::rough_majorant ?
                       tolerance :
                       0.);
    if (qp.status != SolverStatus::interrupted)
      s = qp.x;
    if (can_be_verified(qp.status) && phi.softens())
      fall(before);
    return {qp.status, qp.steps, 0, qp.operations};
  }



  void
  CondensedProblem::fall(const Eigen::VectorXd &before)
  {
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < s.size(); ++i)
      if (s(i) < 0.)
        free.push_back(i);
    if (free.empty())
      return;
    Eigen::MatrixXd A = S;
    A += phi.second_derivative(s);
    const Eigen::VectorXd force = g - S * s - phi.subgradient(s);
    const DenseCholesky   factor(A(free, free));
    Eigen::VectorXd       way;
    if (factor.is_positive_definite())
      {
        way = force(free);
        factor.solve_in_place(way);
      }
    else
      {
        // M^{-1}(M - A), M of the majorant, is what takes one step of majorants
        // to the next one.
        const DenseCholesky majorant(M(free, free));
        if (!majorant.is_positive_definite())
          return;
        const Eigen::MatrixXd rest = M(free, free) - A(free, free);
        way                        = (s - before)(free);
        for (unsigned int k = 0; k < steps_to_least_convex && !way.isZero(0.);
             ++k)
          {
            way = rest * (way / way.lpNorm<Eigen::Infinity>());
            majorant.solve_in_place(way);
          }
        if (way.dot(force(free)) < 0.)
          way *= -1.;
      }
    Eigen::VectorXd ds = Eigen::VectorXd::Zero(s.size());
    ds(free)           = way;
    fall_along(ds);
  }



  void
  CondensedProblem::fall_along(const Eigen::VectorXd &ds)
  {
    const double size = ds.lpNorm<Eigen::Infinity>();
    if (!(size > 0.))
      return;
    double limit = std::numeric_limits<double>::max();
    for (Eigen::Index i = 0; i < s.size(); ++i)
      if (ds(i) > 0.)
        limit = std::min(limit, -s(i) / ds(i));
    const Eigen::VectorXd start     = s;
    const double          work      = ds.dot(g - S * s);
    const double          stiffness = ds.dot(S * ds);
    const auto            slope_at  = [&](const double t) {
      s = (start + t * ds).cwiseMin(0.);
      return t * stiffness - work + phi.subgradient(s).dot(ds);
    };
    double t = 0., slope = slope_at(0.);
    double beyond_kink =
      Tolerance::past_kink * s.lpNorm<Eigen::Infinity>() / size;
    const double least_slope = Tolerance::end_of_fall * std::abs(slope);
    for (Eigen::Index k = 0;
         k < most_pieces_passed * s.size() && slope < -least_slope && t < limit;
         ++k)
      {
        const double curvature =
          stiffness + ds.dot(phi.second_derivative(s) * ds);
        const double step =
          std::min(limit - t,
                   curvature > 0. ? -slope / curvature : std::max(1., t));
        const double part = phi.first_change(s, ds, step);
        // What nothing holds would fall for ever: the next majorant says so.
        if (N.cols() > 0 && curvature <= loose_stiffness * ds.squaredNorm() &&
            part >= step && step < limit - t)
          return;
        // Beyond a kink, as on it the piece before it holds: by rounding, and
        // further for those that hardly move.
        beyond_kink = part > 0. ? Tolerance::past_kink *
                                    s.lpNorm<Eigen::Infinity>() / size :
                                  8. * beyond_kink;
        double low  = t;
        t     = std::min(limit, t + part + (part < step ? beyond_kink : 0.));
        slope = slope_at(t);
        // What is no parabola may have its minimum before.
        for (unsigned int j = 0; j < most_bisections && slope > least_slope;
             ++j)
          {
            const double middle       = 0.5 * (low + t);
            const double middle_slope = slope_at(middle);
            if (middle_slope > 0. || j + 1 == most_bisections)
              {
                t     = middle;
                slope = middle_slope;
              }
            else
              low = middle;
          }
      }
  }



  Eigen::MatrixXd
  CondensedProblem::motions_held_by_less(const double most) const
  {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(N.transpose() *
                                                               (E * N));
    return N * eigen.eigenvectors().leftCols(
                 (eigen.eigenvalues().array() <= most).count());
  }



  bool
  CondensedProblem::falls_along(const Eigen::MatrixXd &Z) const
  {
    Eigen::MatrixXd towards  = Z.transpose();
    const double    furthest = towards.colwise().norm().maxCoeff();
    for (auto node : towards.colwise())
      if (node.norm() <= Tolerance::towards_foundation * furthest)
        node.setZero();
    const std::optional<Eigen::VectorXd> unbalanced =
      project_on_polar_cone(towards, Z.transpose() * r);
    return unbalanced && unbalanced->norm() > Tolerance::balanced * r.norm();
  }



  MajorantProblem::Minimisation
  CondensedProblem::minimise_along(const Eigen::MatrixXd &Z)
  {
    const Eigen::MatrixXd loose_motions = motions_held_by_less(loose_stiffness);
    if (loose_motions.cols() > 0 && falls_along(loose_motions))
      return {SolverStatus::comes_off, 0, 0};
    // Where bonds hold all of them, by little, more than what the least of them
    // has only makes the steps shorter.
    double delta = Tolerance::proximal_stiffness * stiffness;
    if (loose_motions.cols() == 0)
      delta = std::min(delta, held(Z.col(0)));
    const Eigen::MatrixXd proximal = M + delta * Z * Z.transpose();
    const double          forces   = r.norm();

    Eigen::VectorXd x         = s, last_step;
    unsigned int    n_systems = 0;
    for (unsigned int k = 0; k < maximum_proximal_steps; ++k)
      {
        const BoundQPResult qp =
          solve_bound_qp(proximal,
                         r + delta * Z * (Z.transpose() * x),
                         Eigen::VectorXd::Zero(x.size()),
                         active);
        n_systems += qp.steps;
        if (!can_be_verified(qp.status))
          return {qp.status, n_systems, 0};
        const Eigen::VectorXd step   = qp.x - x;
        const Eigen::VectorXd motion = Z.transpose() * step;
        x                            = qp.x;
        // The proximal force balances what the foundation does not, and where
        // bonds are soft what rounding leaves of S x.
        const bool is_balanced =
          delta * motion.norm() <=
          std::max(Tolerance::balanced * forces,
                   Tolerance::row_of_product * stiffness * x.norm());
        if (is_balanced)
          {
            s = x;
            return {qp.status, n_systems, 0};
          }
        // Where something soft holds, each is a part of the one before; else it
        // would go on like this for ever. Both, until it meets the foundation.
        // Bonds that are about to break beside a node that stays in contact
        // turn the softest motions a little out of the one about that node.
        const Eigen::VectorXd rigid   = N * (N.transpose() * step);
        const double          ratio   = last_step.size() > 0 ?
                                          step.dot(last_step) / last_step.squaredNorm() :
                                          0.;
        const bool            is_same = ratio >= 1. - Tolerance::same_step;
        const bool            is_rigid =
          (step - rigid).norm() <= Tolerance::same_step * step.norm();
        if (ratio > 0. && (is_rigid || !is_same) &&
            (step - ratio * last_step).norm() <=
              Tolerance::same_step * step.norm())
          {
            const Eigen::VectorXd &way = is_same ? rigid : step;
            const double least = Tolerance::towards_foundation * way.norm();
            // Bonds that are far softer than delta let steps repeat as nothing
            // does, but end the sum of the steps at delta over their stiffness.
            const bool is_loose =
              is_same && held(way) <= loose_stiffness * way.squaredNorm();
            if (is_loose && way.maxCoeff() <= least)
              return {SolverStatus::comes_off, n_systems, 0};
            double further = is_loose ? std::numeric_limits<double>::max() :
                             is_same  ? delta * way.squaredNorm() / held(way) :
                                        ratio / (1. - ratio);
            for (Eigen::Index j = 0; j < x.size(); ++j)
              if (way[j] > least)
                further = std::min(further, -x[j] / way[j]);
            x += further * way;
          }
        last_step = step;
      }
    return {SolverStatus::quadratic_program, n_systems, 0};
  }
} // namespace Debond
