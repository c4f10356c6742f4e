// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_multigrid_transfer_h
#define debond_linear_algebra_multigrid_transfer_h

#include <debond/linear_algebra/multigrid/block_matrix.h>
#include <debond/linear_algebra/multigrid/interpolation.h>

#include <utility>
#include <vector>

namespace Debond
{
  /// A node whose unknowns are not Cartesian, or not free: x = to_unknowns u
  /// and u = to_cartesian x, where rows and columns of unknowns that are not
  /// free are zero.
  template <int dim>
  struct NodeFrame
  {
    unsigned int node;
    Block<dim>   to_unknowns;
    Block<dim>   to_cartesian;
  };

  /// In ascending order of the nodes.
  template <int dim>
  using NodeFrames = std::vector<NodeFrame<dim>>;



  /**
   * The prolongation P from a coarser level to the next finer one:
   * interpolation of the Cartesian components, between unknowns in the frames
   * of the nodes.
   */
  template <int dim>
  class Transfer
  {
  public:
    Transfer() = default;

    /// A coarse node is like the node with a frame that depends most on it, by
    /// at least one half: where meshes are nested, that is the same point.
    Transfer(Interpolation interpolation, const NodeFrames<dim> &frames);

    unsigned int
    n_fine_nodes() const;

    unsigned int
    n_coarse_nodes() const;

    const NodeFrames<dim> &
    coarse_frames() const;

    /// For each of coarse_frames() the fine node that it is like.
    const std::vector<unsigned int> &
    origins() const;

    /// Other frames of coarse nodes, where the fine nodes are not all. They
    /// have no origins() then.
    void
    set_coarse_frames(const NodeFrames<dim> &frames);

    /// fine += P coarse. @p coarse is left in Cartesian components.
    template <typename Number>
    void
    prolongate_add(Number *const fine, Number *const coarse) const;

    /// coarse = P' fine.
    template <typename Number>
    void
    restrict_to(Number *const coarse, const Number *const fine) const;

    /// Calls @p visit with row and entry of each entry of a column of P.
    template <typename Visitor>
    void
    visit_column(const unsigned int column, const Visitor &visit) const;

    /// P'A P for the symmetric A, of which rows may be empty; rows of nodes
    /// outside of the intervals [begin, end) are left empty.
    template <typename Matrix>
    BlockMatrix<dim, double>
    galerkin_product(
      const Matrix                                             &A,
      const std::vector<std::pair<unsigned int, unsigned int>> &ranges) const;

  private:
    Interpolation             rows;
    NodeFrames<dim>           fine, coarse;
    std::vector<unsigned int> origin_nodes;

    /// For each coarse node the fine ones that depend on it.
    Interpolation columns;
  };



  template <int dim>
  template <typename Visitor>
  void
  Transfer<dim>::visit_column(const unsigned int column,
                              const Visitor     &visit) const
  {
    const auto frame_of = [](const NodeFrames<dim> &frames,
                             const unsigned int     node) {
      const auto found =
        std::lower_bound(frames.begin(),
                         frames.end(),
                         node,
                         [](const NodeFrame<dim> &frame, const unsigned int i) {
                           return frame.node < i;
                         });
      return found != frames.end() && found->node == node ? &*found : nullptr;
    };
    const unsigned int          j = column / dim, e = column % dim;
    const NodeFrame<dim> *const from = frame_of(coarse, j);
    for (std::size_t m = columns.starts[j]; m < columns.starts[j + 1]; ++m)
      {
        const unsigned int          i  = columns.nodes[m];
        const NodeFrame<dim> *const to = frame_of(fine, i);
        for (unsigned int c = 0; c < dim; ++c)
          {
            double entry = 0.;
            for (unsigned int d = 0; d < dim; ++d)
              entry +=
                (to != nullptr ? to->to_unknowns[c * dim + d] : 1. * (c == d)) *
                (from != nullptr ? from->to_cartesian[d * dim + e] :
                                   1. * (d == e));
            visit(i * dim + c, columns.weights[m] * entry);
          }
      }
  }
} // namespace Debond

#endif
