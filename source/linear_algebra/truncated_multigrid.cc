// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/trilinos_solver.h>

#include <debond/base/tolerances.h>
#include <debond/linear_algebra/truncated_multigrid.h>

#include <EpetraExt_MatrixMatrix.h>
#include <EpetraExt_Transpose_RowMatrix.h>
#include <Epetra_Import.h>
#include <Teuchos_ParameterList.hpp>
#include <ml_MultiLevelPreconditioner.h>
#include <ml_epetra_utils.h>
#include <ml_utils.h>

namespace Debond
{
  namespace
  {
    using Matrix    = dealii::TrilinosWrappers::SparseMatrix;
    using Smoother  = dealii::PreconditionChebyshev<Matrix, DistributedVector>;
    using CrsMatrix = std::unique_ptr<Epetra_CrsMatrix>;



    void
    check(const int error)
    {
      AssertThrow(error == 0, dealii::ExcTrilinosError(error));
    }



    /// deal.II gives only constant access.
    Epetra_CrsMatrix &
    epetra(Matrix &M)
    {
      return const_cast<Epetra_CrsMatrix &>(M.trilinos_matrix());
    }



    /// A view.
    struct Row
    {
      Row(const Epetra_CrsMatrix &M, const int row)
      {
        check(M.ExtractMyRowView(row, n, values, columns));
      }

      int     n;
      double *values;
      int    *columns;
    };



    /// With the given rows.
    CrsMatrix
    to_epetra(const TruncatedMultigrid::Prolongation &P, const Epetra_Map &rows)
    {
      const std::vector<int> columns(P.columns.begin(), P.columns.end());
      std::vector<int>       lengths(rows.NumMyElements());
      for (std::size_t i = 0; i < lengths.size(); ++i)
        lengths[i] = static_cast<int>(P.starts[i + 1] - P.starts[i]);
      auto result = std::make_unique<Epetra_CrsMatrix>(Copy,
                                                       rows,
                                                       lengths.data(),
                                                       /*StaticProfile=*/true);
      for (int i = 0; i < rows.NumMyElements(); ++i)
        if (P.starts[i] < P.starts[i + 1])
          check(result->InsertGlobalValues(rows.GID(i),
                                           static_cast<int>(P.starts[i + 1] -
                                                            P.starts[i]),
                                           P.values.data() + P.starts[i],
                                           columns.data() + P.starts[i]));
      check(result->FillComplete(
        Epetra_Map(-1, static_cast<int>(P.n_own_columns), 0, rows.Comm()),
        rows));
      return result;
    }



    /// P'.
    CrsMatrix
    transpose(const Epetra_CrsMatrix &P)
    {
      Epetra_Map                     rows(P.DomainMap().NumGlobalElements(),
                      P.DomainMap().NumMyElements(),
                      0,
                      P.Comm());
      EpetraExt::RowMatrix_Transpose transposition(&rows);
      return std::make_unique<Epetra_CrsMatrix>(
        dynamic_cast<Epetra_CrsMatrix &>(
          transposition(const_cast<Epetra_CrsMatrix &>(P))));
    }



    /// AB. With factors that are nearly empty A'B is wrong on several ranks in
    /// Trilinos 13.2, so transposes are made first. Hard zeros are kept, so
    /// that the pattern does not depend on values.
    CrsMatrix
    multiply(const Epetra_CrsMatrix &A, const Epetra_CrsMatrix &B)
    {
      auto result = std::make_unique<Epetra_CrsMatrix>(Copy, A.RowMap(), 0);
      check(EpetraExt::MatrixMatrix::Multiply(
        A, false, B, false, *result, true, true));
      return result;
    }



    /// A + s B, with the patterns of both.
    CrsMatrix
    sum(const Epetra_CrsMatrix &A, const double s, const Epetra_CrsMatrix &B)
    {
      Epetra_CrsMatrix *result = nullptr;
      check(EpetraExt::MatrixMatrix::Add(A, false, 1., B, false, s, result));
      CrsMatrix owner(result);
      check(owner->FillComplete(A.DomainMap(), A.RangeMap()));
      return owner;
    }



