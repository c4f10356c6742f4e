// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/linear_algebra/eigen_view.h>
#include <debond/optimization/global/convexity_shift.h>
#include <debond/optimization/global/node_bound.h>

#include <algorithm>
#include <limits>

namespace Debond
{
  namespace
  {
    /// The part of the convexity of S that goes to the undecided bonds in the
    /// first relaxation of a node. What is left has to shrink its box.
    constexpr double first_share = 0.5;

    /// What is refused is tried again with this part of it.
    constexpr double retreat = 0.7;

    /// Relaxations of a node, and of the first.
    constexpr unsigned int n_rounds      = 6;
    constexpr unsigned int n_root_rounds = 30;

    /// The parameter mu of raise_bound, as a part of what is left to prove per
    /// bond. Smaller ones leave too little to shrink the box.
    constexpr double barrier = 1.;

    /// How much the gap of a bond's envelope counts when a bond is chosen,
    /// beside the bound of the lower one of its halves.
    constexpr double envelope_weight = 0.3;

    /// What a certificate takes more than it needs, relative to that and to the
    /// stiffness of bond or body: a residual d of s then costs d^2 / (2 D).
    constexpr double certificate_excess = 1e-2;
    constexpr double certificate_floor  = 1e-8;



    enum class Bond
    {
      bonded,
      broken,
      undecided
    };

    Bond
    state(const ProofNode &node, const unsigned int i, const double threshold)
    {
      return node.lower(i) >= -threshold ? Bond::bonded :
             node.upper(i) <= -threshold ? Bond::broken :
                                           Bond::undecided;
    }



    /// The relaxations of one node.
    class Relaxations
    {
    public:
      Relaxations(const Eigen::MatrixXd &S,
                  const Eigen::VectorXd &g,
                  const SeparableBonds  &bonds,
                  ProofNode             &node)
        : S(S)
        , bonds(bonds)
        , n(static_cast<unsigned int>(g.size()))
        , node(node)
      {
        problem.g = g;
      }

      NodeResult
      run(const double       best_value,
          const double       tolerance,
          const unsigned int maximum_rounds);

    private:
      const Eigen::MatrixXd &S;
      const SeparableBonds  &bonds;
      const unsigned int     n;
      ProofNode             &node;

      BoxProblem                  problem;
      std::vector<ConvexEnvelope> envelopes;

      /// Of the problem's matrix.
      Eigen::MatrixXd inverse;

      std::vector<unsigned int>
      undecided() const;

      bool
      set_up(const bool is_first);

      bool
      shrink(const LowerBound &lower_bound, const double best_value);

      void
      raise(const double left);

      void
      choose(const LowerBound &lower_bound, NodeResult &result) const;

      Interval
      box(const unsigned int i, const Bond half) const;

      Growth
      growth(const LowerBound  &lower_bound,
             const unsigned int i,
             const Bond         half) const;
    };



    std::vector<unsigned int>
    Relaxations::undecided() const
    {
      std::vector<unsigned int> result;
      for (unsigned int i = 0; i < n; ++i)
        if (state(node, i, bonds.threshold) == Bond::undecided)
          result.push_back(i);
      return result;
    }



