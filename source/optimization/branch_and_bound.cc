// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/optimization/branch_and_bound.h>
#include <debond/optimization/condensed_problem.h>
#include <debond/optimization/envelope_relaxation.h>
#include <debond/optimization/majorise_minimise.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

namespace Debond
{
  namespace
  {
    /// The part of the convexity of S that goes to the undecided bonds. What
    /// is left has to keep the intervals small.
    constexpr double convexity_share = 0.8;

    constexpr unsigned int power_iterations = 12;

    /// Relaxations of one node as long as bonds are being decided.
    constexpr unsigned int maximum_rounds = 5;

    /// Covers the rounding of distances and inverses.
    constexpr double safety = 1. + 1e-6;



    struct Node
    {
      double          bound;
      unsigned int    number;
      Eigen::VectorXd lower, upper;
      Eigen::VectorXd x; ///< where its relaxation starts

      bool
      operator<(const Node &other) const
      {
        return bound != other.bound ? bound < other.bound :
                                      number < other.number;
      }
    };



    enum class Bond
    {
      bonded,
      broken,
      undecided
    };



    /// A Cholesky factorisation that succeeds after this shift proves it
    /// (Rump, BIT 46, 2006).
    bool
    is_positive_definite(Eigen::MatrixXd A)
    {
      A.diagonal().array() -= (A.rows() + 3.) * 2. *
                              std::numeric_limits<double>::epsilon() *
                              A.diagonal().sum();
      return Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(A).info() ==
             Eigen::Success;
    }



    class ProofTree
    {
    public:
      ProofTree(const BranchAndBoundParameters   &parameters,
                const dealii::FullMatrix<double> &S,
                const dealii::Vector<double>     &g,
                const SeparableBonds             &bonds,
                const dealii::Vector<double>     &start);

      BranchAndBoundResult
      run(const BranchAndBound::Monitor &monitor);

    private:
      const BranchAndBoundParameters   &parameters;
      const dealii::FullMatrix<double> &S_matrix;
      const dealii::Vector<double>     &g_vector;
      const SeparableBonds             &bonds;
      const unsigned int                n;
      Eigen::MatrixXd                   S;
      Eigen::VectorXd                   g;

      dealii::Timer               timer;
      BranchAndBoundResult        result;
      std::set<Node>              open;
      std::set<std::vector<bool>> tried; ///< states that were minimised
      double                      least_left_out;
      unsigned int                n_created = 0;

      /// A node's problem, and the diagonal of the inverse of its matrix.
      BoxProblem      problem;
      Eigen::VectorXd inverse_diagonal;

      Bond
      state(const Node &node, const unsigned int i) const
      {
        return node.lower(i) >= -bonds.threshold ? Bond::bonded :
               node.upper(i) <= -bonds.threshold ? Bond::broken :
                                                   Bond::undecided;
      }

      bool
      root(Node &node) const;

      void
      set_up(const Node &node);

      /// Replaces @p A and its inverse's diagonal by A minus a multiple of the
      /// undecided bonds' stiffness, which is returned.
      double
      move_convexity(const Node &node, Eigen::MatrixXd &A);

      void
      improve(const Eigen::VectorXd &x);

      /// Bounds, and shrinks, the node. Returns the bond to decide next, or
      /// nothing if it is left out.
      std::optional<unsigned int>
      bound(Node &node, std::array<double, 2> &half_bounds);

      /// Returns false if no point of the node is below the best one.
      bool
      shrink(Node &node, const LowerBound &lower_bound, bool &worth_it) const;

      double
      half_bound(const Node        &node,
                 const LowerBound  &lower_bound,
                 const unsigned int i,
                 const Bond         half) const;

      ProofProgress
      progress() const;
    };



