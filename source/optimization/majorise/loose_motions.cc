// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/optimization/majorise/cone_qp.h>
#include <debond/optimization/polar_cone.h>

#include <Eigen/Eigenvalues>

namespace Debond
{
  namespace
  {
    /// Far more than scenes need.
    constexpr unsigned int maximum_proximal_steps = 500;

    /// Of the balance of forces, each of few operations.
    constexpr unsigned int most_sweeps = 10000;
  } // namespace



  Eigen::MatrixXd
  CondensedProblem::motions_held_by_less(const double most) const
  {
    // Of N'E N, as S is zero along N.
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      N.transpose() * (majorant.E * N));
    return N * eigen.eigenvectors().leftCols(
                 (eigen.eigenvalues().array() <= most).count());
  }



  std::optional<Eigen::VectorXd>
  CondensedProblem::unbalanced_by_friction(const Eigen::MatrixXd &towards,
                                           const Eigen::MatrixXd &motions,
                                           const Eigen::VectorXd &forces) const
  {
    // Least squares with pressures and with frictions up to their weights, one
    // after the other. What is left is a motion along which the forces do more
    // work than friction takes.
    Eigen::VectorXd rest   = forces;
    Eigen::VectorXd amount = Eigen::VectorXd::Zero(towards.cols());
    for (unsigned int k = 0; k < most_sweeps; ++k)
      {
        const Eigen::VectorXd before = rest;
        for (Eigen::Index i = 0; i < towards.cols(); ++i)
          {
            // Of pairs both at once.
            if (bounds.kinks.is_paired(i) && bounds.kinks.partner[i] < i)
              continue;
            const bool            has_kink = bounds.kinks.has(i);
            const auto            all      = bounds.kinks.group(i);
            const Eigen::MatrixXd columns =
              (has_kink ? motions : towards)(Eigen::all, all);
            const double square = columns.squaredNorm();
            if (square == 0.)
              continue;
            Eigen::VectorXd next =
              amount(all) + columns.transpose() * rest / square;
            if (!has_kink)
              next = next.cwiseMax(0.);
            else if (const double size = next.norm();
                     size > bounds.kinks.weight(i))
              next *= bounds.kinks.weight(i) / size;
            rest -= columns * (next - amount(all));
            amount(all) = next;
          }
        if ((rest - before).norm() <= Tolerance::epsilon * forces.norm())
          return rest;
      }
    return {};
  }



  bool
  CondensedProblem::falls_along(const Eigen::MatrixXd &Z) const
  {
    Eigen::MatrixXd towards  = Z.transpose();
    const double    furthest = towards.colwise().norm().maxCoeff();
    for (Eigen::Index i = 0; i < towards.cols(); ++i)
      if (std::isinf(upper(i)) || bounds.kinks.has(i) ||
          towards.col(i).norm() <= Tolerance::towards_foundation * furthest)
        towards.col(i).setZero();
    // The forces along Z are the sum of what pressures of the foundation
    // balance and of the nearest motion p along which no node comes to the
    // foundation. They do work along p, and nothing else holds it but friction,
    // which takes its weight times the way.
    const Eigen::VectorXd                forces = Z.transpose() * r;
    const std::optional<Eigen::VectorXd> unbalanced =
      bounds.kinks.weight.size() == 0 ?
        project_on_polar_cone(towards, forces) :
        unbalanced_by_friction(towards, Z.transpose(), forces);
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
        const Eigen::VectorXd load = r + delta * Z * (Z.transpose() * x);
        const BoundQPResult   qp =
          ConeQP(proximal, load, bounds).solve(x, active);
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
            // So far away that rounding outweighs the forces nothing is known
            // to be balanced by friction.
            const bool is_lost =
              bounds.kinks.weight.size() > 0 &&
              Tolerance::row_of_product * stiffness * x.norm() >
                Tolerance::lost_beside_friction * r.norm();
            s             = x;
            result.status = is_lost ? SolverStatus::comes_off : qp.status;
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
      further = infinity;
    // To the next bound, or kink ahead.
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (bounds.kinks.has(i) || way[i] > least)
        further = std::min(further, bounds.way_to(i, x, way));
    // Without any this has no end.
    if (std::isinf(further))
      return false;
    x += further * way;
    return true;
  }
} // namespace Debond
