// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_multigrid_shared_nodes_h
#define debond_linear_algebra_multigrid_shared_nodes_h

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi_noncontiguous_partitioner.h>

#include <array>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace Debond
{
  /**
   * Nodes with dim unknowns each, or those of them that a rank has: its own
   * ones, and ghosts, copies of others' next to them, all in the order of the
   * numbers that they have in the whole. Sums over all nodes are made slab by
   * slab, each of which is one rank's, and then over the slabs in their order:
   * they are the same to the last bit for any number of ranks.
   */
  class SharedNodes
  {
  public:
    /// What a rank has, in the order of the numbers.
    struct Piece
    {
      std::vector<unsigned int> numbers; ///< in the whole
      std::vector<bool>         is_own;
      MPI_Comm                  communicator;
    };

    /// All nodes of a whole on one process; @p slabs of each of them.
    SharedNodes(const unsigned int dim, std::vector<unsigned int> slabs);

    /// Those of a rank, of @p n_slabs in all. To be called by all ranks, and so
    /// are all functions that give the same result on all of them.
    SharedNodes(const unsigned int        dim,
                std::vector<unsigned int> slabs,
                const unsigned int        n_slabs,
                const Piece              &piece);

    unsigned int
    size() const;

    bool
    is_whole() const;

    /// In the whole.
    unsigned int
    number(const unsigned int node) const;

    /// That of the whole's @p number, dealii::numbers::invalid_unsigned_int if
    /// the rank does not have it.
    unsigned int
    node_of(const unsigned int number) const;

    bool
    is_own(const unsigned int node) const;

    /// The own nodes, as intervals [begin, end).
    const std::vector<std::pair<unsigned int, unsigned int>> &
    own_ranges() const;

    MPI_Comm
    communicator() const;

    /// Gives ghosts the values of those whose copies they are.
    template <typename Number>
    void
    update_ghosts(Number *const values) const;

    /// <a, b>.
    template <typename Number>
    double
    product(const Number *const a, const Number *const b) const;

    /// The largest size of an entry.
    double
    largest(const double *const a) const;

  private:
    /// The sum over all slabs.
    double
    sum() const;

    const unsigned int                                 dim;
    std::vector<unsigned int>                          slabs;
    mutable std::vector<double>                        sums; ///< of slabs
    std::vector<unsigned int>                          numbers;
    std::vector<std::pair<unsigned int, unsigned int>> ranges;
    MPI_Comm                                           ranks = MPI_COMM_NULL;
    std::unique_ptr<dealii::Utilities::MPI::NoncontiguousPartitioner> exchange;
  };



  template <typename Number>
  double
  SharedNodes::product(const Number *const a, const Number *const b) const
  {
    std::fill(sums.begin(), sums.end(), 0.);
    for (const auto &[begin, end] : ranges)
      for (unsigned int i = begin; i < end; ++i)
        {
          double of_node = 0.;
          for (std::size_t k = std::size_t(i) * dim; k < (i + 1ul) * dim; ++k)
            of_node += static_cast<double>(a[k]) * static_cast<double>(b[k]);
          sums[slabs[i]] += of_node;
        }
    return sum();
  }
} // namespace Debond

#endif