    ProofTree::ProofTree(const BranchAndBoundParameters   &parameters,
                         const dealii::FullMatrix<double> &S_matrix,
                         const dealii::Vector<double>     &g_vector,
                         const SeparableBonds             &bonds,
                         const dealii::Vector<double>     &start)
      : parameters(parameters)
      , S_matrix(S_matrix)
      , g_vector(g_vector)
      , bonds(bonds)
      , n(g_vector.size())
      , S(Eigen::Map<const Eigen::MatrixXd>(n > 0 ? &S_matrix(0, 0) : nullptr,
                                            n,
                                            n))
      , g(Eigen::Map<const Eigen::VectorXd>(g_vector.begin(), n))
      , least_left_out(std::numeric_limits<double>::infinity())
    {
      result.upper = std::numeric_limits<double>::infinity();
      result.lower = -std::numeric_limits<double>::infinity();
      improve(Eigen::Map<const Eigen::VectorXd>(start.begin(), n));
    }



    /// Majorise-minimise from the point, unless its state was tried.
    void
    ProofTree::improve(const Eigen::VectorXd &x)
    {
      std::vector<bool> broken(n);
      for (unsigned int i = 0; i < n; ++i)
        broken[i] = x(i) < -bonds.threshold;
      if (!tried.insert(broken).second)
        return;
      dealii::Vector<double> s(n);
      for (unsigned int i = 0; i < n; ++i)
        s(i) = std::min(x(i), 0.);
      CondensedProblem problem_at_s(S_matrix, g_vector, bonds, s);
      MajoriseMinimise({}).minimize(problem_at_s);
      const double value = problem_at_s.evaluate().functional;
      if (value < result.upper)
        {
          result.upper = value;
          result.s     = s;
        }
    }



    bool
    ProofTree::root(Node &node) const
    {
      const Eigen::LLT<Eigen::MatrixXd> factor(S);
      if (factor.info() != Eigen::Success)
        return false;
      const Eigen::MatrixXd inverse =
        factor.solve(Eigen::MatrixXd::Identity(n, n));
      const Eigen::VectorXd s_0 = factor.solve(g);
      const double distance = safety * 2. * (result.upper + 0.5 * g.dot(s_0));
      node.number           = 0;
      node.bound            = -std::numeric_limits<double>::infinity();
      node.upper            = Eigen::VectorXd::Zero(n);
      node.lower =
        (s_0 - (distance * inverse.diagonal()).cwiseMax(0.).cwiseSqrt())
          .cwiseMin(0.);
      node.lower -= 1e-6 * node.lower.cwiseAbs();
      node.x = s_0;
      return is_positive_definite(S) && node.lower.allFinite();
    }



    double
    ProofTree::move_convexity(const Node &node, Eigen::MatrixXd &A)
    {
      const Eigen::MatrixXd inverse =
        Eigen::LLT<Eigen::MatrixXd>(A).solve(Eigen::MatrixXd::Identity(n, n));
      inverse_diagonal = inverse.diagonal();

      Eigen::VectorXd root = Eigen::VectorXd::Zero(n);
      for (unsigned int i = 0; i < n; ++i)
        if (state(node, i) == Bond::undecided)
          root(i) = std::sqrt(bonds.stiffness(i));
      Eigen::VectorXd v      = root;
      double          lambda = 0.;
      for (unsigned int k = 0; k < power_iterations && v.norm() > 0.; ++k)
        {
          v.normalize();
          v      = root.cwiseProduct(inverse * root.cwiseProduct(v));
          lambda = v.norm();
        }
      if (lambda == 0.)
        return 0.;
      for (double share = convexity_share / lambda; share > 1e-3 / lambda;
           share *= 0.7)
        {
          Eigen::MatrixXd rest = A;
          rest.diagonal() -= share * root.cwiseAbs2();
          if (!is_positive_definite(rest))
            continue;
          A                = rest;
          inverse_diagonal = Eigen::LLT<Eigen::MatrixXd>(A)
                               .solve(Eigen::MatrixXd::Identity(n, n))
                               .diagonal();
          return share;
        }
      return 0.;
    }



