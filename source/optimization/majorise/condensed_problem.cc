// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/optimization/majorise/cone_qp.h>

#include <Eigen/QR>

#include <cmath>
#include <utility>

namespace Debond
{
  namespace
  {
    Eigen::MatrixXd
    orthonormal(const Eigen::MatrixXd &motions)
    {
      if (motions.cols() == 0)
        return {};
      // Translations and rotations have different units, which is a matter of
      // scale for QR.
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
    , phi(problem.phi)
    , bounds(problem.upper, phi.kinks())
    , upper(bounds.place)
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
      active[i] = bounds.state(i, s);
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

    // The data are the original ones and not M and r, in which what a
    // majorant's factor has lost would not be seen. The terms of a row of S s
    // nearly cancel. Summed up column by column, for which processors have
    // instructions that sums row by row must not use.
    Eigen::VectorXd S_s   = Eigen::VectorXd::Zero(s.size());
    Eigen::VectorXd terms = Eigen::VectorXd::Zero(s.size());
    for (unsigned int j = 0; j < s.size(); ++j)
      if (s(j) != 0.)
        {
          S_s += s(j) * S.col(j);
          terms += std::abs(s(j)) * S.col(j).cwiseAbs();
        }
    const Eigen::VectorXd force = g - S_s - xi;
    const Eigen::VectorXd left  = force - bounds.kinks.gradient(s);
    for (unsigned int i = 0; i < s.size(); ++i)
      {
        // What rounding leaves of the forces and of the energy goes with the
        // size of their terms.
        largest_terms = std::max(largest_terms, terms(i));
        energy_terms += std::abs(s(i)) * terms(i);

        energy += 0.5 * s(i) * S_s(i);
        work += g(i) * s(i);
        // S s + xi - g + mu = 0,  mu >= 0,  s <= b,  mu'(s - b) = 0, b being
        // the upper bounds; at a kink mu is of any size up to its weight.
        const bool is_at = bounds.is_at(i, s);
        violation =
          std::max(violation,
                   is_at ? -bounds.hold(i, force) :
                           std::abs(left(i)) - bounds.kinks.rounding(i, s));
        largest_force = std::max(
          {largest_force, std::abs(g(i)), std::abs(S_s(i)), std::abs(xi(i))});
        state.n_active += is_at && !bounds.kinks.has(i);
        // A maximum would lose it.
        if (std::isnan(left(i)))
          violation = largest_force = left(i);
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
      ConeQP(M, r, bounds)
        .solve(before,
               active,
               is_trial && tolerance >= Tolerance::rough_majorant ? tolerance :
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



  double
  condensed_functional(const PiecewiseProblem &problem, const VectorView &s)
  {
    Eigen::VectorXd point = s;
    return CondensedProblem(problem, point).evaluate().functional;
  }
} // namespace Debond
