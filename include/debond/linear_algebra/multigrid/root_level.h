// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_multigrid_root_level_h
#define debond_linear_algebra_multigrid_root_level_h

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi_noncontiguous_partitioner.h>

#include <debond/linear_algebra/multigrid/transfer.h>

#include <vector>

namespace Debond
{
  /**
   * The first coarser level where the finest one is shared by ranks: each rank
   * has the nodes that its fine ones depend on, and one of them, the root
   * (number 0), has all, and solves on them and on all coarser levels.
   */
  template <int dim>
  class RootLevel
  {
  public:
    /// A rank's nodes by ids, which are the same on all ranks and in the order
    /// of the numbers that nodes have on the root.
    struct Piece
    {
      std::vector<unsigned int> ids;
      std::vector<bool>         is_own;
    };

    /// @p all: the ids of all nodes, empty on ranks that are not the root.
    RootLevel(const Piece              &piece,
              std::vector<unsigned int> all,
              const MPI_Comm            communicator);

    bool
    is_root() const;

    unsigned int
    n_local_nodes() const;

    /// @p all, on the root, becomes what those have who own the nodes.
    template <typename Number>
    void
    gather(const std::vector<Number> &local, std::vector<Number> &all) const;

    /// @p local becomes what the root has.
    template <typename Number>
    void
    scatter(const std::vector<Number> &all, std::vector<Number> &local) const;

    /// The matrix of all own rows, on the root.
    BlockMatrix<dim, double>
    gather_rows(const BlockMatrix<dim, double> &local) const;

    /// A frame with the fine node that it is like, by its number in the whole.
    struct OriginatingFrame
    {
      NodeFrame<dim> frame;
      unsigned int   origin;
    };

    /// The frames of own nodes, for the root (@p all, by numbers there) and for
    /// each rank (@p local, of all its nodes).
    void
    share(const std::vector<OriginatingFrame> &own,
          std::vector<OriginatingFrame>       &local,
          std::vector<OriginatingFrame>       &all) const;

    /// The number of a rank's node on the root.
    unsigned int
    id(const unsigned int local_node) const;

    /// On the root.
    unsigned int
    node_of(const unsigned int id) const;

    bool
    is_own(const unsigned int local_node) const;

    MPI_Comm
    communicator() const;

  private:
    const Piece                                      piece;
    const std::vector<unsigned int>                  all_ids;
    const MPI_Comm                                   ranks;
    dealii::Utilities::MPI::NoncontiguousPartitioner to_root, from_root;
  };
} // namespace Debond

#endif