    /// The Galerkin product has nothing where the prolongation has an empty
    /// column: there the diagonal becomes 1.
    CrsMatrix
    with_diagonal(CrsMatrix M)
    {
      Epetra_Vector diagonal(M->RowMap());
      check(M->ExtractDiagonalCopy(diagonal));
      double least;
      check(diagonal.MinValue(&least));
      if (least > 0.)
        return M;
      Epetra_CrsMatrix ones(Copy, M->RowMap(), 1);
      const double     one = 1.;
      for (int i = 0; i < M->NumMyRows(); ++i)
        if (const int row = M->GRID(i); diagonal[i] <= 0.)
          check(ones.InsertGlobalValues(row, 1, &one, &row));
      check(ones.FillComplete(M->DomainMap(), M->RangeMap()));
      return sum(*M, 1., ones);
    }



    /// Modes of an aggregate with few free unknowns depend on each other, by
    /// which the coarsest matrix may be singular.
    CrsMatrix
    made_regular(const Matrix &M)
    {
      auto result = std::make_unique<Epetra_CrsMatrix>(M.trilinos_matrix());
      Epetra_Vector diagonal(result->RowMap());
      check(result->ExtractDiagonalCopy(diagonal));
      check(diagonal.Scale(1. + Tolerance::regular_diagonal));
      check(result->ReplaceDiagonalValues(diagonal));
      return result;
    }



    /// M += change, if no rank lacks an entry in the pattern of M.
    bool
    add_in_pattern(Epetra_CrsMatrix &M, const Epetra_CrsMatrix &change)
    {
      int              error = 0, largest_error;
      std::vector<int> columns;
      for (int i = 0; i < change.NumMyRows(); ++i)
        {
          const Row row(change, i);
          columns.resize(row.n);
          for (int k = 0; k < row.n; ++k)
            columns[k] = change.GCID(row.columns[k]);
          if (row.n > 0 && M.SumIntoGlobalValues(
                             M.GRID(i), row.n, row.values, columns.data()) != 0)
            error = 1;
        }
      check(M.Comm().MaxAll(&error, &largest_error, 1));
      return largest_error == 0;
    }



    /// B = Q B Q + D (I - Q) for B of the pattern of A, whose diagonal is D.
    /// Returns Q B Q - A.
    CrsMatrix
    restrict_to_free(const Epetra_CrsMatrix &A,
                     DistributedVector      &free,
                     Epetra_CrsMatrix       &B)
    {
      Epetra_Vector       is_free(A.ColMap());
      const Epetra_Vector own(View, A.RowMap(), free.begin());
      check(is_free.Import(own, Epetra_Import(A.ColMap(), A.RowMap()), Insert));

      auto change =
        std::make_unique<Epetra_CrsMatrix>(Copy, A.RowMap(), A.ColMap(), 0);
      std::vector<int>    columns;
      std::vector<double> values;
      for (int i = 0; i < A.NumMyRows(); ++i)
        {
          const Row a(A, i), b(B, i);
          const int diagonal = A.LCID(A.GRID(i));
          columns.clear();
          values.clear();
          for (int k = 0; k < a.n; ++k)
            {
              const int    j     = a.columns[k];
              const double value = own[i] * is_free[j] * b.values[k];
              if (value != a.values[k])
                {
                  columns.push_back(j);
                  values.push_back(value - a.values[k]);
                }
              b.values[k] = j == diagonal && own[i] == 0. ? a.values[k] : value;
            }
          if (!columns.empty())
            check(change->InsertMyValues(i,
                                         static_cast<int>(columns.size()),
                                         values.data(),
                                         columns.data()));
        }
      check(change->FillComplete(A.DomainMap(), A.RangeMap()));
      return change;
    }
  } // namespace



  struct TruncatedMultigrid::Level
  {
    /// Of the size of the matrix.
    void
    reinit_vectors()
    {
      b.reinit(matrix.locally_owned_range_indices(),
               matrix.get_mpi_communicator());
      x.reinit(b);
      r.reinit(b);
    }

    /// From now on the matrix is that of A plus the change.
    void
    set_change(const Epetra_CrsMatrix &change)
    {
      matrix.copy_from(original);
      if (add_in_pattern(epetra(matrix), change))
        return;
      // ML's products drop zeros.
      original.reinit(*sum(original.trilinos_matrix(), 0., change));
      matrix.reinit(original.trilinos_matrix());
      AssertThrow(add_in_pattern(epetra(matrix), change),
                  dealii::ExcInternalError());
    }

