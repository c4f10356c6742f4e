// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/contact/boundary_coarsening.h>
#include <debond/contact/boundary_graph.h>

namespace Debond
{
  namespace
  {
    constexpr unsigned int none = dealii::numbers::invalid_unsigned_int;

    template <int dim>
    struct NodeGraph
    {
      std::vector<dealii::Point<dim>>     positions;
      std::vector<std::set<unsigned int>> neighbours;
    };



    /// A maximal set of nodes without neighbours among them: the number of
    /// each in the set, or none. Returns how many there are.
    template <int dim>
    unsigned int
    independent_set(const NodeGraph<dim>      &graph,
                    std::vector<unsigned int> &number)
    {
      // In the order of the nodes, which is that of their positions: of an
      // interval every second node is kept. A node is kept if no earlier
      // neighbour is, so that each other node has one that is: the set is
      // maximal.
      unsigned int n_kept = 0;
      number.assign(graph.positions.size(), none);
      for (unsigned int i = 0; i < number.size(); ++i)
        if (std::all_of(graph.neighbours[i].begin(),
                        graph.neighbours[i].end(),
                        [&](const unsigned int j) {
                          return number[j] == none;
                        }))
          number[i] = n_kept++;
      return n_kept;
    }



    template <int dim>
    Eigen::SparseMatrix<double>
    prolongation(const NodeGraph<dim>            &graph,
                 const std::vector<unsigned int> &number,
                 const unsigned int               n_kept)
    {
      std::vector<Eigen::Triplet<double>> entries;
      for (unsigned int i = 0; i < number.size(); ++i)
        {
          if (number[i] != none)
            {
              entries.emplace_back(i, number[i], 1.);
              continue;
            }
          // A node that goes has a neighbour that is kept, as the set is
          // maximal. It is interpolated between these by the inverse of their
          // distances: in 2D linearly. Weights are not negative and sum to one,
          // so that constants are kept and s <= 0 on the coarse nodes gives P s
          // <= 0 on the fine ones: the coarse space needs bounds only.
          const auto closeness = [&](const unsigned int j) {
            return number[j] == none ?
                     0. :
                     1. / graph.positions[i].distance(graph.positions[j]);
          };
          double sum = 0.;
          for (const unsigned int j : graph.neighbours[i])
            sum += closeness(j);
          for (const unsigned int j : graph.neighbours[i])
            if (number[j] != none)
              entries.emplace_back(i, number[j], closeness(j) / sum);
        }
      Eigen::SparseMatrix<double> P(number.size(), n_kept);
      P.setFromTriplets(entries.begin(), entries.end());
      return P;
    }



    /// Kept nodes are neighbours if a node between them depends on both.
    template <int dim>
    NodeGraph<dim>
    coarse_graph(const NodeGraph<dim>            &graph,
                 const std::vector<unsigned int> &number,
                 const unsigned int               n_kept)
    {
      // On a line, where every second node goes, all that is between two kept
      // nodes is one node, and the coarse graph is a line again. In 3D kept
      // nodes may be further apart; they are then no neighbours, and the
      // coarsening ends earlier.
      NodeGraph<dim> coarse;
      coarse.neighbours.resize(n_kept);
      for (unsigned int i = 0; i < number.size(); ++i)
        if (number[i] != none)
          coarse.positions.push_back(graph.positions[i]);
        else
          for (const unsigned int j : graph.neighbours[i])
            for (const unsigned int k : graph.neighbours[i])
              if (j != k && number[j] != none && number[k] != none)
                coarse.neighbours[number[j]].insert(number[k]);
      return coarse;
    }
  } // namespace



  template <int dim>
  std::vector<Eigen::SparseMatrix<double>>
  coarsen(const ContactBoundary<dim> &boundary, const unsigned int coarsest)
  {
    std::vector<Eigen::SparseMatrix<double>> prolongations;
    std::vector<unsigned int>                number;
    NodeGraph<dim>                           graph = {{}, neighbours(boundary)};
    for (const auto &node : boundary.nodes)
      graph.positions.push_back(node.position);
    // On a line each level halves the number of nodes, so that there are about
    // as many levels as its binary logarithm, and all prolongations together
    // have a few entries a node.
    while (graph.positions.size() > coarsest)
      {
        // The set of each level is one on the graph of the level before, so
        // that meshes of any kind are coarsened.
        const unsigned int n_kept = independent_set(graph, number);
        // Nodes without neighbours are all kept.
        if (n_kept == number.size())
          break;
        prolongations.push_back(prolongation(graph, number, n_kept));
        graph = coarse_graph(graph, number, n_kept);
      }
    return prolongations;
  }



  DEBOND_INSTANTIATE(coarsen);
} // namespace Debond
