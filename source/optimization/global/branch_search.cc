// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/global/branch_search.h>
#include <debond/optimization/majorise/condensed_problem.h>

#include <algorithm>
#include <cmath>

namespace Debond
{
  namespace
  {
    /// Of majorise-minimise, where the method's own was not reached: what
    /// rounding leaves of a body of 100 x 1 is about 1e-8.
    constexpr double second_tolerance = 1e-6;



    /// Relative differences of majorants that are the same.
    constexpr double majorant_noise = 1e-12;



    using NodeSet = std::set<unsigned int>;



    /// The nodes that are neighbours of @p nodes, but not among them.
    NodeSet
    neighbours_of(const NodeSet &nodes, const NeighbourGraph &graph)
    {
      NodeSet result;
      for (const unsigned int i : nodes)
        for (const unsigned int j : graph[i])
          if (nodes.count(j) == 0)
            result.insert(j);
      return result;
    }



    /// The connected parts of @p nodes.
    std::vector<NodeSet>
    connected_parts(NodeSet nodes, const NeighbourGraph &graph)
    {
      std::vector<NodeSet> parts;
      while (!nodes.empty())
        {
          NodeSet                   part;
          std::vector<unsigned int> front = {*nodes.begin()};
          nodes.erase(nodes.begin());
          while (!front.empty())
            {
              const unsigned int i = front.back();
              front.pop_back();
              part.insert(i);
              for (const unsigned int j : graph[i])
                if (nodes.erase(j) > 0)
                  front.push_back(j);
            }
          parts.push_back(part);
        }
      return parts;
    }



    /// The nodes of @p nodes that are neighbours of others or of a side
    /// without nodes; all of them if there are no others.
    NodeSet
    rim(const NodeSet &nodes, const NeighbourGraph &graph)
    {
      NodeSet result;
      for (const unsigned int i : nodes)
        if (std::any_of(graph[i].begin(), graph[i].end(), [&](unsigned int j) {
              return nodes.count(j) == 0;
            }))
          result.insert(i);
      return result.empty() ? nodes : result;
    }



    /// The last that is left of @p nodes if its rim is taken off again and
    /// again; without a rim, the middle one by number.
    NodeSet
    middle(NodeSet nodes, const NeighbourGraph &graph)
    {
      while (true)
        {
          NodeSet inner = nodes;
          for (const unsigned int i : rim(nodes, graph))
            inner.erase(i);
          if (inner.empty())
            return {*std::next(nodes.begin(), nodes.size() / 2)};
          nodes = inner;
        }
    }



    /// Of the unknown that has most.
    unsigned int
    number_of_pieces(const SeparableBranches &lumped)
    {
      unsigned int n = 0;
      for (const BranchMinimum &f : lumped.f)
        n = std::max(n, f.size());
      return n;
    }



    /// States that are minimised, at most.
    constexpr unsigned int maximum_trials = 100000;



    enum class Move
    {
      start, ///< of all nodes
      shift, ///< of the edge of a patch
      flip   ///< of a patch or its middle
    };

    /// Nodes that go to a piece or to the one above it.
    struct Trial
    {
      Move         move;
      unsigned int piece;
      NodeSet      down, up;
    };



    class Moves
    {
    public:
      Moves(const BranchSearchParameters &parameters,
            const NeighbourGraph         &graph)
        : parameters(parameters)
        , graph(graph)
      {}

      /// For each kink, between the nodes below it and those above.
      std::vector<Trial>
      from(const BranchState &state, const unsigned int n_pieces) const
      {
        std::vector<Trial> trials;
        for (unsigned int piece = 1; piece < n_pieces; ++piece)
          {
            NodeSet below, above;
            for (unsigned int i = 0; i < state.size(); ++i)
              (state[i] >= piece ? below : above).insert(i);
            const std::vector<NodeSet> lower_patches =
              connected_parts(below, graph);
            const std::vector<NodeSet> upper_patches =
              connected_parts(above, graph);

            for (const NodeSet &patch : lower_patches)
              shift_edges(patch, piece, below, trials);
            if (!parameters.flips)
              continue;
            for (const NodeSet &patch : upper_patches)
              trials.push_back({Move::flip, piece, patch, {}});
            for (const NodeSet &patch : lower_patches)
              trials.push_back({Move::flip, piece, {}, patch});
            for (const NodeSet &patch : upper_patches)
              trials.push_back({Move::flip, piece, middle(patch, graph), {}});
            for (const NodeSet &patch : lower_patches)
              trials.push_back({Move::flip, piece, {}, middle(patch, graph)});
          }
        return trials;
      }

    private:
      const BranchSearchParameters &parameters;
      const NeighbourGraph         &graph;

