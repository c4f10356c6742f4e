// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/optimization/global/bond_bound.h>
#include <debond/optimization/global/convexity_shift.h>
#include <debond/optimization/majorise/cone_qp.h>

namespace Debond
{
  namespace
  {
    /// The part of the convexity of S that goes to bonds without a state.
    constexpr double share_of_bonds = 0.7;

    /// Steps to a point, of which any has a bound: more raise it by little.
    constexpr unsigned int reweightings = 4;



    /// A bound of states that a node has not, above all energies.
    constexpr double excluded = 1e300;



    /// The relaxation of a node.
    struct BondRelaxation
    {
      const SeparableEnergy &phi;
      const Eigen::VectorXd &g;
      ProofNode             &node;
      Eigen::MatrixXd        A;
      const unsigned int     n = static_cast<unsigned int>(g.size());
      Eigen::VectorXd        D = Eigen::VectorXd::Zero(n);

      /// The stiffness that unknowns lose if their bond, which may hold or be
      /// broken, breaks.
      Eigen::VectorXd k = Eigen::VectorXd::Zero(n);

      /// Bounds with a bond, by row, that holds or is broken. The third column
      /// has the value of its term at x in place of the least one.
      Eigen::MatrixXd bounds = {};

      /// Of planes below pairs of kinks, with the bounds.
      Eigen::VectorXd forces = {};

      bool
      is_decided(const unsigned int bond) const
      {
        return node.upper(n + bond) - node.lower(n + bond) < 1.;
      }

      /// Sets k and adds the stiffness of bonds that hold to A.
      void
      decide()
      {
        for (unsigned int j = 0; j < n; ++j)
          {
            const unsigned int i   = phi.bonds[j];
            const double stiffness = phi.weights(j) * phi.f[i][0].curvature;
            if (!is_decided(i))
              k(j) = stiffness;
            else if (node.lower(n + i) == 0.)
              // Rounded down, A gives a bound all the same.
              A(j, j) = std::nextafter(A(j, j) + stiffness, A(j, j));
          }
      }

      /// Moves x towards the minimum with convex functions below the terms.
      void
      minimise(const Eigen::VectorXd &upper)
      {
        // On the ball about 0 that has the box inside, with the radius R, the
        // envelope of the lesser of (k + D)/2 l^2 and k/2 m^2 + D/2 l^2 is a
        // parabola, a line that touches both or meets the second one at R, and
        // a parabola again. One about 0 that touches the envelope is above it.
        const Eigen::VectorXd R =
          phi.displacements(node.lower.head(n).cwiseAbs().cwiseMax(
            node.upper.head(n).cwiseAbs()));
        ActiveSet active(n, 0);
        for (unsigned int step = 0; step < reweightings; ++step)
          {
            const Eigen::VectorXd l = phi.displacements(node.x);
            Eigen::MatrixXd       M = A;
            for (unsigned int j = 0; j < n; ++j)
              if (k(j) > 0.)
                {
                  const unsigned int i = phi.bonds[j];
                  const double       d = D(j) / k(j), m = phi.f[i][0].lower,
                               end = std::max(R(i), m * std::sqrt(1. + 1. / d)),
                               slope = (1. + d) * end +
                                       std::sqrt(std::max(
                                         0., (1. + d) * (end * end - m * m)));
                  // Divided by k, the line touches (1 + d)/2 l^2 and meets the
                  // other parabola at `end`, so that its slope t solves
                  //
                  //     t^2 - 2 (1 + d) end t + (1 + d) (m^2 + d end^2) = 0.
                  //
                  // The parabola about 0 that touches the line at l has the
                  // curvature t/l, and those on both sides d and 1 + d. All of
                  // l, m, end and t are negative.
                  M(j, j) += k(j) * std::clamp(slope / l(i), d, 1. + d);
                }
            const Bounds with_kinks(upper, phi.kinks());
            node.x = ConeQP(M, g, with_kinks).solve(node.x, active).x;
          }
      }

