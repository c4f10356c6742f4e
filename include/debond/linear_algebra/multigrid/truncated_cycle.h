// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_multigrid_truncated_cycle_h
#define debond_linear_algebra_multigrid_truncated_cycle_h

#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <debond/linear_algebra/multigrid/root_level.h>
#include <debond/linear_algebra/multigrid/shared_nodes.h>
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
   * Smoothers are Chebyshev polynomials of degree 2 in D^{-1}A with the blocks
   * of the diagonal D; the coarsest matrix is factorised. Numbers are in single
   * precision, but for the products that make the matrices.
   *
   * Where ranks share the finest level, all of them call what concerns it; the
   * coarser ones are the root's, and so is n_levels() > 1.
   */
  template <int dim>
  class TruncatedCycle
  {
  public:
    /// @p frames are those of the unknowns of A, @p interpolations those from
    /// each coarser level to the next finer one, finest first. Keeps references
    /// to A and to the nodes of its unknowns. If these are not the whole, @p
    /// root has the coarser level; the first interpolation is between the
    /// rank's nodes, and the root has the others.
    TruncatedCycle(const dealii::SparseMatrix<double> &A,
                   const NodeFrames<dim>              &frames,
                   std::vector<Interpolation>          interpolations,
                   const SharedNodes                  &nodes,
                   const RootLevel<dim>               *root = nullptr);

    TruncatedCycle(const TruncatedCycle &) = delete;

    ~TruncatedCycle();

    unsigned int
    n_levels() const;

    /// From the level l + 1 to the level l.
    const Transfer<dim> &
    transfer(const unsigned int l) const;

    /// Of the level l > 0.
    const NodeFrames<dim> &
    frames(const unsigned int l) const;

    /// For each of frames() the node of the level l - 1 that it is like, by its
    /// number in the whole.
    const std::vector<unsigned int> &
    origins(const unsigned int l) const;

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
    vmult(dealii::Vector<double> &dst, const dealii::Vector<double> &src) const;

    /// Bytes.
    std::size_t
    memory_consumption() const;

  private:
    struct Level;
    class CoarseSolver;

    /// Those that ranks find for the coarser level, for all of them.
    void
    share_coarse_frames();

    /// D^{-1} and the largest eigenvalue of D^{-1}A.
    void
    prepare_smoother(const unsigned int l);

    /// The nodes whose rows are to be computed.
    std::vector<std::pair<unsigned int, unsigned int>>
    own_ranges(const unsigned int l) const;

    /// <a, b> on a level.
    double
    product(const unsigned int        l,
            const std::vector<float> &a,
            const std::vector<float> &b) const;

    void
    update_ghosts(const unsigned int l, std::vector<float> &values) const;

    static void
    invert_diagonal(Level &level, const unsigned int node);

    /// Adds the changes to the matrix of the level.
    static void
    change(Level &level, const BlockMatrix<dim, double> &changes);

    void
    cycle(const unsigned int l) const;

    const dealii::SparseMatrix<double> &A;
    const SharedNodes                  &nodes;
    const RootLevel<dim> *const         root; ///< or null
    std::vector<Level>                  levels;
    std::unique_ptr<CoarseSolver>       coarse_solver;
    unsigned int                        first = 0; ///< level of the cycle
    std::vector<unsigned int>           held_unknowns;

    /// Of the coarser level of a rank.
    NodeFrames<dim>            coarse_frames;
    std::vector<unsigned int>  coarse_origins;
    mutable std::vector<float> coarse_b, coarse_x;
  };
} // namespace Debond

#endif