      void
      shift_edges(const NodeSet      &patch,
                  const unsigned int  piece,
                  const NodeSet      &below,
                  std::vector<Trial> &trials) const
      {
        for (const NodeSet &edge :
             connected_parts(neighbours_of(patch, graph), graph))
          {
            NodeSet outer = edge, inner = edge;
            Trial   out = {Move::shift, piece, {}, {}},
                  in    = {Move::shift, piece, {}, {}};
            for (unsigned int k = 0; k < parameters.maximum_shift; ++k)
              {
                NodeSet next_outer, next_inner;
                for (const unsigned int i : outer)
                  if (below.count(i) == 0)
                    out.down.insert(i);
                for (const unsigned int i : neighbours_of(outer, graph))
                  if (below.count(i) == 0 && out.down.count(i) == 0)
                    next_outer.insert(i);
                for (const unsigned int i : neighbours_of(inner, graph))
                  if (patch.count(i) > 0 && in.up.count(i) == 0)
                    next_inner.insert(i);
                in.up.insert(next_inner.begin(), next_inner.end());
                if (!outer.empty())
                  trials.push_back(out);
                if (!next_inner.empty())
                  trials.push_back(in);
                outer = next_outer;
                inner = next_inner;
              }
          }
      }
    };



    /// Of a minimum: 1/2 s'(S + E)s - r's + const, of which it is the minimum.
    struct KnownMajorant
    {
      Eigen::SparseMatrix<double> E;
      Eigen::VectorXd             r;
      double                      functional;
    };



    class StateSearch
    {
    public:
      StateSearch(const SearchProblem          &problem,
                  const BranchSearchParameters &parameters,
                  Eigen::VectorXd              &s)
        : problem(problem)
        , parameters(parameters)
        , s(s)
      {
        const auto state =
          CondensedProblem(problem.S, problem.g, problem.phi, s).evaluate();
        given_functional  = state.functional;
        result.functional = state.functional;
        rounding          = state.functional_rounding;
        tried.insert(state_of(s));
        if (problem.method.has_converged(state))
          known.push_back(majorant(s, state.functional));
      }

      BranchState
      state_of(const VectorView &point) const
      {
        BranchState state(point.size());
        for (unsigned int i = 0; i < point.size(); ++i)
          state[i] = problem.lumped.f[i].index(point(i));
        return state;
      }

      /// Minimises from the changed state. Returns whether the functional is
      /// below that of @p point, which then moves.
      bool
      attempt(const Trial &trial, Eigen::VectorXd &point)
      {
        const std::vector<BranchMinimum> &f = problem.lumped.f;
        // Beside a clamped side quadrature points move less than the node, so
        // that they are on the last branch only if the node is far below its
        // kink. Only their branches matter.
        const bool to_the_end =
          trial.move == Move::start && !trial.down.empty() &&
          trial.piece + 1 == number_of_pieces(problem.lumped);
        Eigen::VectorXd next = point;
        // Where there are no bonds no branch is to be left.
        for (const unsigned int i : trial.down)
          if (trial.piece < f[i].size())
            next(i) = std::min(next(i),
                               to_the_end ? 1e3 * f[i][trial.piece].upper :
                                            f[i].point_inside(trial.piece));
        for (const unsigned int i : trial.up)
          if (f[i].index(next(i)) >= trial.piece)
            next(i) = f[i].point_inside(trial.piece - 1);
        // Beside what holds a vertex off the foundation points are farther from
        // it than the node: its bonds hold from there only if it is closed.
        const bool from_contact =
          trial.move == Move::start && trial.down.empty() &&
          (problem.phi.curvature(Eigen::VectorXd::Zero(next.size())) -
           problem.phi.curvature(next))
              .norm() > 0.;
        if (from_contact)
          next.setZero();
        const bool is_known = !tried.insert(state_of(next)).second;
        if (is_known && !to_the_end && !from_contact)
          return false;

        ++result.trials;
        const BranchState start = state_of(next);
        CondensedProblem  condensed(problem.S, problem.g, problem.phi, next);
        if (trial.move != Move::shift)
          condensed.guess_by(problem.guess);
        bool                         ends_at_known = false;
        const MajoriseMinimiseResult minimum =
          minimise_trial(problem.method,
                         condensed,
                         [&](const MajoriseMinimiseIteration &) {
                           ends_at_known = leads_to_known(next, trial.move);
                           return !ends_at_known && problem.may_go_on();
                         });
        if (ends_at_known)
          return false;
        if (minimum.status != SolverStatus::success)
          {
            result.complete =
              result.complete && minimum.status != SolverStatus::interrupted;
            result.failures += minimum.status != SolverStatus::interrupted;
            return false;
          }
        known.push_back(majorant(next, minimum.functional));
        // Starts go on from wherever they lead to, but not from a state that
        // was tried, unless it is lower: nodes do not tell on which branches
        // the quadrature points between them are.
        const bool        is_start = trial.move == Move::start;
        const BranchState end      = state_of(next);
        const bool        is_new   = end == start || tried.insert(end).second;
        const double known_best    = is_start ? result.functional : functional;
        if (minimum.functional >= known_best - rounding &&
            !(is_start && is_new))
          return false;
        point      = next;
        functional = minimum.functional;
        if (functional < result.functional - rounding)
          {
            ++result.improvements;
            result.functional = functional;
            s                 = point;
          }
        return true;
      }

