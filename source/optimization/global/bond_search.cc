// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/global/bond_search.h>
#include <debond/optimization/majorise/condensed_problem.h>

#include <algorithm>
#include <numeric>

namespace Debond
{
  namespace
  {
    /// Of majorise-minimise, where the method's own was not reached: what
    /// rounding leaves of a body of 100 x 1 is about 1e-8.
    constexpr double second_tolerance = 1e-6;



    using BrokenNodes = std::vector<bool>;
    using NodeSet     = std::set<unsigned int>;



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



    struct Trial
    {
      BondMove move;
      NodeSet  broken, bonded; ///< nodes that change
    };



    class Moves
    {
    public:
      Moves(const BondSearchParameters &parameters, const NeighbourGraph &graph)
        : parameters(parameters)
        , graph(graph)
      {}

      std::vector<Trial>
      from(const BrokenNodes &is_broken) const
      {
        NodeSet broken, bonded;
        for (unsigned int i = 0; i < is_broken.size(); ++i)
          (is_broken[i] ? broken : bonded).insert(i);
        const std::vector<NodeSet> broken_patches =
          connected_parts(broken, graph);
        const std::vector<NodeSet> bonded_patches =
          connected_parts(bonded, graph);

        std::vector<Trial> trials;
        for (const NodeSet &patch : broken_patches)
          shift_edges(patch, broken, trials);
        if (parameters.flips)
          {
            for (const NodeSet &patch : bonded_patches)
              trials.push_back({BondMove::flip, patch, {}});
            for (const NodeSet &patch : broken_patches)
              trials.push_back({BondMove::flip, {}, patch});
          }
        if (parameters.splits)
          {
            for (const NodeSet &patch : bonded_patches)
              trials.push_back({BondMove::split, middle(patch, graph), {}});
            for (const NodeSet &patch : broken_patches)
              trials.push_back({BondMove::split, {}, middle(patch, graph)});
          }
        return trials;
      }

    private:
      const BondSearchParameters &parameters;
      const NeighbourGraph       &graph;

