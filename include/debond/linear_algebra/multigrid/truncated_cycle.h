// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_multigrid_truncated_cycle_h
#define debond_linear_algebra_multigrid_truncated_cycle_h

#include <deal.II/lac/sparse_matrix.h>

#include <debond/linear_algebra/dof_vector.h>
#include <debond/linear_algebra/multigrid/cycle_level.h>
#include <debond/linear_algebra/multigrid/root_level.h>
#include <debond/linear_algebra/multigrid/shared_nodes.h>
#include <debond/linear_algebra/multigrid/shared_rows.h>
#include <debond/linear_algebra/multigrid/transfer.h>

#include <Eigen/SparseCore>

#include <memory>
#include <vector>

namespace Debond
{
  /**
   * One V-cycle for A + E with some unknowns held at zero, symmetric and
   * positive definite: a preconditioner for conjugate gradients that costs no
   * more steps than for A alone. E couples few unknowns.
   *
   * Coarser matrices are Galerkin products with the rows of the held unknowns
   * left out of the finest prolongation (truncation; Kornhuber, Krause, Comput.
   * Vis. Sci. 4, 2001; Graeser, Sack, Sander, 2009): they differ from those of
   * A only next to these unknowns and those of E, where they are made anew.
   * Levels are smoothed by CycleLevel, the coarsest matrix is factorised.
   * Numbers are in single precision, but for the products that make the
   * matrices.
   *
   * Where ranks share levels, all of them call what concerns these; the others
   * are the root's.
   */
  template <int dim>
  class TruncatedCycle
  {
  public:
    /// @p frames are those of the unknowns of A, @p interpolations those from
    /// each coarser level to the next finer one, finest first; @p nodes are
    /// those of the levels. Keeps references to A, nodes and @p root. Where
    /// ranks share nodes, interpolations are between those that the rank has,
    /// and the first level that is not shared is that of the root.
    TruncatedCycle(const dealii::SparseMatrix<double>     &A,
                   const NodeFrames<dim>                  &frames,
                   std::vector<Interpolation>              interpolations,
                   const std::vector<const SharedNodes *> &nodes,
                   const RootLevel<dim>                   *root = nullptr);

    TruncatedCycle(const TruncatedCycle &) = delete;

    ~TruncatedCycle();

    /// Those that the process has.
    unsigned int
    n_levels() const;

    /// How many of them ranks share.
    unsigned int
    n_shared_levels() const;

    /// From the level l + 1 to the level l.
    const Transfer<dim> &
    transfer(const unsigned int l) const;

    /// Of the nodes of the level l > 0 that the process has.
    const NodeFrames<dim> &
    frames(const unsigned int l) const;

    /// A node with a frame and the node of the next finer level that it is
    /// like, by their numbers in the whole.
    struct FramedNode
    {
      unsigned int number, origin;
    };

    /// All of the whole level l > 0, the first one that is not shared included.
    const std::vector<FramedNode> &
    framed_nodes(const unsigned int l) const;

    /// The Galerkin product of A on the level l > 0, nothing truncated.
    const BlockMatrix<dim, double> &
    matrix(const unsigned int l) const;

    /// From now on the cycle is that for the matrix of the given level, with @p
    /// held unknowns and E[i, j] added at the unknowns coupled[i], coupled[j].
    /// Entries of E must be at nodes that A couples; unknowns that the rank
    /// does not have are dealii::numbers::invalid_unsigned_int.
    void
    truncate(const unsigned int                 level,
             const std::vector<unsigned int>   &held,
             const std::vector<unsigned int>   &coupled,
             const Eigen::SparseMatrix<double> &E);

    /// dst = B src, on the level of truncate().
    void
    vmult(DofVector &dst, const DofVector &src) const;

    /// Bytes.
    std::size_t
    memory_consumption() const;

  private:
    struct Level;
    class CoarseSolver;

    /// Gives all ranks the frames that they found for the level l, of which
    /// they own the given nodes.
    void
    share_frames(
      const unsigned int                                        l,
      const std::vector<std::pair<unsigned int, unsigned int>> &own_ranges);

    bool
    is_shared(const unsigned int l) const;

    /// P'BP of a matrix of the level l, on the next coarser one; nothing where
    /// the process does not have that.
    template <typename Matrix>
    BlockMatrix<dim, double>
    coarser_matrix(const unsigned int l, const Matrix &B) const;

    void
    cycle(const unsigned int l) const;

    const dealii::SparseMatrix<double> &A;
    const RootLevel<dim> *const         root; ///< or null
    std::vector<Level>                  levels;
    std::vector<CycleLevel<dim>>        truncated; ///< by level
    std::unique_ptr<CoarseSolver>       coarse_solver;
    unsigned int                        first = 0; ///< level of the cycle
    std::vector<unsigned int>           held_unknowns;

    std::vector<std::vector<FramedNode>> framed; ///< of the levels

    /// On the first level that is not shared: frames on the root, and vectors
    /// of what the rank has of it.
    NodeFrames<dim>            root_frames;
    mutable std::vector<float> local_b, local_x;
  };
} // namespace Debond

#endif