    void
    ProofTree::set_up(const Node &node)
    {
      problem.A     = S;
      problem.g     = g;
      problem.lower = node.lower;
      problem.upper = node.upper;
      problem.f.resize(n);
      for (unsigned int i = 0; i < n; ++i)
        {
          const bool bonded = state(node, i) == Bond::bonded;
          if (bonded)
            problem.A(i, i) += bonds.stiffness(i);
          problem.f[i] = {0.,
                          bonded ? 0. : bonds.stiffness(i),
                          bonds.threshold};
        }
      const double share = move_convexity(node, problem.A);
      for (unsigned int i = 0; i < n; ++i)
        if (state(node, i) == Bond::undecided)
          problem.f[i].convexity = share * bonds.stiffness(i);
    }



    double
    ProofTree::half_bound(const Node        &node,
                          const LowerBound  &lower_bound,
                          const unsigned int i,
                          const Bond         half) const
    {
      const double lower = half == Bond::bonded ?
                             std::max(node.lower(i), -bonds.threshold) :
                             node.lower(i);
      const double upper = half == Bond::broken ?
                             std::min(node.upper(i), -bonds.threshold) :
                             node.upper(i);
      const double distance =
        std::max({lower - node.x(i), node.x(i) - upper, 0.}) / safety;
      return lower_bound.value +
             (half == Bond::bonded ? lower_bound.bonded_excess(i) :
                                     lower_bound.broken_excess(i)) /
               safety +
             0.5 * distance * distance / (inverse_diagonal(i) * safety);
    }



    bool
    ProofTree::shrink(Node             &node,
                      const LowerBound &lower_bound,
                      bool             &worth_it) const
    {
      const double left = result.upper - lower_bound.value;
      for (unsigned int i = 0; i < n; ++i)
        {
          const double radius =
            safety * std::sqrt(2. * left * inverse_diagonal(i) * safety);
          const double width = node.upper(i) - node.lower(i);
          const Bond   old   = state(node, i);
          node.lower(i)      = std::max(node.lower(i), node.x(i) - radius);
          node.upper(i)      = std::min(node.upper(i), node.x(i) + radius);
          if (state(node, i) == Bond::undecided)
            {
              if (half_bound(node, lower_bound, i, Bond::bonded) > result.upper)
                node.upper(i) = std::min(node.upper(i), -bonds.threshold);
              if (half_bound(node, lower_bound, i, Bond::broken) > result.upper)
                node.lower(i) = std::max(node.lower(i), -bonds.threshold);
            }
          if (node.lower(i) > node.upper(i))
            return false;
          if (old == Bond::undecided &&
              (state(node, i) != old ||
               node.upper(i) - node.lower(i) < 0.8 * width))
            worth_it = true;
        }
      return true;
    }



    std::optional<unsigned int>
    ProofTree::bound(Node &node, std::array<double, 2> &half_bounds)
    {
      for (unsigned int round = 0;; ++round)
        {
          set_up(node);
          std::vector<ConvexEnvelope> envelopes;
          for (unsigned int i = 0; i < n; ++i)
            envelopes.emplace_back(problem.f[i], node.lower(i), node.upper(i));
          minimise_relaxation(problem, envelopes, node.x);
          const LowerBound lower_bound(problem, node.x);
          node.bound = std::max(node.bound, lower_bound.value);
          improve(node.x);
          if (node.bound >= result.upper - parameters.tolerance)
            {
              least_left_out = std::min(least_left_out, node.bound);
              return {};
            }

          bool worth_it = false;
          if (!shrink(node, lower_bound, worth_it))
            {
              least_left_out = std::min(least_left_out, result.upper);
              return {};
            }
          bool decided = true;
          for (unsigned int i = 0; i < n; ++i)
            decided = decided && state(node, i) != Bond::undecided;
          if (worth_it && (decided || round + 1 < maximum_rounds))
            continue;

          double                      largest = -1.;
          std::optional<unsigned int> choice;
          for (unsigned int i = 0; i < n; ++i)
            if (state(node, i) == Bond::undecided)
              {
                const double gap =
                  problem.f[i].value(node.x(i)) - envelopes[i].value(node.x(i));
                if (gap > largest)
                  {
                    largest = gap;
                    choice  = i;
                  }
              }
          if (choice)
            for (const Bond half : {Bond::bonded, Bond::broken})
              half_bounds[half == Bond::broken] =
                half_bound(node, lower_bound, *choice, half);
          else
            // All bonds are decided, and rounding is all that is left.
            least_left_out = std::min(least_left_out, node.bound);
          return choice;
        }
    }



