// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/array_view.h>
#include <deal.II/lac/lapack_templates.h>

#include <debond/base/memory.h>
#include <debond/linear_algebra/block_factor.h>
#include <debond/linear_algebra/mumps_factor.h>

#include <dmumps_c.h>

#include <new>
#include <numeric>
#include <set>
#include <utility>

namespace Debond
{
  namespace
  {
    /// The most, in percent, by which buffers are made larger than MUMPS
    /// estimates: if that is not enough it is memory that is short.
    constexpr MUMPS_INT largest_increase = 1000;



    /// MUMPS' workspace. It prints nothing: errors are thrown, on all ranks.
    class Mumps : public DMUMPS_STRUC_C
    {
    public:
      explicit Mumps(const MPI_Comm ranks)
        : DMUMPS_STRUC_C()
      {
        // The first call, with job -1, sets the defaults; it reads the three
        // fields that are set before it, and controls can only be set after it.
        comm_fortran = MPI_Comm_c2f(ranks);
        par          = 1; // the first rank works, too
        // Symmetric: if told that A is positive definite (1), it changes pivots
        // below 1e-16 |A|, which very soft parts have.
        sym = 2;
        run(-1);
        for (const unsigned int stream : {1, 2, 3, 4})
          control(stream) = 0;
        cntl[0]     = 0.; // no pivoting
        control(18) = 3;  // each rank has entries of the matrix
      }

      Mumps(const Mumps &) = delete;

      ~Mumps()
      {
        // Frees what MUMPS has allocated. As with every job, all ranks have to
        // call it.
        job = -2;
        dmumps_c(this);
      }

      /// ICNTL(k) of its guide.
      MUMPS_INT &
      control(const unsigned int k)
      {
        return icntl[k - 1];
      }

      /// Analyses (1), factorises (2) or solves (3).
      void
      run(const int what)
      {
        // Negative INFOG(1) that mean a lack of memory: allocations that fail,
        // and buffers for work and messages that are too small.
        const std::set<int> no_memory = {
          -5, -7, -8, -9, -11, -13, -14, -15, -17, -18, -19, -20, -22};
        // Of these, buffers that are too small are made larger, by a percentage
        // of the estimate, until the factorisation ends or largest_increase is
        // reached. The analysis need not be repeated. All ranks see the same
        // INFOG and do the same.
        const std::set<int> too_small = {-8, -9, -14, -15, -17, -18, -20};
        job                           = what;
        dmumps_c(this);
        while (what == 2 && too_small.count(infog[0]) > 0 &&
               control(14) < largest_increase)
          {
            control(14) = std::max(100, 3 * control(14));
            dmumps_c(this);
          }
        // INFOG(12) counts negative pivots and INFOG(25) tiny ones. As it has
        // been asked for a symmetric factorisation only, MUMPS does not
        // complain about them, but without them A_ii is definite. Error -10
        // says that it is singular.
        const int  error       = infog[0];
        const bool is_definite = infog[11] == 0 && infog[24] == 0;
        if (error == -10 || (what == 2 && error >= 0 && !is_definite))
          throw IndefiniteMatrix("by MUMPS, of " + std::to_string(n) + " rows");
        if (no_memory.count(error) > 0)
          throw std::bad_alloc();
        if (error < 0)
          throw std::runtime_error("Condensation: MUMPS error " +
                                   std::to_string(error) + ", " +
                                   std::to_string(infog[1]));
      }
    };



