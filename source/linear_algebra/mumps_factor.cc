// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/array_view.h>
#include <deal.II/base/mpi.h>
#include <deal.II/lac/lapack_templates.h>

#include <debond/base/memory.h>
#include <debond/base/ranks.h>
#include <debond/linear_algebra/mumps_factor.h>

#include <Eigen/SparseCore>
#include <dmumps_c.h>

#include <new>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

namespace Debond
{
  namespace
  {
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
        job = what;
        dmumps_c(this);
        const int  error       = infog[0];
        const bool is_definite = infog[11] == 0 && infog[24] == 0;
        if (error == -10 || (what == 2 && error >= 0 && !is_definite))
          throw not_positive_definite("by MUMPS, of " + std::to_string(n) +
                                      " rows");
        if (no_memory.count(error) > 0)
          throw std::bad_alloc();
        if (error < 0)
          throw std::runtime_error("Condensation: MUMPS error " +
                                   std::to_string(error) + ", " +
                                   std::to_string(infog[1]));
      }
    };



    /// The sum over the ranks, in place.
    void
    sum_over(const MPI_Comm ranks, Eigen::VectorXd &values)
    {
      const dealii::ArrayView<double> view(values.data(), values.size());
      dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(view),
                                  ranks,
                                  view);
    }



    void
    broadcast(const MPI_Comm ranks, dealii::FullMatrix<double> &matrix)
    {
      if (!matrix.empty())
        dealii::Utilities::MPI::broadcast(&matrix(0, 0),
                                          matrix.n_elements(),
                                          0,
                                          ranks);
    }



    /// Whether this rank and those on the same machine can have as many bytes.
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



    class MumpsFactor : public EliminationFactor
    {
    public:
      MumpsFactor(const MatrixOnRanks &matrix, const Elimination &elimination)
        : elimination(elimination)
        , ranks(matrix.ranks)
        , is_first(rank_of_this(ranks) == 0)
        , n_rows(matrix.A.m())
        , n_eliminated(elimination.n_eliminated())
        , n_kept(elimination.n_kept)
        , mumps(ranks)
      {
        const OwnEntries own = own_entries(matrix);
        S.reinit(n_kept, n_kept);
        if (n_eliminated > 0)
          factorize(own);
        else
          {
            // MUMPS wants something to eliminate.
            for (std::size_t k = 0; k < own.values.size(); ++k)
              S(own.rows[k] - 1, own.columns[k] - 1) = own.values[k];
            dealii::Utilities::MPI::sum(S, ranks, S);
          }
        for (unsigned int i = 0; i < n_kept; ++i)
          for (unsigned int j = 0; j < i; ++j)
            S(j, i) = S(i, j);
        broadcast(ranks, S);
        factorize_S(matrix);
      }

      /// (f_i, x_i, g).
      Eigen::VectorXd
      reduce(const DofVector &f) const override
      {
        Eigen::VectorXd result(2 * n_eliminated + n_kept);
        for (unsigned int i = 0; i < n_eliminated; ++i)
          result(i) = f(elimination.unknowns[i]);
        const Eigen::VectorXd x = solve(result.head(n_eliminated));
        Eigen::VectorXd       g = -(A_is.transpose() * x);
        sum_over(ranks, g);
        for (unsigned int k = 0; k < n_kept; ++k)
          g(k) += f(elimination.unknowns[n_eliminated + k]);
        result.tail(n_eliminated + n_kept) << x, g;
        return result;
      }

      Eigen::VectorXd
      condensed_load(const Eigen::VectorXd &reduced) const override
      {
        return reduced.tail(n_kept);
      }

      double
      energy_at_zero(const Eigen::VectorXd &reduced,
                     const double           other) const override
      {
        return other -
               0.5 * reduced.head(n_eliminated)
                       .dot(reduced.segment(n_eliminated, n_eliminated));
      }

      double
      energy_of_kept(const Eigen::VectorXd &reduced) const override
      {
        if (n_kept == 0)
          return 0.;
        using ByRows = Eigen::
          Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        const Eigen::Map<const ByRows> L(&L_ss(0, 0), n_kept, n_kept);
        return 0.5 * L.triangularView<Eigen::Lower>()
                       .solve(condensed_load(reduced))
                       .squaredNorm();
      }

      double
      energy_without_contact(const Eigen::VectorXd &reduced) const override
      {
        return energy_of_kept(reduced) - energy_at_zero(reduced, 0.);
      }

      DofVector
      expand(const Eigen::VectorXd &reduced, const VectorView &s) const override
      {
        Eigen::VectorXd force = A_is * s;
        sum_over(ranks, force);
        Eigen::VectorXd x(n_eliminated + n_kept);
        x << solve(reduced.head(n_eliminated) - force), s;

        DofVector u(n_rows);
        for (unsigned int i = 0; i < x.size(); ++i)
          u(elimination.unknowns[i]) = x(i);
        return u;
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

      /// Sets A_is, too.
      OwnEntries
      own_entries(const MatrixOnRanks &matrix)
      {
        const std::vector<int> position = elimination.positions(n_rows);
        OwnEntries             own;
        std::vector<Eigen::Triplet<double>> couplings;
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
                const int k = j - static_cast<int>(n_eliminated);
                if (i < static_cast<int>(n_eliminated) && k >= 0)
                  couplings.emplace_back(i, k, entry->value());
              }
        A_is.resize(n_eliminated, n_kept);
        A_is.setFromTriplets(couplings.begin(), couplings.end());
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

      /// Sets L_ss.
      void
      factorize_S(const MatrixOnRanks &matrix)
      {
        L_ss                     = S;
        Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(n_kept);
        for (unsigned int k = 0; k < n_kept; ++k)
          if (const unsigned int row = elimination.unknowns[n_eliminated + k];
              elimination.is_semidefinite && matrix.own_rows.is_element(row))
            diagonal(k) = matrix.A.diag_element(row);
        sum_over(ranks, diagonal);
        for (unsigned int k = 0; k < n_kept; ++k)
          L_ss(k, k) += diagonal(k);

        dealii::types::blas_int info = 0;
        if (is_first && n_kept > 0)
          {
            const auto n = static_cast<dealii::types::blas_int>(n_kept);
            // The upper triangle by columns is the lower one by rows.
            dealii::potrf("U", &n, &L_ss(0, 0), &n, &info);
          }
        info = dealii::Utilities::MPI::broadcast(ranks, info);
        if (info != 0)
          throw not_positive_definite("kept unknown " + std::to_string(info) +
                                      " of " + std::to_string(n_kept));
        broadcast(ranks, L_ss);
      }

      /// A_ii^{-1} b.
      Eigen::VectorXd
      solve(const Eigen::VectorXd &b) const
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

      const Elimination           elimination;
      const MPI_Comm              ranks;
      const bool                  is_first;
      const unsigned int          n_rows; ///< of A
      const unsigned int          n_eliminated;
      const unsigned int          n_kept;
      mutable Mumps               mumps;
      Eigen::SparseMatrix<double> A_is; ///< own rows only
    };
  } // namespace



  std::unique_ptr<EliminationFactor>
  make_mumps_factor(const MatrixOnRanks &matrix, const Elimination &elimination)
  {
    return std::make_unique<MumpsFactor>(matrix, elimination);
  }
} // namespace Debond
