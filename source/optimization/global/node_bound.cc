// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/optimization/global/convexity_shift.h>
#include <debond/optimization/global/node_bound.h>

namespace Debond
{
  namespace
  {
    /// The part of the convexity of S that goes to what is undecided in the
    /// first relaxation of a node. What is left has to shrink its box.
    constexpr double first_share = 0.5;

    /// Relaxations of a node but the root.
    constexpr unsigned int n_rounds = 6;

    /// Steps of iterative refinement in extended precision.
    constexpr unsigned int refinements = 3;

    /// The parameter mu of raise_bound, as a part of what is left to prove per
    /// unknown. Smaller ones leave too little to shrink the box.
    constexpr double barrier = 1.;

    /// How much the gap of an envelope counts when its unknown is chosen,
    /// beside the bound of the lower one of its halves.
    constexpr double envelope_weight = 0.3;



    /// Pieces of an unknown's term, first and last.
    struct Pieces
    {
      unsigned int first, last;
    };

    /// Those that the box has a part of.
    Pieces
    pieces_in_box(const ProofNode       &node,
                  const unsigned int     i,
                  const PiecewiseEnergy &f)
    {
      // A piece that the box has only an end of is no part: at the kink the
      // piece on the side of 0 holds.
      const unsigned int last  = f.index(node.lower(i));
      unsigned int       first = 0;
      while (first < last && node.upper(i) <= f[first].lower)
        ++first;
      return {first, last};
    }



    /// The relaxations of one node.
    class Relaxations
    {
    public:
      Relaxations(const Eigen::MatrixXd &S,
                  const Eigen::VectorXd &g,
                  const SeparableEnergy &phi,
                  ProofNode             &node)
        : S(S)
        , phi(phi)
        , n(static_cast<unsigned int>(g.size()))
        , node(node)
      {
        problem.g = g;
      }

      NodeResult
      run(const double       best_value,
          const double       tolerance,
          const unsigned int maximum_rounds)
      {
        // A round has four steps. A diagonal D is moved from S to the terms;
        // the envelopes of the terms on the box make a convex relaxation; at
        // its minimum x LowerBound gives a bound for the box, which holds for
        // any x; and what cannot be below the best value is cut off the box. In
        // the smaller box the envelopes are tighter, and D is chosen anew, so
        // that the next round has a higher bound. When more rounds gain too
        // little, the node is divided.
        NodeResult result;
        for (unsigned int round = 0;; ++round)
          {
            if (Interruption::noticed() || !set_up(round == 0))
              break;
            // With every unknown on one convex piece the relaxation is the
            // problem itself.
            const bool all_decided = undecided().empty();
            minimise_relaxation(problem, envelopes, node.x);
            const LowerBound lower_bound(problem, node.x);
            node.bound = std::max(node.bound, lower_bound.value);
            result.rounds.push_back({S.diagonal() - problem.A.diagonal(),
                                     node.x,
                                     {},
                                     lower_bound.value});
            // With all decided, rounding is all that is left.
            if (node.bound >= best_value - tolerance || all_decided)
              break;

            // The bound grows with the distance from x. Where it is above the
            // best value nothing needs to be looked for; if that is everywhere,
            // the node is done.
            const bool is_left         = shrink(lower_bound, best_value);
            result.rounds.back().lower = node.lower;
            result.rounds.back().upper = node.upper;
            if (!is_left)
              {
                result.least = best_value;
                return result;
              }
            // The convexity that the relaxation was made with is where the next
            // one starts, and where those of the halves do. A node that has
            // inherited a shift keeps it over its first round, whose own D,
            // which leaves much in A, is there to shrink the box.
            if (round > 0 || node.shift.isZero(0.))
              {
                for (unsigned int i = 0; i < n; ++i)
                  node.shift(i) = problem.f[i].convexity;
                if (round > 0)
                  raise(best_value - lower_bound.value);
              }
            // More rounds gain less than two halves do.
            if (round + 1 >= maximum_rounds)
              choose(lower_bound, result);
            if (result.unknown)
              return result;
          }
        result.least = node.bound;
        return result;
      }