      void
      shift_edges(const NodeSet      &patch,
                  const NodeSet      &broken,
                  std::vector<Trial> &trials) const
      {
        for (const NodeSet &edge :
             connected_parts(neighbours_of(patch, graph), graph))
          {
            NodeSet outer = edge, inner = edge;
            Trial   out = {BondMove::shift, {}, {}},
                  in    = {BondMove::shift, {}, {}};
            for (unsigned int k = 0; k < parameters.maximum_shift; ++k)
              {
                NodeSet next_outer, next_inner;
                for (const unsigned int i : outer)
                  if (broken.count(i) == 0)
                    out.broken.insert(i);
                for (const unsigned int i : neighbours_of(outer, graph))
                  if (broken.count(i) == 0 && out.broken.count(i) == 0)
                    next_outer.insert(i);
                for (const unsigned int i : neighbours_of(inner, graph))
                  if (patch.count(i) > 0 && in.bonded.count(i) == 0)
                    next_inner.insert(i);
                in.bonded.insert(next_inner.begin(), next_inner.end());
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



    class StateSearch
    {
    public:
      StateSearch(const dealii::FullMatrix<double> &S,
                  const dealii::Vector<double>     &g,
                  const PiecewiseQuadratic         &phi,
                  const double                      threshold,
                  const MajoriseMinimise           &method,
                  const BondSearchParameters       &parameters,
                  dealii::Vector<double>           &s)
        : S(S)
        , g(g)
        , phi(phi)
        , threshold(threshold)
        , method(method)
        , parameters(parameters)
        , s(s)
      {
        const auto state  = CondensedProblem(S, g, phi, s).evaluate();
        given_functional  = state.functional;
        result.functional = state.functional;
        rounding          = state.functional_rounding;
        tried.insert(broken_nodes(s));
      }

      BrokenNodes
      broken_nodes(const dealii::Vector<double> &point) const
      {
        BrokenNodes broken(point.size());
        for (unsigned int i = 0; i < point.size(); ++i)
          broken[i] = point(i) < -threshold;
        return broken;
      }

      /// Minimises from the changed state. Returns whether the functional is
      /// below that of @p point, which then moves.
      bool
      attempt(const Trial &trial, dealii::Vector<double> &point)
      {
        // Beside a clamped side quadrature points move less than the node, so
        // that bonds hold there beyond -M. Only their branches matter.
        const bool from_all_broken =
          trial.move == BondMove::start && !trial.broken.empty();
        const double           depth = from_all_broken ? 1e3 : 2.;
        dealii::Vector<double> next  = point;
        for (const unsigned int i : trial.broken)
          next(i) = std::min(next(i), -depth * threshold);
        for (const unsigned int i : trial.bonded)
          if (next(i) < -threshold)
            next(i) = -0.5 * threshold;
        const bool is_known = !tried.insert(broken_nodes(next)).second;
        if (is_known && !from_all_broken)
          return false;

        ++result.trials[static_cast<unsigned int>(trial.move)];
        const BrokenNodes start = broken_nodes(next);
        // The nodes in contact will mostly be the same.
        ActiveSet active(point.size());
        for (unsigned int i = 0; i < point.size(); ++i)
          active[i] = point(i) == 0.;
        CondensedProblem             problem(S, g, phi, next, active);
        const MajoriseMinimiseResult minimum = minimise_trial(method, problem);
        if (minimum.status != SolverStatus::success)
          {
            ++result.failures;
            return false;
          }
        // What led to another known state leads nowhere new.
        const BrokenNodes end    = broken_nodes(next);
        const bool        is_new = end == start || tried.insert(end).second;
        if (trial.move == BondMove::start ?
              !is_new :
              minimum.functional >= functional - rounding)
          return false;
        point      = next;
        functional = minimum.functional;
        if (functional < result.functional - rounding)
          {
            ++result.improvements[static_cast<unsigned int>(trial.move)];
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
      may_go_on(const std::function<bool()> &monitor)
      {
        result.complete =
          result.complete &&
          std::accumulate(result.trials.begin(), result.trials.end(), 0u) <
            parameters.maximum_trials &&
          (!monitor || monitor());
        return result.complete;
      }

      BondSearchResult result;

    private:
      const dealii::FullMatrix<double> &S;
      const dealii::Vector<double>     &g;
      const PiecewiseQuadratic         &phi;
      const double                      threshold;
      const MajoriseMinimise           &method;
      const BondSearchParameters       &parameters;
      dealii::Vector<double>           &s;
      double                            given_functional;
      double                            functional; ///< where moves start
      double                            rounding;
      std::set<BrokenNodes>             tried;
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



  BondSearchResult
  search_bonds(const dealii::FullMatrix<double> &S,
               const dealii::Vector<double>     &g,
               const PiecewiseQuadratic         &phi,
               const double                      threshold,
               const NeighbourGraph             &neighbours,
               const MajoriseMinimise           &method,
               const BondSearchParameters       &parameters,
               dealii::Vector<double>           &s,
               const std::function<bool()>      &monitor)
  {
    StateSearch search(S, g, phi, threshold, method, parameters, s);
    const Moves moves(parameters, neighbours);
    const auto  descend = [&](dealii::Vector<double> point) {
      bool fell = true;
      while (fell)
        {
          fell = false;
          for (const Trial &trial : moves.from(search.broken_nodes(point)))
            {
              if (!search.may_go_on(monitor))
                return;
              fell = search.attempt(trial, point);
              if (fell)
                break;
            }
        }
    };

    const dealii::Vector<double> given = s;
    if (parameters.starts)
      {
        NodeSet all;
        for (unsigned int i = 0; i < s.size(); ++i)
          all.insert(all.end(), i);
        for (const Trial &trial :
             {Trial{BondMove::start, all, {}}, Trial{BondMove::start, {}, all}})
          {
            dealii::Vector<double> point = given;
            if (search.may_go_on(monitor) && search.attempt(trial, point))
              descend(point);
          }
      }
    search.restart();
    descend(given);
    return search.result;
  }
} // namespace Debond
