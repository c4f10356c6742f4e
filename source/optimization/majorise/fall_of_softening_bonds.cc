// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/linear_algebra/cholesky.h>
#include <debond/optimization/majorise/condensed_problem.h>

namespace Debond
{
  namespace
  {
    /// On the way of a fall, for each unknown.
    constexpr unsigned int most_pieces_passed = 10;

    constexpr unsigned int most_bisections = 50;

    /// Towards the motion along which J is least convex.
    constexpr unsigned int steps_to_least_convex = 20;
  } // namespace



  Eigen::VectorXd
  CondensedProblem::slope_of_phi() const
  {
    return phi.subgradient(s) + bounds.kinks.gradient(s);
  }



  void
  CondensedProblem::fall(const Eigen::VectorXd &before)
  {
    std::vector<unsigned int> free;
    for (unsigned int i = 0; i < s.size(); ++i)
      if (!bounds.is_at(i, s))
        free.push_back(i);
    // All in contact: the majorant has said all.
    if (free.empty())
      return;
    // The second derivative of J itself, which for pieces that soften is less
    // than that of the majorant.
    Eigen::MatrixXd A = S;
    A += phi.second_derivative(s) + bounds.kinks.curvature(s);
    const Eigen::VectorXd force = g - S * s - slope_of_phi();
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
    // Up to where the first component meets its bound or kink: the active set
    // is a matter of the next majorant.
    double limit = infinity;
    for (Eigen::Index i = 0; i < s.size(); ++i)
      limit = std::min(limit, bounds.way_to(i, s, ds));
    const Eigen::VectorXd start     = s;
    const Eigen::VectorXd rigid     = N.cols() > 0 ?
                                        Eigen::VectorXd(N * (N.transpose() * ds)) :
                                        Eigen::VectorXd::Zero(s.size());
    const double          work      = ds.dot(g - S * s);
    const double          stiffness = ds.dot(S * ds);
    const auto            slope_at  = [&](const double t) {
      s = start + t * ds;
      // Rounding must not lead beyond.
      for (Eigen::Index i = 0; i < s.size(); ++i)
        if (!bounds.kinks.is_paired(i) &&
            (s(i) > upper(i)) != (start(i) > upper(i)))
          s(i) = upper(i);
      return t * stiffness - work + slope_of_phi().dot(ds);
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
} // namespace Debond
