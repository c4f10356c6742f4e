// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/elasticity/prolongations.h>

#include <boost/serialization/array.hpp>
#include <boost/serialization/utility.hpp>

#include <numeric>

namespace Debond
{
  namespace
  {
    /// The frame of a node whose unknowns are not Cartesian, or not free: x =
    /// to_unknowns u and u = to_cartesian x, where rows and columns of unknowns
    /// that are not free are zero.
    template <int dim>
    struct NodeFrame
    {
      dealii::Tensor<2, dim> to_unknowns = dealii::unit_symmetric_tensor<dim>();
      dealii::Tensor<2, dim> to_cartesian =
        dealii::unit_symmetric_tensor<dim>();
    };

    /// The frames by the numbers of the nodes.
    template <int dim>
    using NodeFrames = std::map<unsigned int, NodeFrame<dim>>;



    template <int dim>
    NodeFrames<dim>
    node_frames(const ElasticUnknowns<dim> &unknowns)
    {
      // Nodes whose unknowns are Cartesian and free are not listed, which are
      // nearly all. A constrained unknown has a zero row on the way from
      // displacements to unknowns and a zero column on the way back, so that
      // corrections leave it as it is.
      NodeFrames<dim> frames;
      for (const auto &row : unknowns.basis().rows(BasisStep::frames))
        frames[row.node] = {row.to_unknowns, row.to_nodal};
      for (const auto &line : unknowns.constraints().get_lines())
        {
          NodeFrame<dim>    &frame = frames[line.index / dim];
          const unsigned int c     = line.index % dim;
          for (unsigned int d = 0; d < dim; ++d)
            frame.to_unknowns[c][d] = frame.to_cartesian[d][c] = 0.;
        }
      return frames;
    }



    /// A coarse node is like the node with a frame that depends most on it, by
    /// at least one half: where meshes are nested, that is the same point. @p
    /// first_point: of the interpolation among the finer nodes.
    template <int dim>
    NodeFrames<dim>
    coarse_frames(const NodeFrames<dim> &fine,
                  const Interpolation   &interpolation,
                  const unsigned int     first_point,
                  const MPI_Comm         ranks)
    {
      // Each coarse node chooses the finer one, among those with a frame, whose
      // value depends on it most; equal weights are decided by the lower
      // number, so that the choice does not depend on the order in which ranks
      // offer theirs. If no finer node with a frame has a weight of at least
      // one half, the coarse node is Cartesian and free.
      using Choice = std::pair<float, unsigned int>;
      std::map<unsigned int, Choice> chosen;
      const auto offer = [&chosen](const unsigned int coarse,
                                   const Choice      &choice) {
        const auto [place, is_new] = chosen.emplace(coarse, choice);
        if (!is_new && (choice.first > place->second.first ||
                        (choice.first == place->second.first &&
                         choice.second < place->second.second)))
          place->second = choice;
      };
      constexpr float least_dependence = 0.5f;
      for (unsigned int i = 0; i < interpolation.n_points(); ++i)
        if (fine.count(first_point + i) > 0)
          for (std::size_t k = interpolation.starts[i];
               k < interpolation.starts[i + 1];
               ++k)
            if (interpolation.weights[k] >= least_dependence)
              offer(interpolation.nodes[k],
                    {interpolation.weights[k], first_point + i});
      for (const auto &of_rank :
           dealii::Utilities::MPI::all_gather(ranks, chosen))
        for (const auto &[coarse, choice] : of_rank)
          offer(coarse, choice);
      NodeFrames<dim> result;
      for (const auto &[coarse, choice] : chosen)
        result[coarse] = fine.at(choice.second);
      return result;
    }



    /// The rows of the unknowns of the finer nodes from @p first_point on.
    template <int dim>
    BlockRows<float>
    between_unknowns(const Interpolation   &interpolation,
                     const unsigned int     first_point,
                     const NodeFrames<dim> &fine,
                     const NodeFrames<dim> &coarse)
    {
      // A value at a fine node is u_i = sum_j w_ij u_j in Cartesian components.
      // In unknowns each block is x_i = to_unknowns_i (w_ij to_cartesian_j
      // x_j). The blocks are in single precision, as the cycle that uses them
      // is.
      const auto frame_of = [](const NodeFrames<dim> &frames,
                               const unsigned int     node) {
        const auto frame = frames.find(node);
        return frame == frames.end() ? nullptr : &frame->second;
      };
      BlockRows<float> result;
      result.height = result.width = dim;
      for (unsigned int i = 0; i < interpolation.n_points(); ++i)
        {
          const NodeFrame<dim> *const to = frame_of(fine, first_point + i);
          for (std::size_t k = interpolation.starts[i];
               k < interpolation.starts[i + 1];
               ++k)
            {
              const unsigned int          j    = interpolation.nodes[k];
              const NodeFrame<dim> *const from = frame_of(coarse, j);
              // From coarse to fine unknowns.
              dealii::Tensor<2, dim> map = dealii::unit_symmetric_tensor<dim>();
              if (to != nullptr)
                map = to->to_unknowns;
              if (from != nullptr)
                map = map * from->to_cartesian;
              // Both nodes have no free unknown in common; the block would only
              // cost memory.
              if (map.norm() == 0.)
                continue;
              result.columns.push_back(j);
              for (unsigned int c = 0; c < dim; ++c)
                for (unsigned int d = 0; d < dim; ++d)
                  result.values.push_back(
                    static_cast<float>(interpolation.weights[k] * map[c][d]));
            }
          result.end_row();
        }
      return result;
    }