      std::optional<NodeBall>
      ball(const bool is_first)
      {
        // The same relaxation as in run(), minimised once.
        if (!set_up(is_first))
          return {};
        minimise_relaxation(problem, envelopes, node.x);
        return NodeBall{LowerBound(problem, node.x).value,
                        node.x,
                        inverse,
                        S.diagonal() - problem.A.diagonal()};
      }

    private:
      const Eigen::MatrixXd &S;
      const SeparableEnergy &phi;
      const unsigned int     n;
      ProofNode             &node;

      BoxProblem                  problem;
      std::vector<ConvexEnvelope> envelopes;

      /// Of the problem's matrix.
      Eigen::MatrixXd inverse;

      /// Whose terms are not convex with what they have of S's convexity.
      std::vector<unsigned int>
      undecided() const
      {
        // A term is convex with its D if its envelope has no line.
        std::vector<unsigned int> result;
        for (unsigned int i = 0; i < n; ++i)
          if (std::any_of(envelopes[i].parts.begin(),
                          envelopes[i].parts.end(),
                          [](const auto &part) { return part.is_line; }))
            result.push_back(i);
        return result;
      }

      /// Returns false if the problem is not safely convex without a shift.
      bool
      set_up(const bool is_first)
      {
        // q(s) = 1/2 s'A s - g's + sum f_i(s_i) again, with some convexity
        // moved from the diagonal of A to f_i: the sum is the same, its convex
        // envelope is larger.
        problem.A     = S;
        problem.lower = node.lower;
        problem.upper = node.upper;
        problem.f.resize(n);
        Eigen::VectorXd shift   = Eigen::VectorXd::Zero(n);
        Eigen::VectorXd weights = Eigen::VectorXd::Zero(n);
        for (unsigned int i = 0; i < n; ++i)
          {
            const Pieces   pieces = pieces_in_box(node, i, phi.f[i]);
            ShiftedEnergy &f      = problem.f[i];
            f                     = {0., {}};
            double least = phi.f[i][pieces.first].curvature, largest = least;
            for (unsigned int k = pieces.first; k <= pieces.last; ++k)
              {
                f.pieces.push_back(phi.f[i][k]);
                least   = std::min(least, f.pieces.back().curvature);
                largest = std::max(largest, f.pieces.back().curvature);
              }
            // Undecided: the spread of the curvatures says how much convexity
            // could make the term convex. Decided unknowns have theirs in A,
            // where it can be moved to others.
            if (pieces.first < pieces.last || least < 0.)
              {
                shift(i)   = node.shift(i);
                weights(i) = std::max(largest, 0.) - least;
              }
            else if (double &curvature = f.pieces[0].curvature; curvature > 0.)
              {
                // Rounded down, A gives a bound all the same.
                problem.A(i, i) =
                  (problem.A(i, i) + curvature) * (1. - Tolerance::epsilon);
                curvature = 0.;
              }
          }

        if (is_first && weights.maxCoeff() > 0.)
          {
            const auto inverse_of_A = safe_inverse(problem.A);
            if (!inverse_of_A)
              return false;
            // The same part of all that A can spare, in proportion to the need.
            shift =
              first_share * largest_multiple(*inverse_of_A, weights) * weights;
          }
        auto inverse_of_rest = take_shift(S.trace(), problem.A, shift);
        if (!inverse_of_rest)
          return false;
        inverse.swap(*inverse_of_rest);
        // The convexity that a term has is what A has lost to the last digit,
        // so that the sum is the functional itself.
        envelopes.clear();
        for (unsigned int i = 0; i < n; ++i)
          {
            // What was taken, without the rounding of the difference.
            if (shift(i) > 0.)
              problem.f[i].convexity = S(i, i) - problem.A(i, i);
            envelopes.emplace_back(problem.f[i], node.lower(i), node.upper(i));
          }
        return true;
      }

      /// Shrinks the box to where points can have the best value; false if
      /// there is no such point.
      bool
      shrink(const LowerBound &lower_bound, const double best_value)
      {
        for (unsigned int i = 0; i < n; ++i)
          {
            // The hull of what the pieces leave: a hole inside would be lost,
            // which gives a larger box and no wrong one.
            Interval left = {1., -1.};
            for (unsigned int k = 0; k < problem.f[i].pieces.size(); ++k)
              left = hull(left,
                          lower_bound.growth(i, k, inverse(i, i))
                            .where_at_most(best_value,
                                           box(i, problem.f[i].pieces[k])));
            node.lower(i) = left.lower;
            node.upper(i) = left.upper;
            if (left.is_empty())
              return false;
          }
        return true;
      }

