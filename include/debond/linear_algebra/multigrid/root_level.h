// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_multigrid_root_level_h
#define debond_linear_algebra_multigrid_root_level_h

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi_noncontiguous_partitioner.h>

#include <debond/linear_algebra/multigrid/block_matrix.h>

#include <utility>
#include <vector>

namespace Debond
{
  /**
   * The first level that ranks do not share: each rank has the nodes that those
   * of the next finer level depend on, and one of them, the root (number 0),
   * has all, and solves on them and on all coarser levels.
   */
  template <int dim>
  class RootLevel
  {
  public:
    /// A rank's nodes, by their numbers on the root, ascending.
    struct Piece
    {
      std::vector<unsigned int> numbers;
      std::vector<bool>         is_own;
      unsigned int              n_whole; ///< of all nodes
    };

    /// To be called by all ranks, and so are the functions below.
    RootLevel(const Piece &piece, const MPI_Comm communicator);

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

    /// That of the number on the root, dealii::numbers::invalid_unsigned_int
    /// if the rank does not have it.
    unsigned int
    local_node(const unsigned int number) const;

    /// The number on the root of a rank's node.
    unsigned int
    number(const unsigned int local_node) const;

    bool
    is_own(const unsigned int local_node) const;

    /// Those that are the rank's own, as intervals [begin, end).
    const std::vector<std::pair<unsigned int, unsigned int>> &
    own_ranges() const;

  private:
    const Piece                                        piece;
    std::vector<std::pair<unsigned int, unsigned int>> ranges;
    const MPI_Comm                                     ranks;
    dealii::Utilities::MPI::NoncontiguousPartitioner   to_root, from_root;
  };
} // namespace Debond

#endif
