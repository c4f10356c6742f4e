// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_multigrid_level_h
#define debond_linear_algebra_multigrid_level_h

#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/precondition.h>

#include <debond/base/tolerances.h>
#include <debond/base/versions.h>
#include <debond/linear_algebra/shared_nodes.h>

#include <cmath>

namespace Debond
{
  /// Own rows of the matrix of a level, with local columns.
  struct LevelMatrix : BlockRows<float>, EnableObserverPointer
  {
    void
    vmult(SinglePrecisionVector &dst, const SinglePrecisionVector &src) const;

    /// The number of rows of all ranks.
    unsigned int
    m() const
    {
      return n_unknowns;
    }

    /// PreconditionChebyshev could ask for diagonal entries, but has them.
    float
    el(const unsigned int, const unsigned int) const
    {
      AssertThrow(false, dealii::ExcNotImplemented());
      return 0.f;
    }

    unsigned int n_unknowns = 0;
  };



  /// An entry of a matrix after a change by truncation: 0, or on the diagonal
  /// what it was before, if nothing but rounding is left.
  template <typename Number>
  Number
  changed(const Number before, const double change, const bool is_diagonal)
  {
    const double now = before + change;
    if (std::abs(now) > Tolerance::held_diagonal * std::abs(before))
      return static_cast<Number>(now);
    return is_diagonal ? before : Number(0);
  }



  /// A level of multigrid in single precision: a matrix that truncation changes
  /// in few rows, its smoother, and the prolongation to it.
  class MultigridLevel
  {
  public:
    explicit MultigridLevel(const SharedNodes &nodes)
      : nodes(nodes)
    {}

    /// All own rows, in their order.
    template <typename Rows>
    void
    set_matrix(Rows &&rows)
    {
      static_cast<BlockPattern &>(matrix) = rows;
      matrix.values.assign(rows.values.begin(), rows.values.end());
      reinit();
    }

    /// From now on the matrix is what it was set to and the change, by local
    /// numbers, whatever was changed before.
    void
    set_change(const NumberedRows &change);

    /// Makes the smoother for the matrix as it is now. The largest eigenvalue
    /// of D^{-1} matrix is estimated if @p estimate, else it is what it was.
    void
    make_smoother(const bool estimate);

    /// @p fine is the product of the prolongation with @p coarse.
    void
    prolongate(SinglePrecisionVector       &fine,
               const SinglePrecisionVector &coarse) const;

    /// @p coarse is the product of its transpose with @p fine.
    void
    restrict_to_coarser(SinglePrecisionVector       &coarse,
                        const SinglePrecisionVector &fine) const;

    SharedNodes      nodes;
    LevelMatrix      matrix;
    BlockRows<float> prolongation; ///< with rows of ghosts; not on the coarsest
    dealii::PreconditionChebyshev<LevelMatrix, SinglePrecisionVector> smoother;
    mutable SinglePrecisionVector                                     x, b, r;

  private:
    void
    reinit();

    /// Sets the entries of an own node.
    void
    invert_diagonal(const unsigned int row);

    std::shared_ptr<dealii::DiagonalMatrix<SinglePrecisionVector>>
      inverse_diagonal;

    double largest_eigenvalue = 0.; ///< not known yet

    /// The rows of the last change, with their entries without it.
    std::vector<unsigned int> changed_rows;
    std::vector<float>        unchanged;
  };
} // namespace Debond

#endif
