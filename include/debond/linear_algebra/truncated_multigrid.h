// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_truncated_multigrid_h
#define debond_linear_algebra_truncated_multigrid_h

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <debond/linear_algebra/distributed_vector.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace Debond
{
  /**
   * One V-cycle for A + E with some unknowns held at zero, symmetric and
   * positive definite: a preconditioner for conjugate gradients that takes
   * about as many steps as for A alone. E couples few unknowns.
   *
   * Coarser matrices are Galerkin products with the rows of the held unknowns
   * left out of the finest prolongation (truncation; Kornhuber, Krause, Comput.
   * Vis. Sci. 4, 2001; Graeser, Sack, Sander, 2009). They differ from those of
   * A only next to the held unknowns and those of E, and only these differences
   * are multiplied. Levels are smoothed by Chebyshev polynomials of degree 2 in
   * D^{-1}B, D being the diagonal of the matrix B; the coarsest one is
   * factorised on the first rank.
   *
   * Level 0 is the finest. All ranks call the functions together, except where
   * said.
   */
  class TruncatedMultigrid
  {
  public:
    /// The rows of a prolongation from the next coarser level that this rank
    /// has, in the order of its unknowns of the finer level.
    struct Prolongation
    {
      /// Coarse unknowns of this rank; those of the ranks follow each other.
      unsigned int n_own_columns;

      /// Where the entries of each row begin, and behind the last one.
      std::vector<std::size_t> starts;

      std::vector<unsigned int> columns; ///< in the whole coarser level
      std::vector<double>       values;
    };

    /// An entry of a matrix by the numbers of its row and column in the whole.
    struct Entry
    {
      unsigned int row, column;
      double       value;
    };

    /// With the given prolongations, finest first; without any, matrix() is
    /// solved directly. Each rank has a contiguous range of rows of A, and the
    /// same one of columns; rows of constrained unknowns have only their
    /// diagonal entry, and no entries in the prolongations. Keeps a reference
    /// to A, whose values must stay.
    TruncatedMultigrid(const dealii::TrilinosWrappers::SparseMatrix &A,
                       const std::vector<Prolongation> &prolongations);

    /// With the smoothed aggregates of Trilinos ML (Vanek, Mandel, Brezina,
    /// Computing 56, 1996) for @p n_components successive unknowns a node and a
    /// near null space, such as the rigid motions, zero where A is constrained.
    TruncatedMultigrid(const dealii::TrilinosWrappers::SparseMatrix &A,
                       const unsigned int                    n_components,
                       const std::vector<DistributedVector> &near_null_space);

    TruncatedMultigrid(const TruncatedMultigrid &) = delete;

    ~TruncatedMultigrid();

    /// From now on matrix() is Q (A + E) Q + D (I - Q), whatever it was before:
    /// E symmetric and positive semidefinite, Q leaving out the @p held
    /// unknowns, D the diagonal of A. Each rank gives what it has of E and the
    /// held ones, by their numbers in the whole; entries may occur repeatedly.
    /// Throws dealii::ExceptionBase if an entry is not in the pattern of A.
    void
    truncate(const std::vector<Entry>        &E,
             const std::vector<unsigned int> &held);

    /// Of a level, as truncated. A coarse unknown that no free unknown follows
    /// has a positive diagonal entry and no others. Any rank may call it.
    const dealii::TrilinosWrappers::SparseMatrix &
    matrix(const unsigned int level = 0) const;

    /// To the given level from the next coarser one, not truncated. Any rank
    /// may call it.
    const dealii::TrilinosWrappers::SparseMatrix &
    prolongation(const unsigned int level) const;

    /// z is next to matrix()^{-1} r, and zero at held unknowns whatever r is
    /// there. The vectors may have ghosts, which are left as they are.
    void
    vmult(DistributedVector &z, const DistributedVector &r) const;

    /// Any rank may call it.
    unsigned int
    n_levels() const;

  private:
    struct Level;

    /// Makes what the finest level needs.
    explicit TruncatedMultigrid(
      const dealii::TrilinosWrappers::SparseMatrix &A);

    /// Behind the coarsest one. The Galerkin product is made if it is null.
    void
    add_level(std::unique_ptr<Epetra_CrsMatrix> P,
              std::unique_ptr<Epetra_CrsMatrix> product);

    /// Smoothers and the factorisation for what the matrices are now.
    void
    update_solvers();

    /// x of the level for its b.
    void
    cycle(const unsigned int level) const;

    const dealii::TrilinosWrappers::SparseMatrix &A;
    std::vector<std::unique_ptr<Level>>           levels;
    DistributedVector                             free; ///< 0 if held, else 1
    double finest_eigenvalue = 0.; ///< largest of D^{-1}A, 0 if not known yet
  };
} // namespace Debond

#endif
