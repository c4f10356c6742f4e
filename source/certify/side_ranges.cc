// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/certify/side_ranges.h>
#include <debond/optimization/global/node_bound.h>

namespace Debond
{
  namespace
  {
    /// The numbers of boxes of which the union says where minimisers are.
    constexpr unsigned int n_nodes_of_ranges       = 32;
    constexpr unsigned int n_quick_nodes_of_ranges = 4;



    /// Returns the ranges of displacements of a node whose functional of the
    /// means is at most @p upper; nothing if there are none.
    std::optional<std::vector<CertifiedSide>>
    ranges_of_node(const MeanProblem           &problem,
                   const std::vector<NodeBall> &balls,
                   const ProofNode             &node,
                   const double                 upper)
    {
      const unsigned int n = problem.n_sides();
      const unsigned int n_kept =
        static_cast<unsigned int>(problem.kept.size());
      const unsigned int n_eliminated =
        static_cast<unsigned int>(problem.eliminated.size());
      // Means and slopes as functions of s, and what of their variance is that
      // of what is eliminated. The others are y = offset + to_others s + e, and
      // the functional has 1/2 e'A_oo e for e beside its form in s. So the
      // variance of a linear functional of both is a sum of l_s'A^{-1} l_s,
      // with l_s what it is as a function of s, and of its own entries of
      // A_oo^{-1}.
      Eigen::MatrixXd means  = Eigen::MatrixXd::Zero(n, n_kept);
      Eigen::MatrixXd slopes = problem.to_others.bottomRows(n);
      Eigen::VectorXd of_mean(Eigen::VectorXd::Zero(n));
      Eigen::VectorXd mixed(Eigen::VectorXd::Zero(n));
      Eigen::VectorXd of_slope = problem.inverse_in_others.diagonal().tail(n);
      std::vector<CertifiedSide> ranges(n);
      for (unsigned int i = 0; i < n_kept; ++i)
        {
          const unsigned int side = problem.kept[i];
          means(side, i)          = 1.;
          ranges[side].mean       = {node.lower(i), node.upper(i)};
        }
      for (unsigned int i = 0; i < n_eliminated; ++i)
        {
          const unsigned int side = problem.eliminated[i];
          means.row(side)         = problem.to_others.row(i);
          of_mean(side)           = problem.inverse_in_others(i, i);
          mixed(side) = problem.inverse_in_others(i, n_eliminated + side);
        }
      for (const NodeBall &ball : balls)
        {
          if (ball.value > upper)
            return {};
          // By value + 1/2 (s - x)'A (s - x) <= U each linear functional l's is
          // within (2 (U - value) l'A^{-1} l)^{1/2} of l'x; the variance below
          // is l'A^{-1} l. It is enlarged by a little for what rounding does to
          // roots and inverses.
          const double radius =
            std::sqrt(2. * (upper - ball.value)) * (1. + Tolerance::outwards);
          const Eigen::VectorXd x         = problem.all(ball.x);
          const Eigen::MatrixXd of_means  = means * ball.inverse;
          const Eigen::MatrixXd of_slopes = slopes * ball.inverse;
          for (unsigned int i = 0; i < n; ++i)
            {
              // Variances of m, of k and their covariance give that of m + xi k
              // for each xi; at the ends of the side, xi = -1 and 1, it bounds
              // p there.
              const double mean_variance =
                of_mean(i) + of_means.row(i).dot(means.row(i));
              const double slope_variance =
                of_slope(i) + of_slopes.row(i).dot(slopes.row(i));
              const double covariance =
                mixed(i) + of_means.row(i).dot(slopes.row(i));
              // The range of the mean + xi times the slope.
              const auto range_at = [&](const double xi) -> Interval {
                const double variance = mean_variance + 2. * xi * covariance +
                                        xi * xi * slope_variance;
                const double centre = x(i) + xi * x(n + i);
                const double distance =
                  radius * std::sqrt(std::max(variance, 0.));
                return {centre - distance, centre + distance};
              };
              ranges[i].combine(
                intersection,
                {{}, range_at(0.), {{range_at(-1.), range_at(1.)}}, {}});
            }
        }
      return ranges;
    }