    /// Returns whether this rank and those on the same machine can have as many
    /// bytes.
    bool
    fits_into_memory(const double bytes, const MPI_Comm ranks)
    {
      // Ranks of one machine share its memory, so that what they need together
      // has to be compared with what there is. memory_left() is called by all
      // ranks.
      MPI_Comm machine;
      MPI_Comm_split_type(
        ranks, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
      const double all_bytes = dealii::Utilities::MPI::sum(bytes, machine);
      MPI_Comm_free(&machine);
      return all_bytes <= memory_left(0.);
    }



    class MumpsFactor : public BlockFactor
    {
    public:
      MumpsFactor(const MatrixOnRanks &matrix, const Elimination &elimination)
        : BlockFactor(matrix, elimination)
        , mumps(ranks)
      {
        // MUMPS eliminates the first unknowns and leaves the Schur complement
        // of the kept ones on the first rank. Each rank keeps its own part of
        // the factor, and gives MUMPS its own rows alone.
        const OwnEntries own = own_entries(matrix);
        if (n_eliminated > 0)
          factorize(own);
        else if (n_kept > 0)
          {
            // MUMPS wants something to eliminate. Without that S is A_ss, the
            // sum of what ranks have of it.
            for (std::size_t k = 0; k < own.values.size(); ++k)
              S(own.rows[k] - 1, own.columns[k] - 1) = own.values[k];
            dealii::Utilities::MPI::sum(S, ranks, S);
          }
        finish(matrix);
      }

    private:
      /// The entries in own rows in the lower triangle of A with the kept
      /// unknowns last; rows and columns count from 1.
      struct OwnEntries
      {
        std::vector<MUMPS_INT> rows;
        std::vector<MUMPS_INT> columns;
        std::vector<double>    values;
      };

      OwnEntries
      own_entries(const MatrixOnRanks &matrix) const
      {
        // An entry of the lower triangle is given once, by the owner of its
        // row. Rows that are left out have no place, and neither have their
        // columns.
        const std::vector<int> position = elimination.positions(n_rows);
        OwnEntries             own;
        for (const auto row : matrix.own_rows)
          if (const int i = position[row]; i >= 0)
            for (auto entry = matrix.A.begin(row); entry != matrix.A.end(row);
                 ++entry)
              {
                const int j = position[entry->column()];
                if (j >= 0 && j <= i)
                  {
                    own.rows.push_back(i + 1);
                    own.columns.push_back(j + 1);
                    own.values.push_back(entry->value());
                  }
              }
        return own;
      }

      /// Sets S on the first rank, at least its lower triangle.
      void
      factorize(OwnEntries own)
      {
        // MUMPS keeps pointers to these arrays while it works, not copies. It
        // stores S by rows in the memory of S itself, of a symmetric matrix the
        // lower triangle.
        mumps.n       = static_cast<MUMPS_INT>(n_eliminated + n_kept);
        mumps.nnz_loc = static_cast<MUMPS_INT8>(own.values.size());
        mumps.irn_loc = own.rows.data();
        mumps.jcn_loc = own.columns.data();
        mumps.a_loc   = own.values.data();
        // The kept unknowns are the last of the elimination, numbered from 1.
        std::vector<MUMPS_INT> kept(n_kept);
        std::iota(kept.begin(), kept.end(), n_eliminated + 1);
        if (n_kept > 0)
          {
            mumps.control(19)   = 1; // S, on the first rank
            mumps.size_schur    = static_cast<MUMPS_INT>(n_kept);
            mumps.listvar_schur = kept.data();
            mumps.schur         = &S(0, 0);
          }
        mumps.control(7) = 0; // approximate minimum degree
        mumps.run(1);
        // INFO(15) is what the analysis estimates for this rank, in millions of
        // bytes. Linux would grant more than there is and end the program
        // later; so all ranks refuse together if one machine has too little.
        const bool fits = fits_into_memory(1e6 * mumps.info[14], ranks);
        if (dealii::Utilities::MPI::min(fits ? 1 : 0, ranks) == 0)
          throw std::bad_alloc();
        mumps.run(2);
      }

      /// A_ii^{-1} b.
      Eigen::VectorXd
      solve(const Eigen::VectorXd &b) const override
      {
        // MUMPS solves with A_ii alone, since it has been asked for S. The
        // right side is read and the solution written on the first rank; the
        // others have arrays of the same size for what they get from it.
        if (n_eliminated == 0)
          return b;
        // On the first rank, with places for the kept unknowns.
        Eigen::VectorXd x(n_eliminated + n_kept);
        x << b, Eigen::VectorXd::Zero(n_kept);
        mumps.rhs  = x.data();
        mumps.nrhs = 1;
        mumps.run(3);
        dealii::Utilities::MPI::broadcast(x.data(), x.size(), 0, ranks);
        return x.head(n_eliminated);
      }

      mutable Mumps mumps;
    };
  } // namespace



  std::unique_ptr<EliminationFactor>
  make_mumps_factor(const MatrixOnRanks &matrix, const Elimination &elimination)
  {
    return std::make_unique<MumpsFactor>(matrix, elimination);
  }
} // namespace Debond