    /// D^{-1}. Where truncation has left nothing but rounding, the diagonal
    /// entry becomes what it was without.
    std::shared_ptr<dealii::DiagonalMatrix<DistributedVector>>
    inverse_diagonal()
    {
      Epetra_CrsMatrix &M = epetra(matrix);
      Epetra_Vector     diagonal(M.RowMap()), before(M.RowMap());
      check(M.ExtractDiagonalCopy(diagonal));
      if (original.m() > 0)
        check(original.trilinos_matrix().ExtractDiagonalCopy(before));
      DistributedVector inverse(b);
      for (int i = 0; i < M.NumMyRows(); ++i)
        {
          if (const int row = M.GRID(i);
              diagonal[i] <= Tolerance::held_diagonal * before[i])
            {
              check(M.ReplaceGlobalValues(row, 1, &before[i], &row));
              diagonal[i] = before[i];
            }
          inverse.local_element(i) = 1. / diagonal[i];
        }
      return std::make_shared<dealii::DiagonalMatrix<DistributedVector>>(
        inverse);
    }

    Matrix            original; ///< without truncation; empty on the finest
    Matrix            matrix;
    Matrix            prolongation, restriction; ///< not on the coarsest
    Smoother          smoother;
    DistributedVector x, b, r;

    /// Of the coarsest level.
    Matrix                                                  factorised;
    dealii::SolverControl                                   control;
    std::unique_ptr<dealii::TrilinosWrappers::SolverDirect> solver;
  };



  TruncatedMultigrid::TruncatedMultigrid(
    const Matrix                    &A,
    const std::vector<Prolongation> &prolongations)
    : TruncatedMultigrid(A)
  {
    for (const Prolongation &P : prolongations)
      add_level(to_epetra(P, levels.back()->matrix.trilinos_matrix().RowMap()),
                nullptr);
    update_solvers();
  }



  TruncatedMultigrid::TruncatedMultigrid(
    const Matrix                         &A,
    const unsigned int                    n_components,
    const std::vector<DistributedVector> &near_null_space)
    : TruncatedMultigrid(A)
  {
    // ML reads the modes one after the other from a plain array.
    std::vector<double> modes;
    for (const DistributedVector &mode : near_null_space)
      modes.insert(modes.end(), mode.begin(), mode.end());
    Teuchos::ParameterList parameters;
    check(ML_Epetra::SetDefaults("SA", parameters));
    parameters.set("ML output", 0);
    parameters.set("PDE equations", static_cast<int>(n_components));
    parameters.set("null space: type", "pre-computed");
    parameters.set("null space: dimension",
                   static_cast<int>(near_null_space.size()));
    parameters.set("null space: vectors", modes.data());
    parameters.set("aggregation: type", "Uncoupled");
    parameters.set("smoother: type", "do-nothing");
    parameters.set("coarse: type", "do-nothing");
    parameters.set("coarse: max size", 2000);
    // Else the levels would depend on what ML has made before.
    ML_set_random_seed(1);
    const ML_Epetra::MultiLevelPreconditioner ml(A.trilinos_matrix(),
                                                 parameters);
    // The conversion does not change what it reads.
    ML *const hierarchy = const_cast<ML *>(ml.GetML());
    for (int l = 1; l < hierarchy->ML_num_actual_levels; ++l)
      {
        Epetra_CrsMatrix *P = nullptr, *product = nullptr;
        check(ML_Operator2EpetraCrsMatrix(&hierarchy->Pmat[l], P));
        check(ML_Operator2EpetraCrsMatrix(&hierarchy->Amat[l], product));
        add_level(CrsMatrix(P), CrsMatrix(product));
      }
    update_solvers();
  }



  TruncatedMultigrid::TruncatedMultigrid(const Matrix &A)
    : A(A)
  {
    levels.push_back(std::make_unique<Level>());
    levels.back()->matrix.copy_from(A);
    levels.back()->reinit_vectors();
    free.reinit(levels.back()->b);
    free = 1.;
  }



  TruncatedMultigrid::~TruncatedMultigrid() = default;