      /// The convexity that the next relaxation moves.
      void
      raise(const double left)
      {
        // The derivative of the bound by the convexity of each term.
        Eigen::VectorXd v(n);
        for (unsigned int i = 0; i < n; ++i)
          v(i) = 0.5 * envelopes[i].spread(node.x(i));
        raise_bound(inverse, v, barrier * left / n, undecided(), node.shift);
      }

      void
      choose(const LowerBound &lower_bound, NodeResult &result) const
      {
        // The unknown whose halves both have high bounds, of the lower one
        // first, and whose envelope is far below its term: splitting there
        // raises the bound of the node most.
        double highest = -infinity;
        for (const unsigned int i : undecided())
          {
            const double          split = place_to_split(i);
            std::array<double, 2> halves;
            halves.fill(infinity);
            // Bounds of the halves by what s_i has to be there, from this
            // relaxation: no new one is made for a choice.
            for (unsigned int k = 0; k < problem.f[i].pieces.size(); ++k)
              for (const unsigned int half : {0, 1})
                halves[half] =
                  std::min(halves[half],
                           lower_bound.growth(i, k, inverse(i, i))
                             .least(
                               intersection(box(i, problem.f[i].pieces[k]),
                                            half == 0 ?
                                              Interval{split, node.upper(i)} :
                                              Interval{node.lower(i), split})));
            const double score =
              std::min(halves[0], halves[1]) +
              envelope_weight *
                (problem.f[i].value(node.x(i)) - envelopes[i].value(node.x(i)));
            if (score > highest)
              {
                highest            = score;
                result.unknown     = i;
                result.split       = split;
                result.half_bounds = halves;
              }
          }
      }

      /// At the kink under a line of the envelope that is nearest to the
      /// minimum of the relaxation the gap of the envelope is largest. Under a
      /// line without a kink f is concave.
      double
      place_to_split(const unsigned int i) const
      {
        const double                x       = node.x(i);
        const double                nowhere = infinity;
        double                      split   = nowhere;
        const ConvexEnvelope::Part *longest = nullptr;
        // Kinks under any line of the envelope count, even if x is on another
        // part.
        for (const ConvexEnvelope::Part &part : envelopes[i].parts)
          if (part.is_line)
            {
              for (const PiecewiseEnergy::Piece &piece : problem.f[i].pieces)
                if (part.lower < piece.upper && piece.upper < part.upper &&
                    std::abs(x - piece.upper) < std::abs(x - split))
                  split = piece.upper;
              if (longest == nullptr ||
                  part.upper - part.lower > longest->upper - longest->lower)
                longest = &part;
            }
        if (split != nowhere)
          return split;
        const ConvexEnvelope::Part *const at_x = envelopes[i].line_at(x);
        const ConvexEnvelope::Part &line   = at_x != nullptr ? *at_x : *longest;
        const double                middle = 0.5 * (line.lower + line.upper);
        return at_x != nullptr ? 0.5 * (middle + x) : middle;
      }

      Interval
      box(const unsigned int i, const PiecewiseEnergy::Piece &piece) const
      {
        return {std::max(node.lower(i), piece.lower),
                std::min(node.upper(i), piece.upper)};
      }
    };
  } // namespace



  std::optional<ProofNode>
  NodeBound::root(const double best_value) const
  {
    // Without Phi, which is not negative, the functional is a parabola with its
    // minimum at s_0 = S^{-1} g and the value -1/2 g's_0 there. Points with at
    // most the best value are within the energy distance (2 (best + 1/2
    // g's_0))^{1/2} of s_0, and s_i by that times ((S^-1)_ii)^{1/2}, which
    // makes the box.
    const auto inverse = safe_inverse(S);
    if (!inverse)
      return {};
    const Eigen::VectorXd s_0 = *inverse * g;

    // The bound of the box is that of LowerBound, with the term zero for Phi.
    const PiecewiseEnergy zero        = PiecewiseEnergy::zero();
    BoxProblem            without_phi = {S,
                                         g,
                                         std::vector<ShiftedEnergy>(n, {0., {zero[0]}}),
                                         Eigen::VectorXd(),
                                         upper};
    // The square of the distance; the box is a little larger.
    const double distance = 2. * (best_value + 0.5 * g.dot(s_0));
    without_phi.lower =
      (s_0 - (distance * inverse->diagonal()).cwiseMax(0.).cwiseSqrt() *
               (1. + Tolerance::outwards))
        .cwiseMin(upper);
    without_phi.lower -= Tolerance::outwards * without_phi.lower.cwiseAbs();

    ProofNode node;
    node.number = 0;
    node.lower  = without_phi.lower;
    node.upper  = without_phi.upper;
    node.x      = s_0;
    node.shift  = Eigen::VectorXd::Zero(n);
    node.bound  = LowerBound(without_phi, s_0).value;
    if (!node.lower.allFinite())
      return {};
    return node;
  }



