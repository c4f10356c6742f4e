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
        // Allocations that fail, and work and message buffers too small.
        const std::set<int> no_memory = {
          -5, -7, -8, -9, -11, -13, -14, -15, -17, -18, -19, -20, -22};
        // Work and message buffers that are too small are made larger.
        const std::set<int> too_small = {-8, -9, -14, -15, -17, -18, -20};
        job                           = what;
        dmumps_c(this);
        while (what == 2 && too_small.count(infog[0]) > 0 &&
               control(14) < largest_increase)
          {
            control(14) = std::max(100, 3 * control(14));
            dmumps_c(this);
          }
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
        const OwnEntries own = own_entries(matrix);
        if (n_eliminated > 0)
          factorize(own);
        else if (n_kept > 0)
          {
            // MUMPS wants something to eliminate.
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
        mumps.n       = static_cast<MUMPS_INT>(n_eliminated + n_kept);
        mumps.nnz_loc = static_cast<MUMPS_INT8>(own.values.size());
        mumps.irn_loc = own.rows.data();
        mumps.jcn_loc = own.columns.data();
        mumps.a_loc   = own.values.data();
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
        // What is more than that the system would end the program for.
        const bool fits = fits_into_memory(1e6 * mumps.info[14], ranks);
        if (dealii::Utilities::MPI::min(fits ? 1 : 0, ranks) == 0)
          throw std::bad_alloc();
        mumps.run(2);
      }

      /// A_ii^{-1} b.
      Eigen::VectorXd
      solve(const Eigen::VectorXd &b) const override
      {
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