    /// Returns false if the problem is not safely convex without a shift.
    bool
    Relaxations::set_up(const bool is_first)
    {
      problem.A     = S;
      problem.lower = node.lower;
      problem.upper = node.upper;
      problem.f.resize(n);
      Eigen::VectorXd shift   = Eigen::VectorXd::Zero(n);
      Eigen::VectorXd weights = Eigen::VectorXd::Zero(n);
      for (unsigned int i = 0; i < n; ++i)
        {
          const Bond bond = state(node, i, bonds.threshold);
          // Rounded down, A gives a bound all the same.
          if (bond == Bond::bonded)
            problem.A(i, i) = (problem.A(i, i) + bonds.stiffness(i)) *
                              (1. - std::numeric_limits<double>::epsilon());
          problem.f[i] = {0.,
                          bond == Bond::bonded ? 0. : bonds.stiffness(i),
                          bonds.threshold};
          if (bond == Bond::undecided)
            {
              shift(i)   = node.shift(i);
              weights(i) = bonds.stiffness(i);
            }
        }

      if (is_first && weights.maxCoeff() > 0.)
        {
          const auto inverse_of_A = safe_inverse(problem.A);
          if (!inverse_of_A)
            return false;
          shift =
            first_share * largest_multiple(*inverse_of_A, weights) * weights;
        }
      while (true)
        {
          Eigen::MatrixXd rest = problem.A;
          rest.diagonal() -= shift;
          if (auto inverse_of_rest = safe_inverse(rest))
            {
              problem.A.swap(rest);
              inverse = *inverse_of_rest;
              break;
            }
          if (shift.isZero(0.))
            return false;
          shift *= retreat;
          if (shift.maxCoeff() <
              std::numeric_limits<double>::epsilon() * S.trace())
            shift.setZero();
        }
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



    Interval
    Relaxations::box(const unsigned int i, const Bond half) const
    {
      return {half == Bond::bonded ? std::max(node.lower(i), -bonds.threshold) :
                                     node.lower(i),
              half == Bond::broken ? std::min(node.upper(i), -bonds.threshold) :
                                     node.upper(i)};
    }



    Growth
    Relaxations::growth(const LowerBound  &lower_bound,
                        const unsigned int i,
                        const Bond         half) const
    {
      return half == Bond::bonded ?
               lower_bound.growth_if_bonded(i, inverse(i, i)) :
               lower_bound.growth_if_broken(i, inverse(i, i));
    }



    /// Shrinks the box to where points can have the best value; false if
    /// there is no such point.
    bool
    Relaxations::shrink(const LowerBound &lower_bound, const double best_value)
    {
      for (unsigned int i = 0; i < n; ++i)
        {
          Interval left = {1., -1.};
          for (const Bond half : {Bond::bonded, Bond::broken})
            left = hull(left,
                        growth(lower_bound, i, half)
                          .where_at_most(best_value, box(i, half)));
          if (left.is_empty())
            return false;
          node.lower(i) = left.lower;
          node.upper(i) = left.upper;
        }
      return true;
    }



    /// The convexity that the next relaxation moves.
    void
    Relaxations::raise(const double left)
    {
      Eigen::VectorXd v(n);
      for (unsigned int i = 0; i < n; ++i)
        v(i) = 0.5 * envelopes[i].spread(node.x(i));
      raise_bound(inverse, v, barrier * left / n, undecided(), node.shift);
    }



    void
    Relaxations::choose(const LowerBound &lower_bound, NodeResult &result) const
    {
      double highest = -std::numeric_limits<double>::infinity();
      for (const unsigned int i : undecided())
        {
          std::array<double, 2> halves;
          for (const Bond half : {Bond::bonded, Bond::broken})
            halves[half == Bond::broken] =
              growth(lower_bound, i, half).least(box(i, half));
          const double score =
            std::min(halves[0], halves[1]) +
            envelope_weight *
              (problem.f[i].value(node.x(i)) - envelopes[i].value(node.x(i)));
          if (score > highest)
            {
              highest            = score;
              result.bond        = i;
              result.half_bounds = halves;
            }
        }
    }



    NodeResult
    Relaxations::run(const double       best_value,
                     const double       tolerance,
                     const unsigned int maximum_rounds)
    {
      NodeResult result;
      for (unsigned int round = 0;; ++round)
        {
          const bool all_decided = undecided().empty();
          if (!set_up(round == 0))
            break;
          minimise_relaxation(problem, envelopes, node.x);
          const LowerBound lower_bound(problem, node.x);
          node.bound = std::max(node.bound, lower_bound.value);
          // With all bonds decided, rounding is all that is left.
          if (node.bound >= best_value - tolerance || all_decided)
            break;

          if (!shrink(lower_bound, best_value))
            {
              result.least = best_value;
              return result;
            }
          if (round > 0 || node.shift.isZero(0.))
            {
              for (unsigned int i = 0; i < n; ++i)
                node.shift(i) = problem.f[i].convexity;
              if (round > 0)
                raise(best_value - lower_bound.value);
            }
          if (round + 1 >= maximum_rounds)
            choose(lower_bound, result);
          if (result.bond)
            return result;
        }
      result.least = node.bound;
      return result;
    }
  } // namespace