  ProofRound
  NodeBound::round_of_root(const ProofNode &root) const
  {
    // Without convexity of its own an unknown that nothing holds has no least
    // value on a half-line. What is taken from S for this has to change the
    // diagonal of its inverse, which makes the box, by less than what the box
    // is rounded outwards.
    const auto inverse = safe_inverse(S);
    double     largest = 0.;
    for (unsigned int i = 0; inverse && i < n; ++i)
      largest = std::max(largest,
                         inverse->col(i).cwiseAbs2().dot(S.diagonal()) /
                           (*inverse)(i, i));
    // A residual d of x costs d^2 / (2 D), which is much for the small D of a
    // matrix that is nearly singular: x has to be right to its last digit.
    using LongVector  = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
    Eigen::VectorXd x = root.x;
    for (unsigned int step = 0; inverse && step < refinements; ++step)
      {
        const LongVector rest =
          g.cast<long double>() - S.cast<long double>() * x.cast<long double>();
        x += *inverse * rest.cast<double>();
      }
    return {std::min(Tolerance::floor_at_point,
                     0.25 * Tolerance::outwards / largest) *
              S.diagonal(),
            x,
            {},
            -infinity,
            root.lower,
            root.upper};
  }



  ProofRound
  NodeBound::bound_at(const Eigen::VectorXd &s) const
  {
    ProofRound nothing;
    // With this convexity r_i s_i + f_i(s_i) is least where it is stationary.
    Eigen::MatrixXd            A = S;
    std::vector<ShiftedEnergy> f(n);
    for (unsigned int i = 0; i < n; ++i)
      {
        const PiecewiseEnergy &f_i       = phi.f[i];
        const double           convexity = f_i.needed_convexity(s(i));
        double                 largest   = 0.;
        for (unsigned int k = 0; k < f_i.size(); ++k)
          {
            f[i].pieces.push_back(f_i[k]);
            largest = std::max(largest, f_i[k].curvature);
          }
        // A little more than is needed, so that the minimum of the term is
        // isolated, and rounding finds no lower one elsewhere.
        A(i, i) -= (1. + Tolerance::excess_at_point) * convexity +
                   Tolerance::floor_at_point * std::min(largest, S(i, i));
        // What was taken, without the rounding of the difference.
        f[i].convexity = S(i, i) - A(i, i);
        if (!(A(i, i) > 0.))
          return nothing;
      }
    if (!is_safely_positive_definite(A))
      return nothing;
    return {
      S.diagonal() - A.diagonal(),
      s,
      {},
      LowerBound({A, g, f, Eigen::VectorXd::Constant(n, -infinity), upper}, s)
        .value};
  }



  NodeResult
  NodeBound::bound(ProofNode   &node,
                   const double best_value,
                   const double tolerance) const
  {
    return Relaxations(S, g, phi, node)
      .run(best_value, tolerance, node.number == 0 ? rounds_of_root : n_rounds);
  }



  std::vector<NodeBall>
  NodeBound::balls(const ProofNode &node) const
  {
    std::vector<NodeBall> result;
    // The shift that the node's bound was raised with gives a high value, that
    // of a first relaxation leaves a large A. Both balls hold.
    for (const bool is_first : {false, true})
      {
        ProofNode own = node;
        if (auto ball = Relaxations(S, g, phi, own).ball(is_first))
          result.push_back(std::move(*ball));
      }
    return result;
  }
} // namespace Debond
