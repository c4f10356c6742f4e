// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_shared_nodes_h
#define debond_linear_algebra_shared_nodes_h

#include <deal.II/base/partitioner.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <debond/linear_algebra/block_rows.h>

#include <map>
#include <memory>

namespace Debond
{
  /// For cycles, which are preconditioners.
  using SinglePrecisionVector =
    dealii::LinearAlgebra::distributed::Vector<float>;

  /**
   * The nodes of a level of multigrid, each with the same number of unknowns.
   * The own nodes of the ranks follow each other in the numbers of the whole.
   * Ghosts are nodes of other ranks that this rank needs. In local numbers own
   * nodes come first, then ghosts, both in the order of the whole.
   *
   * All ranks call set_ghosts(), append_rows_of_ghosts() and sum_of_ranks()
   * together.
   */
  class SharedNodes
  {
  public:
    SharedNodes(const unsigned int n_own,
                const unsigned int n_unknowns_of_node,
                const MPI_Comm     ranks);

    /// Makes ghosts of those among nodes of the whole that are not own ones.
    /// They may occur repeatedly.
    void
    set_ghosts(const std::vector<unsigned int> &nodes);

    unsigned int
    n_own() const
    {
      return end - begin;
    }

    /// With ghosts.
    unsigned int
    n_local() const
    {
      return n_own() + static_cast<unsigned int>(ghosts.size());
    }

    unsigned int
    n_global() const
    {
      return firsts.back();
    }

    unsigned int
    global(const unsigned int local) const
    {
      return local < n_own() ? begin + local : ghosts[local - n_own()];
    }

    /// Returns the local number of an own node or a ghost.
    unsigned int
    local(const unsigned int global) const;

    void
    to_local(NumberedRows &M) const;

    void
    to_global(NumberedRows &M) const;

    /// Zero, with room for ghosts.
    SinglePrecisionVector
    vector() const;

    /// Own rows followed by those of ghosts.
    void
    append_rows_of_ghosts(BlockRows<float> &rows) const;

    /// Own rows as sums of what all ranks have of them, all by numbers of the
    /// whole; with @p with_all those that no rank has, too, as a zero on the
    /// diagonal.
    NumberedRows
    sum_of_ranks(const NumberedRows &rows, const bool with_all) const;

    const MPI_Comm ranks;

  private:
    unsigned int
    owner(const unsigned int global) const;

    const unsigned int        n_unknowns_of_node;
    std::vector<unsigned int> firsts; ///< own nodes of each rank, and the end
    unsigned int              begin, end;
    std::vector<unsigned int> ghosts;
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner;
  };
} // namespace Debond

#endif