  void
  TruncatedMultigrid::add_level(CrsMatrix P, CrsMatrix product)
  {
    Level          &finer = *levels.back();
    const CrsMatrix R     = transpose(*P);
    finer.prolongation.reinit(*P);
    finer.restriction.reinit(*R);
    if (product == nullptr)
      product = multiply(*R, *multiply(finer.matrix.trilinos_matrix(), *P));
    product = with_diagonal(std::move(product));
    levels.push_back(std::make_unique<Level>());
    levels.back()->original.reinit(*product);
    levels.back()->matrix.reinit(*product);
    levels.back()->reinit_vectors();
  }



  void
  TruncatedMultigrid::truncate(const std::vector<Entry>        &E,
                               const std::vector<unsigned int> &held)
  {
    free = 1.;
    for (const unsigned int i : held)
      free(i) = 0.;
    Matrix &B = levels.front()->matrix;
    B.copy_from(A);
    for (const Entry &entry : E)
      {
        const int column = static_cast<int>(entry.column);
        check(epetra(B).SumIntoGlobalValues(
          static_cast<int>(entry.row), 1, &entry.value, &column));
      }
    CrsMatrix change = restrict_to_free(A.trilinos_matrix(), free, epetra(B));
    for (unsigned int l = 1; l < levels.size(); ++l)
      {
        const Level &finer = *levels[l - 1];
        change =
          multiply(finer.restriction.trilinos_matrix(),
                   *multiply(*change, finer.prolongation.trilinos_matrix()));
        levels[l]->set_change(*change);
      }
    update_solvers();
  }



  const Matrix &
  TruncatedMultigrid::matrix(const unsigned int level) const
  {
    return levels.at(level)->matrix;
  }



  const Matrix &
  TruncatedMultigrid::prolongation(const unsigned int level) const
  {
    return levels.at(level)->prolongation;
  }



  void
  TruncatedMultigrid::vmult(DistributedVector       &z,
                            const DistributedVector &r) const
  {
    Level &finest = *levels.front();
    finest.b.copy_locally_owned_data_from(r);
    finest.b.scale(free);
    cycle(0);
    z.copy_locally_owned_data_from(finest.x);
  }



  unsigned int
  TruncatedMultigrid::n_levels() const
  {
    return static_cast<unsigned int>(levels.size());
  }



  void
  TruncatedMultigrid::update_solvers()
  {
    for (const auto &level : levels)
      {
        Smoother::AdditionalData parameters;
        parameters.preconditioner  = level->inverse_diagonal();
        parameters.degree          = 2;
        parameters.smoothing_range = 20.;
        // Truncation leaves the modes of an aggregate dependent where it has
        // few free unknowns, which makes the largest eigenvalue larger; not
        // on the finest level.
        const bool is_known = level == levels.front() && finest_eigenvalue > 0.;
        parameters.eig_cg_n_iterations = is_known ? 0 : 10;
        parameters.max_eigenvalue      = finest_eigenvalue;
        if (level == levels.back())
          break;
        level->smoother.initialize(level->matrix, parameters);
        const auto found = level->smoother.estimate_eigenvalues(level->b);
        if (level == levels.front())
          finest_eigenvalue = found.max_eigenvalue_estimate;
      }
    Level &coarsest = *levels.back();
    coarsest.solver = std::make_unique<dealii::TrilinosWrappers::SolverDirect>(
      coarsest.control,
      dealii::TrilinosWrappers::SolverDirect::AdditionalData(false,
                                                             "Amesos_Klu"));
    if (levels.size() > 1)
      coarsest.factorised.reinit(*made_regular(coarsest.matrix));
    coarsest.solver->initialize(levels.size() > 1 ? coarsest.factorised :
                                                    coarsest.matrix);
  }



  void
  TruncatedMultigrid::cycle(const unsigned int level) const
  {
    Level &fine = *levels[level];
    if (level + 1 == levels.size())
      {
        fine.solver->solve(fine.x, fine.b);
        return;
      }
    fine.smoother.vmult(fine.x, fine.b);
    fine.matrix.vmult(fine.r, fine.x);
    fine.r.sadd(-1., 1., fine.b);
    // b, x and r are zero at held unknowns, so only corrections may not be.
    Level &coarse = *levels[level + 1];
    fine.restriction.vmult(coarse.b, fine.r);
    cycle(level + 1);
    fine.prolongation.vmult(fine.r, coarse.x);
    if (level == 0)
      fine.r.scale(free);
    fine.x += fine.r;
    fine.smoother.step(fine.x, fine.b);
  }
} // namespace Debond
