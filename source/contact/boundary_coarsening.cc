// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/contact/boundary_coarsening.h>
#include <debond/contact/boundary_graph.h>

#include <set>

namespace Debond
{
  namespace
  {
    template <int dim>
    struct NodeGraph
    {
      std::vector<dealii::Point<dim>>     positions;
      std::vector<std::set<unsigned int>> neighbours;
    };



    template <int dim>
    NodeGraph<dim>
    node_graph(const ContactBoundary<dim> &boundary)
    {
      NodeGraph<dim> graph;
      for (const auto &node : boundary.nodes)
        graph.positions.push_back(node.position);
      graph.neighbours = neighbours(boundary);
      return graph;
    }



    /// A maximal set of nodes without neighbours among them: the number of
    /// each in the set, or invalid_unsigned_int.
    template <int dim>
    std::vector<unsigned int>
    independent_set(const NodeGraph<dim> &graph)
    {
      std::vector<unsigned int> number(graph.positions.size(),
                                       dealii::numbers::invalid_unsigned_int);
      unsigned int              n_kept = 0;
      for (unsigned int i = 0; i < number.size(); ++i)
        {
          bool free = true;
          for (const unsigned int j : graph.neighbours[i])
            free = free && number[j] == dealii::numbers::invalid_unsigned_int;
          if (free)
            number[i] = n_kept++;
        }
      return number;
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
          if (number[i] != dealii::numbers::invalid_unsigned_int)
            {
              entries.emplace_back(i, number[i], 1.);
              continue;
            }
          double sum = 0.;
          for (const unsigned int j : graph.neighbours[i])
            if (number[j] != dealii::numbers::invalid_unsigned_int)
              sum += 1. / graph.positions[i].distance(graph.positions[j]);
          for (const unsigned int j : graph.neighbours[i])
            if (number[j] != dealii::numbers::invalid_unsigned_int)
              entries.emplace_back(i,
                                   number[j],
                                   1. / (sum * graph.positions[i].distance(
                                                 graph.positions[j])));
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
      constexpr unsigned int none = dealii::numbers::invalid_unsigned_int;
      NodeGraph<dim>         coarse;
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
    NodeGraph<dim>                           graph = node_graph(boundary);
    while (graph.positions.size() > coarsest)
      {
        const std::vector<unsigned int> number = independent_set(graph);
        unsigned int                    n_kept = 0;
        for (const unsigned int n : number)
          n_kept += n != dealii::numbers::invalid_unsigned_int;
        // Nodes without neighbours are all kept.
        if (n_kept == number.size())
          break;
        prolongations.push_back(prolongation(graph, number, n_kept));
        graph = coarse_graph(graph, number, n_kept);
      }
    return prolongations;
  }



  template decltype(coarsen<2>) coarsen<2>;
  template decltype(coarsen<3>) coarsen<3>;
} // namespace Debond