    /// Takes from the box of a node what is not in the ranges; false if nothing
    /// is left.
    bool
    cut(ProofNode                        &node,
        const MeanProblem                &problem,
        const std::vector<CertifiedSide> &ranges)
    {
      for (unsigned int i = 0; i < problem.kept.size(); ++i)
        {
          // Ranges of earlier problems hold for this one, too, and cut its
          // boxes.
          const Interval &mean = ranges[problem.kept[i]].mean;
          node.lower(i)        = std::max(node.lower(i), mean.lower);
          node.upper(i)        = std::min(node.upper(i), mean.upper);
        }
      return (node.lower.array() <= node.upper.array()).all();
    }



    /// The two parts of a node.
    std::array<ProofNode, 2>
    halves(const ProofNode &node, const NodeResult &result)
    {
      const unsigned int       i     = *result.unknown;
      std::array<ProofNode, 2> parts = {{node, node}};
      parts[0].lower(i)              = result.split;
      parts[0].number                = 2 * node.number + 1;
      parts[1].upper(i)              = result.split;
      parts[1].number                = 2 * node.number + 2;
      return parts;
    }

  } // namespace



  void
  shrink_ranges(const MeanProblem          &problem,
                const double                upper,
                const bool                  is_quick,
                const Interruption         &interruption,
                std::vector<CertifiedSide> &ranges,
                ProofRecord *const          record)
  {
    // In each box that is not excluded the functional grows quadratically about
    // its relaxed minimum, so that points with J <= U are in an ellipsoid
    // around it. More boxes give smaller ellipsoids, and their union is the
    // range. J <= U means that the functional of s is at most U less the
    // constant, where the constant may be too large by its rounding.
    const double    best = upper - problem.constant + problem.rounding;
    const NodeBound bound({problem.S,
                           problem.g,
                           Eigen::VectorXd::Zero(problem.g.size()),
                           *problem.phi});
    // With their numbers in the record.
    std::vector<std::pair<ProofNode, unsigned int>> open;
    unsigned int                                    n_recorded = 0;
    if (auto root = bound.root(best))
      {
        if (record != nullptr)
          (*record)[0].rounds = {bound.round_of_root(*root)};
        if (!cut(*root, problem, ranges))
          return;
        // The root then has as few relaxations as later nodes.
        if (is_quick)
          root->number = 1;
        open.emplace_back(std::move(*root), n_recorded++);
      }
    else
      return;
    const Interval             empty = {1., -1.};
    std::vector<CertifiedSide> hulls(ranges.size(),
                                     {{}, empty, {{empty, empty}}, {}});
    const unsigned int         n_nodes =
      is_quick ? n_quick_nodes_of_ranges : n_nodes_of_ranges;
    for (unsigned int nodes = 0; !open.empty(); ++nodes)
      {
        if (interruption.requested())
          return;
        auto [node, number] = std::move(open.back());
        open.pop_back();
        NodeResult result;
        NodeRecord found;
        // Once there are enough boxes the open ones are taken as they are.
        if (nodes < n_nodes)
          {
            result = bound.bound(node, best, 0.);
            found  = {result.rounds, result.unknown, result.split};
          }
        if (result.unknown)
          // The lower half is taken next, as it is the last one that is
          // appended.
          for (ProofNode &half : halves(node, result))
            {
              found.halves[n_recorded % 2 == 0] = n_recorded;
              open.emplace_back(std::move(half), n_recorded++);
            }
        else if (nodes >= n_nodes || result.least < best)
          {
            const std::vector<NodeBall> balls = bound.balls(node);
            for (const NodeBall &ball : balls)
              found.rounds.push_back({ball.D, ball.x, {}, ball.value});
            if (const auto own = ranges_of_node(problem, balls, node, best))
              for (unsigned int i = 0; i < ranges.size(); ++i)
                hulls[i].combine(hull, (*own)[i]);
          }
        if (record != nullptr)
          {
            NodeRecord &kept = (*record)[number];
            found.rounds.insert(found.rounds.begin(),
                                kept.rounds.begin(),
                                kept.rounds.end());
            kept = found;
          }
      }
    for (unsigned int i = 0; i < ranges.size(); ++i)
      // If there is none at all the ranges are left as they are.
      if (!hulls[i].mean.is_empty())
        ranges[i].combine(intersection, hulls[i]);
  }
} // namespace Debond