  NodeBound::NodeBound(const dealii::FullMatrix<double> &S_matrix,
                       const dealii::Vector<double>     &g_vector,
                       const SeparableBonds             &bonds)
    : bonds(bonds)
    , n(g_vector.size())
    , S(eigen_view(S_matrix))
    , g(eigen_view(g_vector))
  {}



  std::optional<ProofNode>
  NodeBound::root(const double best_value) const
  {
    const auto inverse = safe_inverse(S);
    if (!inverse)
      return {};
    const Eigen::VectorXd s_0 = *inverse * g;

    BoxProblem no_bonds = {S,
                           g,
                           std::vector<BondEnergy>(n,
                                                   {0., 0., bonds.threshold}),
                           Eigen::VectorXd(),
                           Eigen::VectorXd::Zero(n)};
    // Within this distance of s_0 by the energy, and a little more.
    const double distance = 2. * (best_value + 0.5 * g.dot(s_0));
    no_bonds.lower =
      (s_0 -
       (distance * inverse->diagonal()).cwiseMax(0.).cwiseSqrt() * (1. + 1e-6))
        .cwiseMin(0.);
    no_bonds.lower -= 1e-6 * no_bonds.lower.cwiseAbs();

    ProofNode node;
    node.number = 0;
    node.lower  = no_bonds.lower;
    node.upper  = no_bonds.upper;
    node.x      = s_0;
    node.shift  = Eigen::VectorXd::Zero(n);
    node.bound  = LowerBound(no_bonds, s_0).value;
    if (!node.lower.allFinite())
      return {};
    return node;
  }



  double
  NodeBound::certificate(const Eigen::VectorXd &s) const
  {
    constexpr double nothing = -std::numeric_limits<double>::infinity();
    // Where the bonds are as in s, r_i s_i + f_i(s_i) is least at s if f_i has
    // at least this convexity.
    Eigen::MatrixXd         A = S;
    std::vector<BondEnergy> f(n);
    for (unsigned int i = 0; i < n; ++i)
      {
        const double M_2 = bonds.threshold * bonds.threshold;
        const double s_2 = s(i) * s(i);
        const double convexity =
          bonds.stiffness(i) * std::min(M_2, s_2) / std::abs(M_2 - s_2);
        A(i, i) -= (1. + certificate_excess) * convexity +
                   certificate_floor * std::min(bonds.stiffness(i), S(i, i));
        // What was taken, without the rounding of the difference.
        f[i] = {S(i, i) - A(i, i), bonds.stiffness(i), bonds.threshold};
        if (!(A(i, i) > 0.))
          return nothing;
      }
    if (!is_safely_positive_definite(A))
      return nothing;

    constexpr double      infinity = std::numeric_limits<double>::infinity();
    constexpr long double epsilon = std::numeric_limits<long double>::epsilon();
    long double           sum = 0., size = 0.;
    for (unsigned int i = 0; i < n; ++i)
      {
        long double product = 0., terms = std::abs(g(i));
        for (unsigned int j = 0; j < n; ++j)
          {
            const long double term = static_cast<long double>(A(j, i)) * s(j);
            product += term;
            terms += std::abs(term);
          }
        // Of all that r can be the largest gives the least value, as s_i <= 0.
        const long double r     = product - g(i) + (n + 16.L) * epsilon * terms;
        const long double least = f[i].least(r, -infinity, 0.);
        sum += least - 0.5L * s(i) * product;
        size += std::abs(s(i)) * terms + std::abs(least);
      }
    sum -= (n + 16.L) * epsilon * size;
    const double value = static_cast<double>(sum);
    return value - std::numeric_limits<double>::epsilon() * std::abs(value);
  }



  NodeResult
  NodeBound::bound(ProofNode   &node,
                   const double best_value,
                   const double tolerance) const
  {
    return Relaxations(S, g, bonds, node)
      .run(best_value, tolerance, node.number == 0 ? n_root_rounds : n_rounds);
  }
} // namespace Debond
