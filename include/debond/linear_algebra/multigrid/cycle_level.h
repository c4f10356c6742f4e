// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_multigrid_cycle_level_h
#define debond_linear_algebra_multigrid_cycle_level_h

#include <debond/linear_algebra/multigrid/block_matrix.h>
#include <debond/linear_algebra/multigrid/shared_nodes.h>

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace Debond
{
  /**
   * One level of a cycle in single precision: A x = b with a matrix whose
   * changes can be undone, and its smoother, the Chebyshev polynomial of degree
   * 2 in D^{-1}A, D being the blocks of the diagonal (Saad, Iterative Methods
   * for Sparse Linear Systems, 2nd ed., Alg. 12.1).
   *
   * Where ranks share the nodes, each has the rows of all nodes that it has,
   * and all call the functions together.
   */
  template <int dim>
  class CycleLevel
  {
  public:
    /// Keeps a reference to the nodes. @p matrix: BlockMatrix or BlockView, of
    /// about @p n_blocks blocks.
    template <typename Matrix>
    CycleLevel(const SharedNodes &nodes,
               const Matrix      &matrix,
               const std::size_t  n_blocks);

    const BlockMatrix<dim, float> &
    matrix() const;

    /// For each unknown the diagonal entry up to which it is not free: changes
    /// leave next to nothing of it, or it is zero anyway.
    const std::vector<float> &
    zero() const;

    /// The diagonal entry of an unknown, to be read and written between
    /// change() and update_smoother().
    float &
    diagonal_entry(const unsigned int unknown);

    /// A += changes.
    void
    change(const BlockMatrix<dim, double> &changes);

    /// Makes D^{-1} that of the matrix after change(). The eigenvalue stays.
    void
    update_smoother();

    /// Takes all changes back.
    void
    undo_changes();

    /// x after a step of the smoother from zero.
    void
    smooth_from_zero() const;

    /// Another one, from x.
    void
    smooth() const;

    /// r = b - A x.
    void
    compute_residual() const;

    /// Bytes.
    std::size_t
    memory_consumption() const;

    /// An entry for each unknown. r is scratch of the smoother.
    mutable std::vector<float> x, b, r;

  private:
    /// D^{-1} and the largest eigenvalue of D^{-1}A.
    void
    prepare_smoother();

    void
    invert_diagonal(const unsigned int node);

    /// p = by_last p + by_residual D^{-1} (b - A x), x += p.
    void
    move(const float by_last, const float by_residual) const;

    const SharedNodes         *nodes;
    BlockMatrix<dim, float>    A;
    std::vector<float>         inverse_diagonal;
    std::vector<float>         zero_entries;
    mutable std::vector<float> p;

    /// Of the smoother.
    float theta = 0.f, momentum = 0.f, step = 0.f;

    /// What changed: rows, and blocks as they were.
    std::vector<unsigned int> changed_rows;
    std::vector<
      std::pair<std::size_t, std::array<float, std::size_t{dim} * dim>>>
      changed;
  };
} // namespace Debond

#endif