      /// The force n w of a plane below each pair of kinks, w |v| >= w n'v
      /// with |n| <= 1, where @p rest is A x - g: that of the cone at x.
      Eigen::VectorXd
      forces_of_pairs(const Eigen::VectorXd &rest) const
      {
        const Kinks    &kinks  = phi.kinks();
        Eigen::VectorXd result = Eigen::VectorXd::Zero(n);
        for (const Eigen::Index i : kinks.pairs())
          {
            const auto      pair = kinks.group(i);
            Eigen::Vector2d v    = node.x(pair) - kinks.place(pair);
            // At its kink a pair balances the rest.
            const bool slides = !v.isZero(0.);
            if (!slides)
              v = -(rest + D.cwiseProduct(node.x))(pair) / kinks.weight(i);
            const double size = v.norm();
            if (slides || size > 1.)
              v /= size * (1. + 4. * Tolerance::epsilon);
            result(pair) = kinks.weight(i) * v;
          }
        return result;
      }

      /// Sets the bounds and returns that without a choice.
      double
      set_bounds()
      {
        // What cancels is summed in extended precision, and what rounding can
        // do is taken from the sums as in LowerBound.
        using LongVector    = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
        const LongVector x  = node.x.cast<long double>(),
                         Ax = A.cast<long double>() * x,
                         terms =
                           A.cwiseAbs().cast<long double>() * x.cwiseAbs();
        const long double tiny =
          (n + 16.) * std::numeric_limits<long double>::epsilon();
        // r_j is a double in what follows; its error bounds what that and the
        // sum have lost.
        const Eigen::VectorXd rest =
                                (Ax - g.cast<long double>()).cast<double>(),
                              of_pairs = forces_of_pairs(rest),
                              r        = rest + of_pairs,
                              error    = Tolerance::epsilon *
                                        (rest.cwiseAbs() + of_pairs.cwiseAbs() +
                                         g.cwiseAbs()) +
                                      (tiny * terms).cast<double>(),
                              l = phi.displacements(node.x);
        if (!phi.kinks().pairs().empty())
          forces = of_pairs;
        double size = static_cast<double>(x.dot(Ax));
        bounds.resize(phi.f.size(), 3);
        for (unsigned int i = 0; i < phi.f.size(); ++i)
          bounds.row(i) << excluded * node.lower(n + i),
            phi.f[i].size() == 1 || node.upper(n + i) < 1. ?
              excluded :
              phi.f[i].largest_value(),
            phi.f[i].value(l(i));
        for (unsigned int j = 0; j < n; ++j)
          {
            const unsigned int i = phi.bonds[j];
            // What the term of the bond is at x itself: by how much it is above
            // its least value says where a choice would raise the bound.
            bounds(i, 2) += node.x(j) * (r(j) + 0.5 * D(j) * node.x(j));
            const Kinks &kinks     = phi.kinks();
            const bool   is_single = kinks.has(j) && !kinks.is_paired(j);
            const double w         = is_single ? kinks.weight(j) : 0.;
            const double p         = kinks.has(j) ? kinks.place(j) : 0.;
            const double constant  = -of_pairs(j) * p;
            bounds(i, 2) += w * std::abs(node.x(j) - p) + constant;
            for (const int broken : {0, 1})
              {
                // A kink makes the term one on each side of it. The least value
                // is concave in r, so that the least one for all that r can be
                // is at an end.
                const double low = node.lower(j), high = node.upper(j);
                const auto   on_side =
                  [&](const double slope, const double from, const double to) {
                    return from > to ?
                             infinity :
                             Growth{0., 0., slope, D(j) + (1 - broken) * k(j)}
                               .least({from, to});
                  };
                const auto least_with = [&](const double r_j) {
                  return w == 0. ?
                           on_side(r_j, low, high) :
                           std::min(on_side(r_j - w, low, std::min(high, p)) +
                                      w * p,
                                    on_side(r_j + w, std::max(low, p), high) -
                                      w * p);
                };
                const double least = std::min(least_with(r(j) - error(j)),
                                              least_with(r(j) + error(j)));
                bounds(i, broken) += least + constant;
                size += std::abs(least) + w * std::abs(p) + std::abs(constant);
              }
          }
        const Eigen::VectorXd least = bounds.leftCols(2).rowwise().minCoeff();
        const double          sum =
          static_cast<double>(-0.5L * x.dot(Ax) -
                              tiny * x.cwiseAbs().dot(terms)) +
          least.sum() -
          (4. * n + 16.) * Tolerance::epsilon * (size + least.cwiseAbs().sum());
        // With a choice for one bond the bound is the sum with that bond's
        // value in place of its least one. The lesser of the first two in a row
        // is then the bound without a choice, so that any row gives it.
        bounds.colwise() += (sum - least.array()).matrix();
        bounds -= 4. * Tolerance::epsilon * bounds.cwiseAbs();
        return bounds.row(0).head(2).minCoeff();
      }

