// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/linear_algebra/cholesky.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/optimization/polar_cone.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <cmath>
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
      // Their units differ, which is a matter of scale for QR.
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



  CondensedProblem::CondensedProblem(const PiecewiseProblem &problem,
                                     Eigen::VectorXd        &start,
                                     const Eigen::MatrixXd  &free_motions,
                                     const double            stiffness)
    : N(orthonormal(free_motions))
    , S_of_loose(without_motions(problem.S, N))
    , S(N.cols() > 0 ? MatrixView(S_of_loose) : problem.S)
    , stiffness(stiffness)
    , g(problem.g)
    , upper(problem.upper)
    , phi(problem.phi)
    , s(start)
    , active(start.size())
  {
    // Where all bonds hold they hold the rigid motions by this much. What is
    // left of it by rounding is nothing, however soft the bonds are beside the
    // body.
    if (N.cols() > 0)
      loose_stiffness =
        Tolerance::loose_motion *
        (N.transpose() * (phi.curvature(Eigen::VectorXd::Zero(s.size())) * N))
          .norm();
    for (unsigned int i = 0; i < s.size(); ++i)
      active[i] = s(i) == upper(i);
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
    const double change = phi.change(s);

    // From the original data, not from M and r: what a majorant's factor has
    // lost would not be seen in these.
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
        // What rounding leaves of the forces and of the energy goes with the
        // size of their terms.
        largest_terms = std::max(largest_terms, terms(i));
        energy_terms += std::abs(s(i)) * terms(i);

        energy += 0.5 * s(i) * S_s(i);
        work += g(i) * s(i);
        // S s + xi - g + mu = 0,  mu >= 0,  s <= b,  mu'(s - b) = 0, b being
        // the upper bounds.
        const double mu = g(i) - S_s(i) - xi(i);
        violation = std::max(violation, s(i) < upper(i) ? std::abs(mu) : -mu);
        largest_force = std::max(
          {largest_force, std::abs(g(i)), std::abs(S_s(i)), std::abs(xi(i))});
        state.n_active += s(i) == upper(i);
        // A maximum would lose it.
        if (std::isnan(mu))
          violation = largest_force = mu;
      }
    state.functional = energy - work + change;
    state.functional_rounding =
      Tolerance::epsilon *
      (16. * (energy + std::abs(work) + change) + energy_terms);
    // Without any force there is nothing to be relative to, and nothing wrong.
    state.residual = largest_force == 0. ? 0. : violation / largest_force;
    state.residual_rounding =
      largest_force == 0. ?
        0. :
        Tolerance::row_of_product * largest_terms / largest_force;
    state.largest_force = largest_force;
    return state;
  }



  bool
  CondensedProblem::majorise()
  {
    // S + E is made anew only if E changes: with many contact nodes that is a
    // part of the time of a step.
    const bool is_new = majorant.touch(s, phi.subgradient(s), phi.curvature(s));
    r                 = g + majorant.b;
    if (is_new)
      {
        M = S;
        M += majorant.E;
      }
    return is_new;
  }



  MajorantProblem::Minimisation
  CondensedProblem::minimise(const double tolerance)
  {
    if (N.cols() > 0)
      {
        // Along these motions S + E is singular to rounding, and a Cholesky
        // factor would be of rounding.
        const Eigen::MatrixXd Z = motions_held_by_less(
          std::max(Tolerance::least_stiffness * stiffness, loose_stiffness));
        if (Z.cols() > 0)
          return minimise_along(Z);
      }
    // The active set of the last majorant is mostly right for the next one;
    // from afar the guess is better.
    if (guess != nullptr && !guess->empty())
      active = guess->active_set(M, majorant.E, r, upper);
    const Eigen::VectorXd before = s;
    const BoundQPResult   qp =
      solve_bound_qp(M,
                     r,
                     upper,
                     active,
                     is_trial && tolerance >= Tolerance::rough_majorant ?
                       tolerance :
                       0.,
                     factor);
    if (qp.status != SolverStatus::interrupted)
      s = qp.x;
    if (can_be_verified(qp.status) && phi.softens())
      fall(before);
    // So far away that rounding of the displacements outweighs all forces: only
    // a hold that is rounding itself can have led there.
    if (N.cols() > 0 && s.norm() > before.norm() &&
        Tolerance::row_of_product * stiffness * s.norm() > r.norm())
      return {SolverStatus::comes_off, qp.steps, 0, qp.operations};
    return {qp.status, qp.steps, 0, qp.operations};
  }



  void
  CondensedProblem::fall(const Eigen::VectorXd &before)
  {
    std::vector<unsigned int> free;
    for (unsigned int i = 0; i < s.size(); ++i)
      if (s(i) < upper(i))
        free.push_back(i);
    // All in contact: the majorant has said all.
    if (free.empty())
      return;
    // The second derivative of J itself, which for pieces that soften is less
    // than that of the majorant.
    Eigen::MatrixXd A = S;
    A += phi.second_derivative(s);
    const Eigen::VectorXd force = g - S * s - phi.subgradient(s);
    const DenseCholesky   factor_of_J(A(free, free));
    Eigen::VectorXd       way;
    if (factor_of_J.is_positive_definite())
      {
        way = force(free);
        factor_of_J.solve_in_place(way);
        // Along what nothing holds the factor, and so the step, is of rounding.
        if (N.cols() > 0 &&
            way.dot(force(free)) <= loose_stiffness * way.squaredNorm())
          return;
      }
    else
      {
        // M^{-1}(M - A), M of the majorant, is what takes one step of majorants
        // to the next one.
        if (!factor->restrict_to(free, M))
          return;
        // So its powers lead to the motion along which J is least convex, on
        // which majorants crawl away from a point that is no minimum.
        const Eigen::MatrixXd rest = M(free, free) - A(free, free);
        way                        = (s - before)(free);
        for (unsigned int k = 0; k < steps_to_least_convex && !way.isZero(0.);
             ++k)
          {
            way = rest * (way / way.lpNorm<Eigen::Infinity>());
            factor->solve_in_place(way);
          }
        // Downhill.
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
    // Up to where the first component meets its bound: the active set is a
    // matter of the next majorant.
    double limit = infinity;
    for (Eigen::Index i = 0; i < s.size(); ++i)
      if (ds(i) > 0.)
        limit = std::min(limit, (upper(i) - s(i)) / ds(i));
    const Eigen::VectorXd start     = s;
    const Eigen::VectorXd rigid     = N.cols() > 0 ?
                                        Eigen::VectorXd(N * (N.transpose() * ds)) :
                                        Eigen::VectorXd::Zero(s.size());
    const double          work      = ds.dot(g - S * s);
    const double          stiffness = ds.dot(S * ds);
    const auto            slope_at  = [&](const double t) {
      s = (start + t * ds).cwiseMin(upper);
      return t * stiffness - work + phi.subgradient(s).dot(ds);
    };
    // J along the line is a parabola as long as no point leaves its piece. From
    // piece to piece, to where the slope is zero.
    double t = 0., slope = slope_at(0.);
    double beyond_kink =
      Tolerance::past_kink * s.lpNorm<Eigen::Infinity>() / size;
    const double least_slope = Tolerance::end_of_fall * std::abs(slope);
    for (Eigen::Index k = 0;
         k < most_pieces_passed * s.size() && slope < -least_slope && t < limit;
         ++k)
      {
        // The Newton step on the line, or where J is concave there that of the
        // body alone, up to which J falls, and growing ones.
        const double curvature =
          stiffness + ds.dot(phi.second_derivative(s) * ds);
        const double step =
          std::min(limit - t,
                   curvature > 0. ? -slope / curvature :
                                    std::max(-slope / std::abs(stiffness), t));
        const double part = phi.first_change(s, ds, step);
        // What nothing holds would fall for ever: the next majorant says so. A
        // direction that is a rigid motion but for little has the stiffness of
        // that little, which is no hold.
        if (part >= step && (step < limit - t || std::isinf(limit)) &&
            2. * rigid.squaredNorm() > ds.squaredNorm() &&
            rigid.dot(phi.second_derivative(s) * rigid) <=
              loose_stiffness * rigid.squaredNorm())
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
    // Of N'E N, as S is zero along N.
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      N.transpose() * (majorant.E * N));
    return N * eigen.eigenvectors().leftCols(
                 (eigen.eigenvalues().array() <= most).count());
  }



  bool
  CondensedProblem::falls_along(const Eigen::MatrixXd &Z) const
  {
    Eigen::MatrixXd towards  = Z.transpose();
    const double    furthest = towards.colwise().norm().maxCoeff();
    for (Eigen::Index i = 0; i < towards.cols(); ++i)
      if (std::isinf(upper(i)) ||
          towards.col(i).norm() <= Tolerance::towards_foundation * furthest)
        towards.col(i).setZero();
    // The forces along Z are the sum of what pressures of the foundation
    // balance and of the nearest motion p along which no node comes to the
    // foundation. They do work along p, and nothing else holds it.
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

    Eigen::VectorXd x = s, last_step = Eigen::VectorXd::Zero(s.size());
    Minimisation    result = {SolverStatus::quadratic_program, 0, 0};
    for (unsigned int k = 0; k < maximum_proximal_steps; ++k)
      {
        const BoundQPResult qp = solve_bound_qp(
          proximal, r + delta * Z * (Z.transpose() * x), upper, active);
        result.active_set_steps += qp.steps;
        if (!can_be_verified(qp.status))
          {
            result.status = qp.status;
            return result;
          }
        const Eigen::VectorXd step = qp.x - x;
        x                          = qp.x;
        // The proximal force balances what the foundation does not, and where
        // bonds are soft what rounding leaves of S x.
        if (delta * (Z.transpose() * step).norm() <=
            std::max(Tolerance::balanced * r.norm(),
                     Tolerance::row_of_product * stiffness * x.norm()))
          {
            s             = x;
            result.status = qp.status;
            return result;
          }
        if (!extrapolate(delta, step, last_step, x))
          {
            result.status = SolverStatus::comes_off;
            return result;
          }
        last_step = step;
      }
    return result;
  }



  bool
  CondensedProblem::extrapolate(const double           delta,
                                const Eigen::VectorXd &step,
                                const Eigen::VectorXd &last_step,
                                Eigen::VectorXd       &x) const
  {
    // After the first step there is no ratio, which is not a number then.
    const double ratio = step.dot(last_step) / last_step.squaredNorm();
    const double same  = Tolerance::same_step * step.norm();
    if (!(ratio > 0.) || (step - ratio * last_step).norm() > same)
      return true;
    // The difference from a ratio next to 1 is rounding, and the stiffness of
    // the bonds along the step gives the rest of the series. It is the rigid
    // part of the step that they hold. Bonds that are about to break beside a
    // node that stays in contact turn the softest motions a little out of the
    // one about that node, which is no part of any series.
    const bool            repeats = ratio >= 1. - Tolerance::same_step;
    const Eigen::VectorXd rigid   = N * (N.transpose() * step);
    if (repeats && (step - rigid).norm() > same)
      return true;
    const Eigen::VectorXd &way     = repeats ? rigid : step;
    const double           least   = Tolerance::towards_foundation * way.norm();
    double                 further = ratio / (1. - ratio);
    if (repeats && held(way) > loose_stiffness * way.squaredNorm())
      further = delta * way.squaredNorm() / held(way);
    else if (repeats)
      {
        // Without a node that comes to the foundation this has no end.
        if (way.maxCoeff() <= least)
          return false;
        further = std::numeric_limits<double>::max();
      }
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (way[i] > least)
        further = std::min(further, (upper[i] - x[i]) / way[i]);
    x += further * way;
    return true;
  }



  double
  condensed_functional(const PiecewiseProblem &problem, const VectorView &s)
  {
    Eigen::VectorXd point = s;
    return CondensedProblem(problem, point).evaluate().functional;
  }
} // namespace Debond