      /// Further moves start from the given point again.
      void
      restart()
      {
        functional = given_functional;
      }

      bool
      may_go_on()
      {
        result.complete = result.complete && result.trials < maximum_trials &&
                          problem.may_go_on();
        return result.complete;
      }

      BranchSearchResult result;

    private:
      KnownMajorant
      majorant(const VectorView &point, const double value) const
      {
        const Eigen::SparseMatrix<double> E = problem.phi.curvature(point);
        return {E,
                problem.g - problem.phi.subgradient(point) + E * point,
                value};
      }

      /// Whether the descent from @p point ends at a known minimum that is no
      /// better than where moves start.
      bool
      leads_to_known(const VectorView &point, const Move move) const
      {
        const KnownMajorant own = majorant(point, functional);
        return std::any_of(
          known.begin(), known.end(), [&](const KnownMajorant &other) {
            return (move == Move::start ||
                    other.functional >= functional - rounding) &&
                   (own.r - other.r).lpNorm<Eigen::Infinity>() <=
                     majorant_noise * own.r.lpNorm<Eigen::Infinity>() &&
                   (own.E - other.E).norm() <= majorant_noise * own.E.norm();
          });
      }

      const SearchProblem          &problem;
      const BranchSearchParameters &parameters;
      Eigen::VectorXd              &s;
      double                        given_functional;
      double                        functional; ///< where moves start
      double                        rounding;
      std::set<BranchState>         tried;
      std::vector<KnownMajorant>    known;
    };
  } // namespace



  MajoriseMinimiseResult
  minimise_trial(const MajoriseMinimise          &method,
                 MajorantProblem                 &problem,
                 const MajoriseMinimise::Monitor &monitor)
  {
    const MajoriseMinimiseResult result = method.minimize(problem, monitor);
    if (result.status == SolverStatus::success ||
        result.status == SolverStatus::interrupted)
      return result;
    MajoriseMinimiseParameters parameters;
    parameters.tolerance = second_tolerance;
    return MajoriseMinimise(parameters).minimize(problem, monitor);
  }



  BranchSearchResult
  search_branches(const SearchProblem          &problem,
                  const BranchSearchParameters &parameters,
                  Eigen::VectorXd              &s)
  {
    const unsigned int n_pieces = number_of_pieces(problem.lumped);
    StateSearch        search(problem, parameters, s);
    const Moves        moves(parameters, problem.neighbours);
    const auto         descend = [&](Eigen::VectorXd point) {
      bool fell = true;
      while (fell)
        {
          fell = false;
          for (const Trial &trial :
               moves.from(search.state_of(point), n_pieces))
            {
              if (!search.may_go_on())
                return;
              fell = search.attempt(trial, point);
              if (fell)
                break;
            }
        }
    };

    const Eigen::VectorXd given = s;
    if (parameters.starts)
      {
        NodeSet all;
        for (unsigned int i = 0; i < s.size(); ++i)
          all.insert(all.end(), i);
        std::vector<Trial> starts;
        for (unsigned int piece = n_pieces; piece-- > 1;)
          starts.push_back({Move::start, piece, all, {}});
        starts.push_back({Move::start, 1, {}, all});
        for (const Trial &trial : starts)
          {
            Eigen::VectorXd point = given;
            if (search.may_go_on() && search.attempt(trial, point))
              descend(point);
          }
      }
    search.restart();
    descend(given);
    return search.result;
  }



  namespace
  {
    /// A node takes about n^3 operations, of which this is a few seconds'
    /// worth.
    constexpr double       most_operations = 4e8;
    constexpr unsigned int most_nodes      = 500;

    /// With more unknowns a few relaxations take longer than the first search.
    constexpr unsigned int largest_first_look = 100;

    /// Each is begun because the one before found a lower point.
    constexpr unsigned int most_proofs = 4;



    /// For one problem.
    class GuidedSearch
    {
    public:
      GuidedSearch(const SearchProblem          &problem,
                   const bool                    is_separable,
                   const GuidedSearchParameters &parameters)
        : problem(problem)
        , is_separable(is_separable)
        , parameters(parameters)
      {}