      /// What set_bounds() has shown with the matrix @p S.
      ProofRound
      round(const MatrixView &S)
      {
        const double value = set_bounds();
        return {S.diagonal() - A.diagonal(), node.x, forces, value};
      }
    };
  } // namespace



  std::optional<ProofNode>
  BondBound::root(const double best_value) const
  {
    const auto inverse = safe_inverse(S);
    if (!inverse)
      return {};
    // Without Phi, which is not negative, the functional is at least
    //     least - e |z - x| + 1/2 |z - x|^2
    // by the energy norm of S and, for the rest r = S x - g, that of its
    // inverse, e = |r|: with S nearly singular x is rounded by much.
    using LongVector        = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
    const Eigen::VectorXd s = *inverse * g;
    const LongVector x = s.cast<long double>(), load = g.cast<long double>(),
                     Sx = S.cast<long double>() * x;
    // |S x - g| with the most that rounding may have made of it: the sums are
    // of n terms in extended precision.
    const Eigen::VectorXd rest =
      ((Sx - load).cwiseAbs() +
       (n + 16.L) * std::numeric_limits<long double>::epsilon() *
         (S.cwiseAbs().cast<long double>() * x.cwiseAbs() + load.cwiseAbs()))
        .cast<double>();
    const double square = rest.dot(inverse->cwiseAbs() * rest);
    const double more =
      2. * static_cast<double>(best_value - x.dot(0.5L * Sx - load));
    const double distance =
      std::sqrt(square) + std::sqrt(std::max(0., square + more));
    const Eigen::VectorXd radius =
      (1. + Tolerance::outwards) * distance * inverse->diagonal().cwiseSqrt() +
      Tolerance::outwards * s.cwiseAbs();
    std::optional<ProofNode> node =
      ProofNode{-infinity, 0, s - radius, upper.cwiseMin(s + radius), s, {}};
    if (!node->lower.allFinite())
      return {};
    // Behind the box are the states of the bonds, from 0, where a bond holds,
    // to 1, where it is broken; at the root they may be either.
    const Eigen::Index size = n + static_cast<Eigen::Index>(phi.f.size());
    node->lower             = node->lower.cwiseMin(upper);
    node->lower.conservativeResizeLike(Eigen::VectorXd::Zero(size));
    node->upper.conservativeResizeLike(Eigen::VectorXd::Ones(size));
    node->bound = BondRelaxation{phi, g, *node, S}.set_bounds();
    return node;
  }