    /// The nodes of a level, numbered so that those of ranks follow each other.
    struct Shares
    {
      unsigned int              begin, end; ///< of this rank
      std::vector<unsigned int> places;     ///< of all in their own order
    };



    /// Gives each of @p n coarse nodes to a rank that has one of the finer
    /// nodes that depend most on it, and renumbers them. @p rows: of own finer
    /// nodes.
    Shares
    share_out(const unsigned int n, Interpolation &rows, const MPI_Comm ranks)
    {
      // A coarse node goes to the rank of a finer node that depends on it most,
      // the first one of several ranks. So most of a rank's interpolation is
      // between its own nodes, and few values are exchanged. The maximum and
      // the minimum over ranks are the only communication, with one number for
      // each coarse node.
      const unsigned int n_ranks = number_of_ranks(ranks);
      const unsigned int rank    = rank_of_this(ranks);
      std::vector<float> here(n, 0.f), anywhere(n);
      for (std::size_t k = 0; k < rows.nodes.size(); ++k)
        here[rows.nodes[k]] = std::max(here[rows.nodes[k]], rows.weights[k]);
      dealii::Utilities::MPI::max(here, ranks, anywhere);
      std::vector<unsigned int> owners(n);
      for (unsigned int j = 0; j < n; ++j)
        owners[j] = here[j] == anywhere[j] ? rank : n_ranks;
      dealii::Utilities::MPI::min(owners, ranks, owners);

      Shares result;
      result.places.resize(n);
      std::iota(result.places.begin(), result.places.end(), 0U);
      // The numbers of the nodes follow the ranks, and on each rank the order
      // of the level, so that each rank has one range of numbers.
      std::stable_sort(result.places.begin(),
                       result.places.end(),
                       [&owners](const unsigned int a, const unsigned int b) {
                         return owners[a] < owners[b];
                       });
      std::vector<unsigned int> numbers(n);
      for (unsigned int k = 0; k < n; ++k)
        numbers[result.places[k]] = k;
      for (unsigned int &node : rows.nodes)
        node = numbers[node];
      const auto n_before = [&owners](const unsigned int k) {
        return static_cast<unsigned int>(
          std::count_if(owners.begin(), owners.end(), [k](const auto owner) {
            return owner < k;
          }));
      };
      result.begin = n_before(rank);
      result.end   = n_before(rank + 1);
      return result;
    }



    Interpolation
    own_rows(const Interpolation &whole, const Shares &points)
    {
      Interpolation result;
      result.n_nodes = whole.n_nodes;
      for (unsigned int k = points.begin; k < points.end; ++k)
        {
          const auto begin = whole.starts[points.places[k]],
                     end   = whole.starts[points.places[k] + 1];
          result.nodes.insert(result.nodes.end(),
                              whole.nodes.begin() + begin,
                              whole.nodes.begin() + end);
          result.weights.insert(result.weights.end(),
                                whole.weights.begin() + begin,
                                whole.weights.begin() + end);
          result.starts.push_back(result.nodes.size());
        }
      return result;
    }
  } // namespace



  template <int dim>
  std::vector<Prolongation>
  prolongations(const Body<dim> &body, const ElasticUnknowns<dim> &unknowns)
  {
    const auto             &dofs  = unknowns.dof_handler();
    const dealii::IndexSet &own   = dofs.locally_owned_dofs();
    const MPI_Comm          ranks = unknowns.communicator();
    Shares                  finer;
    finer.begin = own.n_elements() == 0 ? 0 : own.nth_index_in_set(0) / dim;
    finer.end   = finer.begin + own.n_elements() / dim;

    // The first interpolation is to the own nodes of each rank. The levels
    // themselves are computed on all ranks from the description of the body, so
    // that no mesh is communicated; of the rows between them each rank keeps
    // its own.
    const std::vector<dealii::Point<dim>> nodes = unknowns.node_positions();
    const std::vector<dealii::Point<dim>> points(nodes.begin() + finer.begin,
                                                 nodes.begin() + finer.end);

    std::vector<Prolongation> result;
    NodeFrames<dim>           fine = node_frames(unknowns);
    for (const CoarseLevel<dim> &level :
         body.coarse_levels(points, unknowns.degree() > 1))
      {
        // Of the first one there are only own rows.
        Interpolation rows =
          result.empty() ? level.to_finer : own_rows(level.to_finer, finer);
        // The order of the two calls matters: share_out() renumbers the columns
        // of `rows`, and the frames of the coarse nodes are found by their new
        // numbers. `fine` and `finer` then describe the level that was coarse.
        Shares coarser =
          share_out(static_cast<unsigned int>(level.vertices.size()),
                    rows,
                    ranks);
        NodeFrames<dim> coarse = coarse_frames(fine, rows, finer.begin, ranks);
        result.push_back({coarser.end - coarser.begin,
                          between_unknowns(rows, finer.begin, fine, coarse)});
        fine  = std::move(coarse);
        finer = std::move(coarser);
      }
    return result;
  }



  DEBOND_INSTANTIATE(prolongations);
} // namespace Debond
