// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_truncated_multigrid_h
#define debond_linear_algebra_truncated_multigrid_h

#include <debond/linear_algebra/coarsest_factor.h>
#include <debond/linear_algebra/distributed_matrix.h>
#include <debond/linear_algebra/multigrid_level.h>

namespace Debond
{
  /// The rows of a prolongation from the next coarser level at own nodes, with
  /// columns by the numbers of coarse nodes in the whole.
  struct Prolongation
  {
    /// Coarse nodes of this rank; those of the ranks follow each other.
    unsigned int n_own_columns;

    BlockRows<float> rows;
  };



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
   * factorised. The cycle is in single precision but for the coarsest level.
   *
   * Level 0 is the finest. All ranks call the functions together, except where
   * said.
   */
  class TruncatedMultigrid
  {
  public:
    /// An entry of a matrix by the numbers of its row and column in the whole.
    struct Entry
    {
      unsigned int row, column;
      double       value;
    };

    /// A + E with the held unknowns at zero, in double precision: of Q (A + E)
    /// Q + D (I - Q), with Q leaving out these and D the diagonal of A.
    class FinestMatrix
    {
    public:
      explicit FinestMatrix(const DistributedMatrix &A);

      void
      vmult(DistributedVector &dst, const DistributedVector &src) const;

      const DistributedMatrix  &A;
      std::vector<Entry>        E; ///< in own rows
      std::vector<unsigned int> held;

    private:
      mutable DistributedVector free_values;
    };

    /// With @p n_components successive unknowns a node and the given
    /// prolongations, finest first; without any, A is solved directly. Rows of
    /// constrained unknowns have only their diagonal entry, and no entries in
    /// the prolongations. Keeps a reference to A, whose values must stay.
    TruncatedMultigrid(const DistributedMatrix         &A,
                       const unsigned int               n_components,
                       const std::vector<Prolongation> &prolongations);

    TruncatedMultigrid(const TruncatedMultigrid &) = delete;

    /// From now on matrix() is Q (A + E) Q + D (I - Q), whatever it was before:
    /// E symmetric and positive semidefinite, Q leaving out the @p held
    /// unknowns, D the diagonal of A. Each rank gives what it has of E and the
    /// held ones, by their numbers in the whole; entries may occur repeatedly.
    /// Throws dealii::ExceptionBase if an entry is not in the pattern of A,
    /// std::runtime_error as CoarsestFactor does.
    void
    truncate(const std::vector<Entry>        &E,
             const std::vector<unsigned int> &held);

    /// Any rank may call it.
    const FinestMatrix &
    matrix() const
    {
      return finest;
    }

    /// Returns a level as truncated: a coarse unknown that no free unknown
    /// follows has a positive diagonal entry and no others. Prolongations are
    /// not truncated. Any rank may call it.
    const MultigridLevel &
    level(const unsigned int l) const
    {
      return *levels.at(l);
    }

    /// Any rank may call it.
    unsigned int
    n_levels() const
    {
      return static_cast<unsigned int>(levels.size());
    }

    /// z is next to matrix()^{-1} r, and zero at held unknowns whatever r is
    /// there. The vectors may have ghosts, which are left as they are.
    void
    vmult(DistributedVector &z, const DistributedVector &r) const;

  private:
    void
    add_finest();

    /// A at an own node, in the given pattern by local numbers. Valid until the
    /// next call.
    const double *
    finest_blocks(const BlockPattern &pattern, const unsigned int node) const;

    /// A by numbers of the whole.
    NumberedRows
    finest_rows() const;

    /// Behind the coarsest one, of which the own rows are given, and on the
    /// finest not asked for. Returns its own rows, by numbers of the whole.
    NumberedRows
    add_level(const Prolongation &P, const NumberedRows &fine_rows);

    /// Q (A + E) Q - A at the nodes where it is not zero.
    NumberedRows
    finest_change() const;

    /// For what the matrices are now, or if they are new.
    void
    make_smoothers(const bool is_new);

    /// x of the level for its b.
    void
    cycle(const unsigned int l) const;

    const unsigned int                           n_components;
    FinestMatrix                                 finest;
    std::vector<std::unique_ptr<MultigridLevel>> levels;
    std::unique_ptr<CoarsestFactor>              coarsest;
    SinglePrecisionVector                        free; ///< 0 if held, else 1

    // Of finest_blocks().
    mutable std::vector<double>       row_of_A;
    mutable std::vector<unsigned int> places;
  };
} // namespace Debond

#endif
