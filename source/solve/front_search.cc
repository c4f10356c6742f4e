// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/contact/boundary_graph.h>
#include <debond/linear_algebra/condensation.h>
#include <debond/linear_algebra/window.h>
#include <debond/optimization/global/branch_search.h>
#include <debond/optimization/majorise/partial_function.h>
#include <debond/solve/front_search.h>
#include <debond/solve/which_minimum.h>

#include <map>
#include <numeric>

namespace Debond
{
  namespace
  {
    /// From the middle of a window to its rim, in elements; a factor of one
    /// takes hundredths to tenths of a second.
    constexpr unsigned int
    n_rings(const int dim)
    {
      return dim == 2 ? 16 : 4;
    }

    constexpr unsigned int most_windows = 300;



    /// Adds the nodes that are at most @p distance faces away.
    void
    add_nearby(const unsigned int      node,
               const unsigned int      distance,
               const NeighbourGraph   &graph,
               std::set<unsigned int> &nodes)
    {
      std::set<unsigned int> near = {node}, ring = {node};
      for (unsigned int k = 0; k < distance; ++k)
        {
          std::set<unsigned int> next;
          for (const unsigned int i : ring)
            for (const unsigned int j : graph[i])
              if (near.insert(j).second)
                next.insert(j);
          ring = std::move(next);
        }
      nodes.insert(near.begin(), near.end());
    }



    /// The nodes with a neighbour on a lower branch of the law.
    std::vector<unsigned int>
    front_nodes(const SeparableBranches &lumped,
                const NeighbourGraph    &graph,
                const VectorView        &s)
    {
      std::vector<unsigned int> result;
      for (unsigned int i = 0; i < s.size(); ++i)
        for (const unsigned int j : graph[i])
          if (lumped.f[j].index(s(j)) < lumped.f[i].index(s(i)))
            {
              result.push_back(i);
              break;
            }
      return result;
    }



    template <int dim>
    class FrontSearch
    {
    public:
      FrontSearch(const Scene<dim>            &scene,
                  const MajoriseMinimise      &method,
                  const std::function<bool()> &may_go_on,
                  DofVector                   &u)
        : scene(scene)
        , unknowns(scene.problem().unknowns())
        , method(method)
        , may_go_on(may_go_on)
        , u(u)
        , graph(neighbours(unknowns.contact().boundary()))
        , lumped(lumped_bonds(scene.law(), scene.adhesion()))
      {
        const auto &normals = unknowns.contact().normals();
        for (unsigned int i = 0; i < normals.size(); ++i)
          node_of[normals[i]] = i;
      }

      FrontSearchResult
      search()
      {
        std::set<unsigned int> covered;
        for (const unsigned int node :
             front_nodes(lumped, graph, unknowns.contact().trace(u)))
          if (covered.count(node) == 0)
            {
              if (result.windows == most_windows || !may_go_on())
                {
                  result.complete = false;
                  break;
                }
              add_nearby(node, n_rings(dim) / 2, graph, covered);
              search_window(unknowns.contact().normals()[node]);
            }
        return result;
      }

    private:
      void
      search_window(const unsigned int center)
      {
        const auto is_excluded = [this](const unsigned int i) {
          return unknowns.is_constrained(i);
        };
        const Window window(scene.problem().matrix(),
                            scene.problem().load(),
                            u,
                            center,
                            n_rings(dim),
                            is_excluded);

        // In the order of the nodes, which need not be that of the unknowns.
        std::map<unsigned int, unsigned int> normals;
        for (unsigned int k = 0; k < window.unknowns().size(); ++k)
          if (const auto found = node_of.find(window.unknowns()[k]);
              found != node_of.end())
            normals[found->second] = k;
        std::vector<unsigned int>            nodes, kept;
        std::map<unsigned int, unsigned int> local;
        std::vector<BranchMinimum>           f;
        for (const auto &[node, k] : normals)
          {
            local[node] = static_cast<unsigned int>(nodes.size());
            nodes.push_back(node);
            kept.push_back(k);
            f.push_back(lumped.f[node]);
          }
        NeighbourGraph local_graph(nodes.size());
        for (unsigned int i = 0; i < nodes.size(); ++i)
          for (const unsigned int j : graph[nodes[i]])
            if (const auto found = local.find(j); found != local.end())
              local_graph[i].insert(found->second);

        const Eigen::VectorXd s = unknowns.contact().trace(u);
        Eigen::VectorXd       part(nodes.size());
        for (unsigned int i = 0; i < nodes.size(); ++i)
          part(i) = s(nodes[i]);
        const Condensation condensed(window.matrix(),
                                     window.load(),
                                     kept,
                                     [](const unsigned int) { return false; });

        BranchSearchParameters moves;
        moves.starts        = false;
        moves.maximum_shift = n_rings(dim) / 4;
        moves.flips         = false;
        moves.splits        = false;
        const BranchSearchResult search =
          search_branches(condensed.schur_complement(),
                          condensed.load(),
                          PartialFunction(scene.adhesion(), s, nodes),
                          SeparableBranches(f),
                          local_graph,
                          method,
                          moves,
                          part,
                          may_go_on);
        const unsigned int improvements =
          std::accumulate(search.improvements.begin(),
                          search.improvements.end(),
                          0u);
        ++result.windows;
        result.trials +=
          std::accumulate(search.trials.begin(), search.trials.end(), 0u);
        result.improvements += improvements;
        result.failures += search.failures;
        result.complete = result.complete && search.complete;
        if (improvements == 0)
          return;
        const DofVector v = condensed.expand(part);
        for (unsigned int k = 0; k < v.size(); ++k)
          u(window.unknowns()[k]) = v(k);
      }

      const Scene<dim>                    &scene;
      const ElasticUnknowns<dim>          &unknowns;
      const MajoriseMinimise              &method;
      const std::function<bool()>         &may_go_on;
      DofVector                           &u;
      const NeighbourGraph                 graph;
      const SeparableBranches              lumped;
      std::map<unsigned int, unsigned int> node_of; ///< by the unknown s
      FrontSearchResult                    result;
    };
  } // namespace



  template <int dim>
  FrontSearchResult
  search_fronts(const Scene<dim>            &scene,
                const MajoriseMinimise      &method,
                const std::function<bool()> &may_go_on,
                DofVector                   &u)
  {
    return FrontSearch<dim>(scene, method, may_go_on, u).search();
  }



  template decltype(search_fronts<2>) search_fronts<2>;
  template decltype(search_fronts<3>) search_fronts<3>;
} // namespace Debond