      GuidedSearchResult
      run(const std::function<bool(bool)> &may_end, Eigen::VectorXd &s)
      {
        const bool has_tried = is_separable || parameters.proof_first;
        const bool looks_at_node =
          parameters.proof_first || s.size() <= largest_first_look;
        const Eigen::VectorXd given = s;
        if (has_tried && (is_proved(s,
                                    looks_at_node ? 1 : 0,
                                    /*only_while_halving=*/
                                    !parameters.proof_first) ||
                          (s != given && is_proved(s, 0))))
          return result;
        BranchSearchParameters quick;
        quick.maximum_shift = 1;
        quick.flips         = false;
        search(quick, s);
        const bool found = result.search.improvements > 0;
        // The same point has the same bounds.
        const bool is_same = has_tried && !found;
        if (!problem.may_go_on() || (!is_same && is_proved(s, 0)))
          return result;
        if ((may_end && may_end(found)) || !problem.may_go_on() ||
            (!(is_same && parameters.proof_first) && is_proved(s, 1)))
          return result;
        search({}, s);
        const double       n       = double(s.size());
        const unsigned int n_nodes = static_cast<unsigned int>(std::ceil(
          std::min(double(most_nodes), most_operations / (n * n * n))));
        // What the proof finds is where moves have not been tried from.
        for (unsigned int k = 0; k < most_proofs && problem.may_go_on(); ++k)
          {
            const Eigen::VectorXd searched = s;
            if (is_proved(s, n_nodes) || s == searched || !problem.may_go_on())
              break;
            search({}, s);
          }
        return result;
      }

    private:
      /// Adds what it did to the result.
      void
      search(const BranchSearchParameters &moves, Eigen::VectorXd &s)
      {
        const BranchSearchResult more = search_branches(problem, moves, s);
        BranchSearchResult      &sum  = result.search;
        sum.trials += more.trials;
        sum.improvements += more.improvements;
        sum.failures += more.failures;
        sum.complete   = sum.complete && more.complete;
        sum.functional = more.functional;
      }

      /// Branch and bound, and whether it ends with a proof. What it finds is
      /// taken if it is lower.
      bool
      is_proved(Eigen::VectorXd   &s,
                const unsigned int maximum_nodes,
                const bool         only_while_halving = false)
      {
        const double functional = condensed(s).evaluate().functional;
        BranchAndBoundParameters limits;
        limits.tolerance          = parameters.tolerance;
        limits.maximum_nodes      = maximum_nodes;
        limits.only_while_halving = only_while_halving;
        limits.n_threads          = parameters.n_threads;
        const BranchAndBoundResult proof =
          branch_and_bound(limits,
                           problem.S,
                           problem.g,
                           problem.lumped,
                           s,
                           [this](const ProofProgress &) {
                             return problem.may_go_on();
                           });
        if (is_separable)
          result.proof = proof;
        Eigen::VectorXd  other         = proof.s;
        CondensedProblem other_problem = condensed(other);
        if (!is_separable &&
            minimise_trial(problem.method, other_problem).status !=
              SolverStatus::success)
          {
            ++result.search.failures;
            return false;
          }
        const MajorantProblem::State state = other_problem.evaluate();
        if (state.functional < functional - state.functional_rounding)
          s = other;
        result.is_closed = proof.status == ProofStatus::proved;
        return result.is_closed;
      }

      CondensedProblem
      condensed(Eigen::VectorXd &s) const
      {
        return CondensedProblem(problem.S, problem.g, problem.phi, s);
      }

      const SearchProblem          &problem;
      const bool                    is_separable;
      const GuidedSearchParameters &parameters;
      GuidedSearchResult            result;
    };
  } // namespace



  SeparableBranches
  lumped_branches(const PiecewiseQuadratic  &phi,
                  const unsigned int         n,
                  const BranchMinimum       &branches,
                  const std::vector<double> &stretches)
  {
    const Eigen::VectorXd curvature =
      phi.curvature(Eigen::VectorXd::Zero(n)) * Eigen::VectorXd::Ones(n);
    std::vector<BranchMinimum> f;
    for (unsigned int i = 0; i < n; ++i)
      f.push_back(
        branches.with_first_curvature(curvature(i),
                                      stretches.empty() ? 1. : stretches[i]));
    return SeparableBranches(f);
  }



  GuidedSearchResult
  guided_search(const SearchProblem             &problem,
                const bool                       is_separable,
                const GuidedSearchParameters    &parameters,
                Eigen::VectorXd                 &s,
                const std::function<bool(bool)> &may_end)
  {
    return GuidedSearch(problem, is_separable, parameters).run(may_end, s);
  }
} // namespace Debond