  ProofRound
  BondBound::bound_at(const Eigen::VectorXd &z) const
  {
    auto node = root(z.dot(0.5 * S * z - g) + phi.change(z));
    if (!node)
      return {};
    node->x                   = z;
    BondRelaxation relaxation = {phi, g, *node, S};
    relaxation.decide();
    // As in NodeBound::bound_at(): a function of l is nowhere below its tangent
    // plane if it is not below the tangent in the direction of z.
    const Eigen::VectorXd before = relaxation.A.diagonal(),
                          l      = phi.displacements(z);
    for (unsigned int j = 0; j < n; ++j)
      relaxation.A(j, j) -=
        (1. + Tolerance::excess_at_point) * phi.weights(j) *
          phi.f[phi.bonds[j]].needed_convexity(l(phi.bonds[j])) +
        Tolerance::floor_at_point * std::min(relaxation.k(j), S(j, j));
    relaxation.D = before - relaxation.A.diagonal();
    return is_safely_positive_definite(relaxation.A) ? relaxation.round(S) :
                                                       ProofRound();
  }



  NodeResult
  BondBound::bound(ProofNode   &node,
                   const double best_value,
                   const double tolerance) const
  {
    NodeResult result;
    while (!Interruption::noticed())
      {
        BondRelaxation relaxation = {phi, g, node, S};
        relaxation.decide();
        auto inverse = safe_inverse(relaxation.A);
        if (!inverse)
          break;
        // The same part of all that A can spare, in proportion to the need.
        const bool all_decided = relaxation.k.isZero(0.);
        if (!all_decided)
          {
            const Eigen::VectorXd before = relaxation.A.diagonal();
            Eigen::VectorXd       shift  = share_of_bonds *
                                    largest_multiple(*inverse, relaxation.k) *
                                    relaxation.k;
            inverse      = take_shift(S.trace(), relaxation.A, shift);
            relaxation.D = before - relaxation.A.diagonal();
          }
        relaxation.minimise(upper);
        result.rounds.push_back(relaxation.round(S));
        const double value = result.rounds.back().value;
        node.bound         = std::max(node.bound, value);
        // Without a bound, as x may be no number where A is nearly singular,
        // that of before is left.
        if (node.bound >= best_value - tolerance || all_decided ||
            !(value < best_value))
          break;

        // Points below the best value are near x, and their bonds in states
        // that the box has a part of and with bounds below it.
        const Eigen::VectorXd radius =
          (1. + Tolerance::outwards) *
          (2. * (best_value - value) * inverse->diagonal()).cwiseSqrt();
        node.lower.head(n) = node.lower.head(n).cwiseMax(node.x - radius);
        node.upper.head(n) = node.upper.head(n).cwiseMin(node.x + radius);
        // The point of the box that is nearest to 0, in each unknown: if even
        // there a bond is stretched beyond its threshold, it is broken in the
        // whole box.
        const Eigen::VectorXd nearest = phi.displacements(
          node.lower.head(n).cwiseMax(-node.upper.head(n)).cwiseMax(0.));
        const Eigen::MatrixXd &bounds  = relaxation.bounds;
        double                 highest = -infinity;
        bool                   is_new  = false;
        for (unsigned int i = 0; i < phi.f.size(); ++i)
          if (!relaxation.is_decided(i))
            {
              if (bounds(i, 0) > best_value || nearest(i) < phi.f[i][0].lower)
                node.lower(n + i) = 1.;
              if (bounds(i, 1) > best_value)
                node.upper(n + i) = 0.;
              is_new = is_new || relaxation.is_decided(i);
              // The term that is farthest above its least value.
              if (bounds(i, 2) > highest)
                {
                  highest            = bounds(i, 2);
                  result.unknown     = n + i;
                  result.split       = 0.5;
                  result.half_bounds = {{bounds(i, 1), bounds(i, 0)}};
                }
            }
        result.rounds.back().lower = node.lower;
        result.rounds.back().upper = node.upper;
        if (!is_new && result.unknown)
          return result;
        result.unknown.reset();
        if (!is_new)
          break;
        if ((node.lower - node.upper).maxCoeff() > 0.)
          {
            node.bound = best_value;
            break;
          }
      }
    result.least = node.bound;
    return result;
  }
} // namespace Debond