    ProofProgress
    ProofTree::progress() const
    {
      double lower = std::min(result.upper, least_left_out);
      if (!open.empty())
        lower = std::min(lower, open.begin()->bound);
      return {result.nodes,
              static_cast<unsigned int>(open.size()),
              lower,
              result.upper,
              timer.wall_time()};
    }



    BranchAndBoundResult
    ProofTree::run(const BranchAndBound::Monitor &monitor)
    {
      Node first;
      if (!root(first))
        return result;
      open.insert(first);
      result.status            = ProofStatus::proved;
      unsigned int next_record = 1;
      while (!open.empty() && result.status == ProofStatus::proved)
        {
          Node node = open.extract(open.begin()).value();
          // Down from here.
          while (true)
            {
              if (node.bound >= result.upper - parameters.tolerance)
                {
                  least_left_out = std::min(least_left_out, node.bound);
                  break;
                }
              if (result.nodes >= parameters.maximum_nodes)
                result.status = ProofStatus::node_limit;
              else if (timer.wall_time() > parameters.maximum_seconds)
                result.status = ProofStatus::time_limit;
              if (result.status != ProofStatus::proved)
                {
                  open.insert(node);
                  break;
                }
              ++result.nodes;
              std::array<double, 2>             half_bounds;
              const std::optional<unsigned int> bond = bound(node, half_bounds);
              if (!bond)
                break;

              Node bonded = node, broken = node;
              bonded.number          = ++n_created;
              broken.number          = ++n_created;
              bonded.lower(*bond)    = -bonds.threshold;
              broken.upper(*bond)    = -bonds.threshold;
              bonded.bound           = std::max(node.bound, half_bounds[0]);
              broken.bound           = std::max(node.bound, half_bounds[1]);
              const bool down_bonded = bonded.bound < broken.bound;
              open.insert(down_bonded ? broken : bonded);
              node = down_bonded ? bonded : broken;

              if (result.nodes >= next_record)
                {
                  open.insert(node);
                  result.history.push_back(progress());
                  next_record = result.nodes + 1 + result.nodes / 10;
                  if (monitor && !monitor(result.history.back()))
                    {
                      result.status = ProofStatus::interrupted;
                      break;
                    }
                  open.erase(node);
                }
            }
        }
      const ProofProgress end = progress();
      if (result.status == ProofStatus::proved &&
          result.upper - end.lower > parameters.tolerance)
        result.status = ProofStatus::rounding;
      result.lower   = end.lower;
      result.seconds = end.seconds;
      result.history.push_back(end);
      return result;
    }
  } // namespace



  std::string
  to_string(const ProofStatus status)
  {
    switch (status)
      {
        case ProofStatus::proved:
          return "proved";
        case ProofStatus::node_limit:
          return "node limit";
        case ProofStatus::time_limit:
          return "time limit";
        case ProofStatus::interrupted:
          return "interrupted";
        case ProofStatus::rounding:
          return "tolerance too small";
        case ProofStatus::no_bound:
          return "no bound";
      }
    return "unknown";
  }



  BranchAndBound::BranchAndBound(
    const BranchAndBoundParameters &proof_parameters)
    : parameters(proof_parameters)
  {}



  BranchAndBoundResult
  BranchAndBound::minimize(const dealii::FullMatrix<double> &S,
                           const dealii::Vector<double>     &g,
                           const SeparableBonds             &bonds,
                           const dealii::Vector<double>     &start,
                           const Monitor                    &monitor) const
  {
    return ProofTree(parameters, S, g, bonds, start).run(monitor);
  }
} // namespace Debond
